/* Pictures of tapes, drawn as a script says: without the care of a renderer, but a hundred times faster. */
#ifndef TAPE_SKETCH_H
#define TAPE_SKETCH_H

#include "byte_script.h"

enum { SKETCH_SIDE_MAX_PX = 400, SKETCH_PIXELS_MAX = 48000, SKETCH_CMS_MAX = 36 };

typedef struct tape_sketch {
    uint8_t *pixels;  /* rows without gaps; the caller frees them */
    int32_t width_px, height_px;

    /* What is in the picture when it is one tape that nothing was done to; else cm_count is 0. */
    int32_t ids[SKETCH_CMS_MAX];
    size_t cm_count;
    bool bars;
} tape_sketch;

/* Sizes and a background, up to four tapes at any place, angle, size and slant, and then damage until the script
 * ends. A script of zeros is a small tape that can be read. */
tape_sketch tape_sketch_draw(byte_script *script);

#endif
