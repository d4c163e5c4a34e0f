/* What a page has room for. */
#ifndef PRINT_PAPER_H
#define PRINT_PAPER_H

#include "strip.h"

typedef struct paper_room {
    const char *name;
    double page_width_mm, page_height_mm;  /* the page itself; on a roll, of the longest one */
    double margin_mm;
    double scale_x, scale_y;
    double width_mm, height_mm;  /* within the margins, in lengths as they will be measured on paper */
    size_t rows;                 /* of pieces */
    strip_limits limits;         /* of pieces in a row */
} paper_room;

/* False when the settings are out of range, or the module is too large for the paper. */
bool paper_measure(const plan *wanted, const print_settings *settings, paper_room *room, error_text *error);

/* Tells which module would be small enough for pieces of `needed_halves`. */
void paper_tell_too_narrow(const plan *wanted, const paper_room *room, int64_t needed_halves, error_text *error);

/* Height of a row: quiet zone, ink, both bands, and the marks below them. */
double paper_row_mm(const plan *wanted);

/* At the lower end of each page: check ruler and page number. */
#define PAPER_FOOTER_MM 8.5

#endif
