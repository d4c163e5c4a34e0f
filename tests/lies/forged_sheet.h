/* A frame full of forged markers: alone, or in rows that share their finder patterns. */
#ifndef LIES_FORGED_SHEET_H
#define LIES_FORGED_SHEET_H

#include <stdbool.h>
#include <stddef.h>

#include "forgery.h"
#include "scene.h"

enum { FORGED_PAIRS_MAX = 96 };

typedef struct forged_sheet_plan {
    forgery kind;
    int row_cms;          /* 1: alone; more: segments of so many */
    double px_per_module;
    const int32_t *ids;   /* the kinds that flip cells take theirs from these; NULL: any */
    size_t id_count;
} forged_sheet_plan;

typedef struct forged_pair {
    double x_px, y_px;  /* of its centre */
    int32_t id;         /* of the marker in which cells are flipped; TMI_NO_ID: any reading of it is wrong */
    int32_t printed;    /* the id whose print it happens to be all the same, or TMI_NO_ID */
} forged_pair;

typedef struct forged_sheet {
    uint8_t *pixels;  /* to be freed by the caller */
    int32_t width_px, height_px;
    forged_pair pairs[FORGED_PAIRS_MAX];
    size_t pair_count;
} forged_sheet;

/* False when memory runs out. */
bool forged_sheet_make(const forged_sheet_plan *plan, random_source *source, forged_sheet *sheet);

/* The pair to which a reading with these corners belongs; NULL: to none. */
const forged_pair *forged_pair_at(const forged_sheet *sheet, double px_per_module, const tapemark_point corners[4]);

#endif
