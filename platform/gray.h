/* Any frame as 8-bit gray. GREY, NV12 and YU12 are looked at in place; the others are converted into memory
 * that the converter keeps from frame to frame. */
#ifndef PLATFORM_GRAY_H
#define PLATFORM_GRAY_H

#include "frame.h"

typedef struct gray_view {
    const uint8_t *pixels;
    int32_t width_px;
    int32_t height_px;
    ptrdiff_t stride_bytes;
} gray_view;

/* Zeroed before the first use. */
typedef struct gray_converter {
    uint8_t *pixels;
    size_t pixels_size;
    uint16_t *rows;  /* three rows of samples and one of sums, for Bayer patterns */
    size_t rows_size;
} gray_converter;

/* The view stays valid until the next call with this converter, and while the frame's data does. Fails only
 * when memory runs out. Deeper samples lose their low bits; samples beyond their bit depth count as white. */
bool gray_from_frame(gray_converter *converter, const frame *input, gray_view *view, error_text *error);

void gray_converter_release(gray_converter *converter);

#endif
