/* A surface to be looked at: gray texels that go on over its edges without an end, at full size and at every half
 * of it. */
#ifndef CLUTTER_SHEET_H
#define CLUTTER_SHEET_H

#include <stdbool.h>
#include <stdint.h>

#include "error_text.h"

enum { SHEET_SIDE = 1024, SHEET_LEVELS = 8 };

typedef struct sheet {
    uint8_t *levels[SHEET_LEVELS];  /* each of (SHEET_SIDE >> level) squared texels, row by row; 255 is paper */
} sheet;

/* False when memory runs out. */
bool sheet_create(sheet *made);

void sheet_release(sheet *made);

/* Makes the smaller sizes of the full one. */
void sheet_shrink(sheet *painted);

/* Fills all sizes with the first frame of a picture file, again and again to the right and down; what is beyond
 * SHEET_SIDE is left out. False, with the name of the file, on failure. */
bool sheet_read(sheet *painted, const char *path, error_text *error);

#endif
