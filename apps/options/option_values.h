/* Values on the command line: numbers, lengths, times and percentages with their units, and lists of them. Numbers
 * are decimal, without exponents. Each function tells in the error what would be right; the caller puts the option's
 * name in front. */
#ifndef OPTIONS_OPTION_VALUES_H
#define OPTIONS_OPTION_VALUES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "error_text.h"

typedef enum value_kind {
    VALUE_NUMBER,
    VALUE_WHOLE,   /* a number without a fraction */
    VALUE_LENGTH,  /* with a unit, m, cm, mm or in; given back in m */
    VALUE_TIME,    /* with a unit, s or ms; given back in s */
    VALUE_PERCENT  /* 100.3% is given back as 1.003 */
} value_kind;

typedef struct value_range {
    value_kind kind;
    double least, most;
} value_range;

bool parse_value(const char *text, value_range range, double *value, error_text *error);

/* Numbers with commas between them: at least `required`, at most `count`; the rest is left as it was. */
bool parse_numbers(const char *text, size_t required, size_t count, double *numbers, const char *what,
                   error_text *error);

/* WIDTHxHEIGHT. */
bool parse_size(const char *text, int32_t most_px, int32_t *width_px, int32_t *height_px, error_text *error);

/* Ids with commas between them, up to `capacity`. */
bool parse_ids(const char *text, size_t capacity, int32_t *ids, size_t *count, error_text *error);

/* The index of one of the names. */
bool parse_choice(const char *text, const char *const *names, size_t count, size_t *choice, error_text *error);

#endif
