#include "option_values.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tapemark.h"

typedef struct value_unit {
    const char *name;
    double factor;
} value_unit;

enum { UNITS_MAX = 3 };

static const struct {
    const char *what;
    value_unit units[UNITS_MAX];  /* the one that ranges are told in is the last; without a name: none */
} kinds[] = {
    [VALUE_NUMBER] = {"a number", {{"", 1}}},
    [VALUE_WHOLE] = {"a whole number", {{"", 1}}},
    [VALUE_LENGTH] = {"a length in mm, cm or m", {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}}},
    [VALUE_TIME] = {"a time in ms or s", {{"ms", 1e-3}, {"s", 1}}},
};

/* The factor of the unit that the text is; 0 when it is none of them. */
static double factor_of(value_kind kind, const char *text)
{
    for (size_t i = 0; i < UNITS_MAX && kinds[kind].units[i].name != NULL; i++) {
        if (strcmp(kinds[kind].units[i].name, text) == 0)
            return kinds[kind].units[i].factor;
    }
    return 0;
}

bool parse_value(const char *text, value_range range, double *value, error_text *error)
{
    char *end;
    double number = strtod(text, &end), factor = factor_of(range.kind, end);
    *value = number * factor;
    bool whole = range.kind != VALUE_WHOLE || *value == floor(*value);
    if (end != text && factor > 0 && whole && *value >= range.least && *value <= range.most)
        return true;
    const char *unit = range.kind == VALUE_LENGTH ? " m" : range.kind == VALUE_TIME ? " s" : "";
    error_text_set(error, "expected %s from %.10g to %.10g%s, not \"%.60s\"", kinds[range.kind].what, range.least,
                   range.most, unit, text);
    return false;
}

bool parse_numbers(const char *text, size_t required, size_t count, double *numbers, const char *what,
                   error_text *error)
{
    const char *at = text;
    for (size_t i = 0; i < count; i++) {
        char *end;
        double number = strtod(at, &end);
        if (end == at || !isfinite(number) || (*end != ',' && *end != '\0'))
            break;
        numbers[i] = number;
        if (*end == '\0' && i + 1 >= required)
            return true;
        if (*end == '\0')
            break;
        at = end + 1;
    }
    error_text_set(error, "expected numbers %s, not \"%.60s\"", what, text);
    return false;
}

bool parse_size(const char *text, int32_t most_px, int32_t *width_px, int32_t *height_px, error_text *error)
{
    char *end = NULL;
    long width = strtol(text, &end, 10), height = end != text && *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    if (*end != '\0' || width < 1 || width > most_px || height < 1 || height > most_px) {
        error_text_set(error, "expected WIDTHxHEIGHT, both 1 to %d, not \"%.60s\"", (int)most_px, text);
        return false;
    }
    *width_px = (int32_t)width;
    *height_px = (int32_t)height;
    return true;
}

bool parse_ids(const char *text, size_t capacity, int32_t *ids, size_t *count, error_text *error)
{
    const char *at = text;
    for (*count = 0; *count < capacity; at++) {
        char *end;
        errno = 0;
        long id = strtol(at, &end, 10);
        if (end == at || errno != 0 || id < -TAPEMARK_MAX_ID || id > TAPEMARK_MAX_ID)
            break;
        ids[(*count)++] = (int32_t)id;
        at = end;
        if (*at == '\0')
            return true;
        if (*at != ',')
            break;
    }
    error_text_set(error, "expected up to %zu ids from %d to %d with commas between them, not \"%.60s\"", capacity,
                   -TAPEMARK_MAX_ID, TAPEMARK_MAX_ID, text);
    return false;
}

bool parse_choice(const char *text, const char *const *names, size_t count, size_t *choice, error_text *error)
{
    for (*choice = 0; *choice < count; ++*choice) {
        if (strcmp(names[*choice], text) == 0)
            return true;
    }
    char all[300];
    size_t length = 0;
    for (size_t i = 0; i < count && length < sizeof all; i++)
        length += (size_t)snprintf(all + length, sizeof all - length, " %s", names[i]);
    error_text_set(error, "expected one of%s, not \"%.40s\"", all, text);
    return false;
}
