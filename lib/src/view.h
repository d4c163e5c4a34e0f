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
    /* Where light and dark are exchanged: 255, -1 and 255; else 0, 1 and 0. Whole pixels are XORed with the
     * first; interpolated values are sign * value + offset. */
    uint8_t invert;
    float sign, offset;
} tmi_view;

/* Images below this size, either way, hold no marker; the decoder returns before it samples any. */
enum { TMI_SMALLEST_SIDE = 8 };

/* Bilinear interpolation; outside of the image the border pixels go on. */
static inline float tmi_sample(const tmi_view *view, float x, float y)
{
    const float right = (float)(view->width - 1), bottom = (float)(view->height - 1);
    x = x > 0 ? x : 0; /* a NaN ends up as 0 */
    y = y > 0 ? y : 0;
    x = x < right ? x : right;
    y = y < bottom ? y : bottom;
    int32_t column = (int32_t)x, row = (int32_t)y;
    column = column < view->width - 2 ? column : view->width - 2; /* the last pixel is the right one of its pair */
    row = row < view->height - 2 ? row : view->height - 2;
    const float fx = x - (float)column, fy = y - (float)row;
    const uint8_t *p = view->pixels + row * view->stride + column, *q = p + view->stride;
    const float top = (float)p[0] + fx * (float)(p[1] - p[0]);
    const float low = (float)q[0] + fx * (float)(q[1] - q[0]);
    return view->sign * (top + fy * (low - top)) + view->offset;
}

#endif
