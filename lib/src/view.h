/* Reading gray values out of the caller's image. */
#ifndef TAPEMARK_VIEW_H
#define TAPEMARK_VIEW_H

#include <stddef.h>
#include <stdint.h>

typedef struct tmi_point {
    float x, y;
} tmi_point;

typedef struct tmi_view {
    const uint8_t *pixels;
    int32_t width, height;
    ptrdiff_t stride;
    uint8_t invert; /* 255 when light and dark are exchanged, else 0; XORed to every pixel read */
} tmi_view;

/* Bilinear interpolation; outside of the image the border pixels go on. */
static inline float tmi_sample(const tmi_view *view, float x, float y)
{
    const float right = (float)(view->width - 1), bottom = (float)(view->height - 1);
    x = x > 0 ? (x < right ? x : right) : 0; /* a NaN ends up as 0 */
    y = y > 0 ? (y < bottom ? y : bottom) : 0;
    const int32_t column = (int32_t)x, row = (int32_t)y;
    const float fx = x - (float)column, fy = y - (float)row;
    const ptrdiff_t next_column = column + 1 < view->width, next_row = row + 1 < view->height ? view->stride : 0;
    const uint8_t *p = view->pixels + row * view->stride + column;
    const float top = (float)p[0] + fx * (float)(p[next_column] - p[0]);
    const float low = (float)p[next_row] + fx * (float)(p[next_row + next_column] - p[next_row]);
    const float value = top + fy * (low - top);
    return view->invert ? 255.0f - value : value;
}

#endif
