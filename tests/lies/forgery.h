/* What may stand between two finder patterns without being a code marker, or being one with cells that are wrong. */
#ifndef LIES_FORGERY_H
#define LIES_FORGERY_H

#include <stdint.h>

#include "code.h"
#include "random.h"
#include "tapemark.h"

typedef enum forgery {
    FORGERY_EVEN,       /* each cell dark or light by a coin */
    FORGERY_SHADED,     /* each cell dark with a share that is the pair's own */
    FORGERY_FRAMED,     /* the same within true alignment cells */
    FORGERY_UNCHECKED,  /* a word with another word's checksum */
    FORGERY_OVERFULL,   /* a word of five to eight ones, or zeros, with its own checksum */
    FORGERY_FLIPPED_1,  /* a true marker in which so many cells are flipped */
    FORGERY_FLIPPED_2,
    FORGERY_FLIPPED_3,
    FORGERY_COUNT
} forgery;

extern const char *const forgery_names[FORGERY_COUNT];

/* 1 is dark; row by row. */
typedef uint8_t forged_cells[TAPEMARK_CELLS];

/* A word of no to four ones, each number as likely as the others; or of zeros. */
int32_t random_id(random_source *source);

/* From 0 to count - 1. */
int random_below(random_source *source, int count);

void cells_of_id(int32_t id, forged_cells cells);

/* That many cells, each another one. */
void flip_cells(forged_cells cells, int count, random_source *source);

/* The printed cells of any word with any checksum. */
void cells_of_word(const tapemark_word *word, uint8_t checksum, forged_cells cells);

/* `id` is that of the marker in which cells are flipped, and used by those kinds alone. */
void forge(forgery kind, int32_t id, random_source *source, forged_cells cells);

/* The id whose print these cells are, or TMI_NO_ID: what nobody could tell from a true marker. */
int32_t id_of_cells(const forged_cells cells);

/* Whether the kind has an id that may be read. */
static inline int is_flipped(forgery kind)
{
    return kind >= FORGERY_FLIPPED_1;
}

#endif
