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

enum { UNITS_MAX = 4 };

/* The first unit is the one that values are given back in, but for percentages. */
static const struct {
    const char *what;
    value_unit units[UNITS_MAX];
} kinds[] = {
    [VALUE_NUMBER] = {"a number", {{"", 1}}},
    [VALUE_WHOLE] = {"a whole number", {{"", 1}}},
    [VALUE_LENGTH] = {"a length in m, cm, mm or in", {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"in", 0.0254}}},
    [VALUE_TIME] = {"a time in s or ms", {{"s", 1}, {"ms", 1e-3}}},
    [VALUE_PERCENT] = {"a percentage", {{"%", 1e-2}}},
};

/* A sign if need be, and digits with at most one point. Returns what follows, NULL when there is no such number. */
static const char *read_decimal(const char *text, double *number)
{
    const char *digits = text + (*text == '-' || *text == '+');
    size_t whole = strspn(digits, "0123456789");
    size_t fraction = digits[whole] == '.' ? strspn(digits + whole + 1, "0123456789") : 0;
    if (whole + fraction == 0)
        return NULL;
    *number = strtod(text, NULL);
    return digits + whole + (digits[whole] == '.' ? 1 + fraction : 0);
}

/* NULL when the text is none of the kind's units. */
static const value_unit *find_unit(value_kind kind, const char *text)
{
    for (size_t i = 0; i < UNITS_MAX && kinds[kind].units[i].name != NULL; i++) {
        if (strcmp(kinds[kind].units[i].name, text) == 0)
            return &kinds[kind].units[i];
    }
    return NULL;
}

/* The bounds belong to the range, also where a unit's factor rounds past them. */
static bool take_within(double given, value_range range, double *value)
{
    const double rounding = 1e-12;
    *value = fmin(fmax(given, range.least), range.most);
    return fabs(given - *value) <= rounding * fabs(*value) && (range.kind != VALUE_WHOLE || *value == floor(*value));
}

bool parse_value(const char *text, value_range range, double *value, error_text *error)
{
    double number = 0;
    const char *rest = read_decimal(text, &number);
    const value_unit *unit = rest != NULL ? find_unit(range.kind, rest + strspn(rest, " ")) : NULL;
    if (unit != NULL) {
        if (take_within(number * unit->factor, range, value))
            return true;
    } else {
        unit = kinds[range.kind].units;
    }
    error_text_set(error, "expected %s from %.10g%s to %.10g%s, not \"%.60s\"", kinds[range.kind].what,
                   range.least / unit->factor, unit->name, range.most / unit->factor, unit->name, text);
    return false;
}

bool parse_numbers(const char *text, size_t required, size_t count, double *numbers, const char *what,
                   error_text *error)
{
    const char *at = text;
    for (size_t i = 0; i < count; i++) {
        double number = 0;
        const char *end = read_decimal(at, &number);
        if (end == NULL || !isfinite(number) || (*end != ',' && *end != '\0'))
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
