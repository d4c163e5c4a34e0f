/* A picture in the making: linear light, 255 for a full well at exposure 1. */
#ifndef SCENE_CANVAS_H
#define SCENE_CANVAS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct canvas {
    int32_t width_px, height_px;
    float *at;
} canvas;

/* False when memory runs out. */
bool canvas_create(canvas *picture, int32_t width_px, int32_t height_px);

void canvas_release(canvas *picture);

static inline float *canvas_row(const canvas *picture, int32_t y)
{
    return picture->at + (size_t)y * (size_t)picture->width_px;
}

static inline size_t canvas_size(const canvas *picture)
{
    return (size_t)picture->width_px * (size_t)picture->height_px;
}

/* Each pixel becomes a weighted sum of those around it; beyond the border, the border's pixels go on. */
typedef struct canvas_tap {
    int32_t dx_px, dy_px;
    float weight;
} canvas_tap;

bool canvas_convolve(canvas *picture, const canvas_tap *taps, size_t tap_count);

/* A Gaussian blur; a standard deviation of 0 leaves the picture as it is. False when memory runs out. */
bool canvas_blur(canvas *picture, double sigma_px);

#endif
