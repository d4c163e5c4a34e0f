/* Reading gray values out of the caller's image. */
#ifndef TAPEMARK_VIEW_H
#define TAPEMARK_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tmi_point {
    float x, y;
} tmi_point;

typedef struct tmi_view {
    const uint8_t *pixels;
    int32_t width, height;
    ptrdiff_t stride;
    /* Where light and dark are exchanged: 255, -1 and 255; else 0, 1 and 0. Whole pixels are XORed with the
     * first; interpolated values are sign * value + offset. */
    uint8_t invert;
    float sign, offset;
} tmi_view;

/* Images below this size, either way, hold no marker; the decoder returns before it samples any. */
enum { TMI_SMALLEST_SIDE = 8 };

/* Places are interpolated between pixels in steps of 1/256 px. */
enum { TMI_STEPS_PER_PX = 256, TMI_ONE_GRAY = TMI_STEPS_PER_PX * TMI_STEPS_PER_PX };

typedef struct tmi_place {
    uint32_t x, y; /* in steps */
} tmi_place;

/* Bilinear interpolation at a place of which the image holds the pixel and the next ones; 65536 times the gray. */
static inline int32_t tmi_interpolate(const tmi_view *view, tmi_place at)
{
    const int32_t part_x = (int32_t)(at.x % TMI_STEPS_PER_PX), part_y = (int32_t)(at.y % TMI_STEPS_PER_PX);
    const uint8_t *p = view->pixels + (ptrdiff_t)(at.y / TMI_STEPS_PER_PX) * view->stride + at.x / TMI_STEPS_PER_PX;
    const uint8_t *q = p + view->stride;
    const int32_t top = TMI_STEPS_PER_PX * p[0] + part_x * (p[1] - p[0]);
    const int32_t low = TMI_STEPS_PER_PX * q[0] + part_x * (q[1] - q[0]);
    return TMI_STEPS_PER_PX * top + part_y * (low - top);
}

/* The gray value that is the mean of so many interpolated ones. */
static inline float tmi_gray(const tmi_view *view, int32_t sum, int count)
{
    const float scale = 1 / ((float)TMI_ONE_GRAY * (float)count);
    return (float)sum * (view->sign * scale) + view->offset;
}

/* The last place along a side of so many pixels that has a next pixel to interpolate with. */
static inline float tmi_last_place(int32_t pixels)
{
    return (float)(pixels - 2) + (1 - 1.0f / TMI_STEPS_PER_PX);
}

/* Whether a place lies so that nothing has to go on beyond the image's border; false for a NaN. */
static inline bool tmi_is_within(const tmi_view *view, tmi_point at)
{
    return at.x >= 0 && at.y >= 0 && at.x <= tmi_last_place(view->width) && at.y <= tmi_last_place(view->height);
}

/* The place at (x, y), in steps, which lies within the image. */
static inline tmi_place tmi_place_within(float x_steps, float y_steps)
{
    return (tmi_place){(uint32_t)(int32_t)x_steps, (uint32_t)(int32_t)y_steps};
}

/* The place within the image that is nearest to (x, y), in steps: outside of it the border pixels go on. */
static inline tmi_place tmi_nearest_place(const tmi_view *view, float x_steps, float y_steps)
{
    const float right = TMI_STEPS_PER_PX * tmi_last_place(view->width);
    const float bottom = TMI_STEPS_PER_PX * tmi_last_place(view->height);
    const float x = x_steps < right ? x_steps : right; /* a NaN, too, ends up within */
    const float y = y_steps < bottom ? y_steps : bottom;
    return tmi_place_within(x > 0 ? x : 0, y > 0 ? y : 0);
}

/* Bilinear interpolation at a place within the image. */
static inline float tmi_sample_within(const tmi_view *view, float x, float y)
{
    return tmi_gray(view, tmi_interpolate(view, tmi_place_within(TMI_STEPS_PER_PX * x, TMI_STEPS_PER_PX * y)), 1);
}

/* Bilinear interpolation anywhere. */
static inline float tmi_sample(const tmi_view *view, float x, float y)
{
    return tmi_gray(view, tmi_interpolate(view, tmi_nearest_place(view, TMI_STEPS_PER_PX * x, TMI_STEPS_PER_PX * y)),
                    1);
}

/* The one or the other. */
static inline float tmi_sample_at(const tmi_view *view, tmi_point at, bool within)
{
    return within ? tmi_sample_within(view, at.x, at.y) : tmi_sample(view, at.x, at.y);
}

#endif
