/* What is on panels, tapes and pictures, ready to be painted: prints when first seen; kept for all poses. */
#ifndef SCENE_PRINTS_H
#define SCENE_PRINTS_H

#include "looks.h"
#include "scene.h"

/* A printed tape as cells: 1 dark, 0 light, quiet zone included. */
typedef struct tape_print {
    uint8_t *cells;
    int32_t columns, rows;
    int32_t quiet_columns, quiet_rows;
    float shades[2];  /* light of a cell */
} tape_print;

/* A picture as light, summed up along its rows: of row y, the first x texels have sums[y * (columns + 1) + x], in
 * units of 1 / PICTURE_SUM_UNITS. Whole numbers, so that differences of large sums are exact. */
enum { PICTURE_SUM_UNITS = 2048 };

typedef struct picture_print {
    uint32_t *sums;
    int32_t columns, rows;
    float border;
} picture_print;

enum { TAPE_QUIET_ROWS = 1 };

static inline int32_t tape_quiet_columns(const scene_tape *tape)
{
    return tape->bars ? 2 : 1;
}

typedef struct prints {
    const scene *view;
    tape_print *tapes;        /* without cells where not yet made */
    picture_print *pictures;  /* without sums where not yet made */
    panel_look *looks;
    noise_table *noise;
} prints;

/* False when memory runs out. Either way, prints_release() is to be called. */
bool prints_create(prints *all, const scene *view);
void prints_release(prints *all);

/* NULL when memory runs out. */
const tape_print *print_of_tape(prints *all, size_t index);
const picture_print *print_of_picture(prints *all, size_t index);

#endif
