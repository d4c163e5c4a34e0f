/* Scan lines: run lengths in the proportion of a finder pattern, 1:1:3:1:1. */
#ifndef TAPEMARK_SCAN_H
#define TAPEMARK_SCAN_H

#include "view.h"

/* A stretch of a scan line that may run through the middle of a finder pattern. */
typedef struct tmi_hit {
    float centre;   /* px along the line */
    float chord;    /* px, length of all seven modules */
    float contrast; /* light minus dark */
} tmi_hit;

typedef void (*tmi_hit_function)(void *context, int32_t line, const tmi_hit *hit);

/* Scans `length` pixels of a line in the tiles whose swing is not zero; across flat tiles runs go on.
 * Returns the number of pixels read. */
int32_t tmi_scan_line(const uint8_t *pixels, ptrdiff_t step, int32_t length, uint8_t invert, const uint8_t *swing,
                      ptrdiff_t swing_step, int32_t line, tmi_hit_function on_hit, void *context);

#endif
