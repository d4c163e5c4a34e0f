/* Ranges of ids, as --only takes them. */
#ifndef MAKE_ID_RANGES_H
#define MAKE_ID_RANGES_H

#include "error_text.h"
#include "print.h"

/* 17, 17..20 or several of these with commas between them; signs do not matter. The caller frees the ranges. False,
 * with what would be right, for anything else. */
bool parse_id_ranges(const char *text, print_id_range **ranges, size_t *count, error_text *error);

#endif
