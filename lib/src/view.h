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

/* Places are interpolated between pixels in steps of 1/256 px. */
enum { TMI_STEPS_PER_PX = 256 };

/* Bilinear interpolation at a place in steps, its pixel and the next ones within the image; 65536 times the gray. */
static inline int32_t tmi_interpolate(const tmi_view *view, uint32_t x_steps, uint32_t y_steps)
{
    const int32_t part_x = (int32_t)(x_steps % TMI_STEPS_PER_PX), part_y = (int32_t)(y_steps % TMI_STEPS_PER_PX);
    const uint8_t *p =
        view->pixels + (ptrdiff_t)(y_steps / TMI_STEPS_PER_PX) * view->stride + x_steps / TMI_STEPS_PER_PX;
    const uint8_t *q = p + view->stride;
    const int32_t top = TMI_STEPS_PER_PX * p[0] + part_x * (p[1] - p[0]);
    const int32_t low = TMI_STEPS_PER_PX * q[0] + part_x * (q[1] - q[0]);
    return TMI_STEPS_PER_PX * top + part_y * (low - top);
}

/* The gray value that is the mean of so many interpolated ones. */
static inline float tmi_gray(const tmi_view *view, int32_t sum, int count)
{
    const float scale = 1 / ((float)(TMI_STEPS_PER_PX * TMI_STEPS_PER_PX) * (float)count);
    return view->sign * (float)sum * scale + view->offset;
}

/* Bilinear interpolation anywhere; outside of the image the border pixels go on. */
static inline float tmi_sample(const tmi_view *view, float x, float y)
{
    const float last = 1 - 1.0f / TMI_STEPS_PER_PX; /* of the way from the last pixel but one to the last */
    const float right = (float)(view->width - 2) + last, bottom = (float)(view->height - 2) + last;
    x = x > 0 ? x : 0; /* a NaN ends up as 0 */
    y = y > 0 ? y : 0;
    x = x < right ? x : right;
    y = y < bottom ? y : bottom;
    return tmi_gray(view, tmi_interpolate(view, (uint32_t)(int32_t)(TMI_STEPS_PER_PX * x),
                                          (uint32_t)(int32_t)(TMI_STEPS_PER_PX * y)), 1);
}

#endif
