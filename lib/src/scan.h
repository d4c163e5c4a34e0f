/* Scan lines: run lengths in the proportion of a finder pattern, 1:1:3:1:1. */
#ifndef TAPEMARK_SCAN_H
#define TAPEMARK_SCAN_H

#include "stroke.h"
#include "view.h"

/* A stretch of a scan line that may run through the middle of a finder pattern. */
typedef struct tmi_hit {
    float centre;   /* px along the line */
    float chord;    /* px, length of all seven modules */
    float contrast; /* light minus dark */
} tmi_hit;

typedef void (*tmi_hit_function)(void *context, int32_t line, const tmi_hit *hit);

/* A row or a column of the image, and the tiles that it runs through. */
typedef struct tmi_scan {
    const uint8_t *pixels;
    ptrdiff_t step;         /* from one pixel of the line to the next */
    int32_t length, number; /* px; and which line it is, for on_hit */
    uint8_t invert;         /* see tmi_view */
    const uint8_t *swing;   /* of its first tile; see tmi_tiles */
    ptrdiff_t swing_step;
    const uint32_t *active; /* one bit a tile: those with a swing */
    int32_t words;
    tmi_strokes *strokes; /* where to note what is as high as a far tape; NULL: not wanted */
    bool vertical;        /* for those: the line is a column */
} tmi_scan;

/* Scans a line in its active tiles; across flat ones runs go on. Returns the number of pixels read. */
int32_t tmi_scan_line(const tmi_scan *line, tmi_hit_function on_hit, void *context);

#endif
