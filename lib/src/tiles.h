/* The first pass: which parts of the image have enough contrast to be worth a closer look. */
#ifndef TAPEMARK_TILES_H
#define TAPEMARK_TILES_H

#include "view.h"

#include "tapemark.h"

/* One byte a tile in each plane, with a border of one tile all round so that neighbours always exist. */
typedef struct tmi_tiles {
    uint8_t *low;   /* darkest pixel */
    uint8_t *high;  /* lightest pixel */
    uint8_t *swing; /* least change that counts as an edge in this tile; 0: too flat to be scanned */
    /* One bit a tile that has a swing, the first tile in the lowest bit: each row of tiles, and each column, begins
     * a new word. They let scan lines leap over flat parts. */
    uint32_t *row_bits, *column_bits;
    int32_t columns, rows;
    ptrdiff_t pitch; /* from one row of tiles to the next */
    int32_t row_words, column_words;
    uint32_t active;      /* tiles with a swing */
    uint8_t bar;          /* contrast that a tile must have for one, */
    uint8_t contrast_min; /* and one in deep shade */
    uint8_t lightest;     /* of all pixels */
} tmi_tiles;

/* What is darker than this part of the lightest pixel lies in deep shade. */
enum { SHADE_PARTS = 8 };

/* Whether that is contrast at a tile's place in the planes. In deep shade the bar, a part of the contrast in the
 * light, would leave out all there is; and noise, which grows with the light, is least there. */
static inline bool tmi_is_contrast(const tmi_tiles *tiles, ptrdiff_t i, int contrast)
{
    return contrast >= tiles->contrast_min &&
           (contrast >= tiles->bar || SHADE_PARTS * tiles->high[i] < tiles->lightest);
}

/* The contrast that sensor noise has at most. */
uint8_t tmi_tiles_noise(const tmi_tiles *tiles);

/* Lays everything out in `memory`, which is aligned for uint32_t and as large as TAPEMARK_WORKSPACE_BYTES has it
 * beyond the fixed part, and fills it. About `active_max` tiles stay active: where many have enough contrast, what
 * may be noise is left out first; where there are more still, the bar is raised. Returns whether that was needed. */
bool tmi_tiles_build(tmi_tiles *tiles, const tmi_view *view, uint8_t contrast_min, uint32_t active_max, void *memory);

#endif
