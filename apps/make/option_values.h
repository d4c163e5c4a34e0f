/* What stands behind an option: lengths with their units, percentages, numbers, ranges of ids. Each of these says in
 * the error what would be right; the caller puts the option's name in front. */
#ifndef MAKE_OPTION_VALUES_H
#define MAKE_OPTION_VALUES_H

#include "error_text.h"
#include "print.h"

/* A length such as 3.2m, 60 mm, 40cm or 5in. */
bool value_length_m(const char *text, double least_m, double most_m, double *length_m, error_text *error);

/* 100.3% is 1.003. */
bool value_percent(const char *text, double least, double most, double *factor, error_text *error);

bool value_number(const char *text, double least, double most, double *number, error_text *error);

bool value_whole(const char *text, long least, long most, long *number, error_text *error);

/* 17, 17..20 or several of these with commas between them; signs do not matter. The caller frees the ranges. */
bool value_id_ranges(const char *text, print_id_range **ranges, size_t *count, error_text *error);

#endif
