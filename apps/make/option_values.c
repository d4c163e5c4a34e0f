#include "option_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct unit {
    const char *name;
    double metres;
} unit;

static const unit units[] = {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}};

/* Digits with at most one point: neither hexadecimal nor infinite, nor with an exponent. Returns what follows, NULL
 * when there is no such number. */
static const char *read_decimal(const char *text, double *number)
{
    size_t whole = strspn(text, "0123456789");
    size_t fraction = text[whole] == '.' ? strspn(text + whole + 1, "0123456789") : 0;
    if (whole + fraction == 0)
        return NULL;
    *number = strtod(text, NULL);
    return text + whole + (text[whole] == '.' ? 1 + fraction : 0);
}

static const unit *find_unit(const char *name)
{
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, name) == 0)
            return &units[i];
    return NULL;
}

bool value_length_m(const char *text, double least_m, double most_m, double *length_m, error_text *error)
{
    double number = 0;
    const char *rest = read_decimal(text, &number);
    const unit *given = rest != NULL ? find_unit(rest + strspn(rest, " ")) : NULL;
    if (given == NULL) {
        error_text_set(error, "expected a length with its unit (m, cm, mm or in), such as 3.2m, not '%.40s'", text);
        return false;
    }
    *length_m = number * given->metres;
    if (*length_m >= least_m && *length_m <= most_m)
        return true;
    error_text_set(error, "%.40s is out of range, %.6g%s to %.6g%s", text, least_m / given->metres, given->name,
                   most_m / given->metres, given->name);
    return false;
}

bool value_percent(const char *text, double least, double most, double *factor, error_text *error)
{
    double number = 0;
    const char *rest = read_decimal(text, &number);
    *factor = number / 100;
    if (rest != NULL && strcmp(rest, "%") == 0 && *factor >= least && *factor <= most)
        return true;
    error_text_set(error, "expected %.6g%% to %.6g%%, such as 100.3%%, not '%.40s'", least * 100, most * 100, text);
    return false;
}

bool value_number(const char *text, double least, double most, double *number, error_text *error)
{
    const char *rest = read_decimal(text, number);
    if (rest != NULL && *rest == '\0' && *number >= least && *number <= most)
        return true;
    error_text_set(error, "expected a number from %.6g to %.6g, not '%.40s'", least, most, text);
    return false;
}

bool value_whole(const char *text, long least, long most, long *number, error_text *error)
{
    double value = 0;
    const char *rest = read_decimal(text, &value);
    if (rest != NULL && *rest == '\0' && value >= (double)least && value <= (double)most && value == floor(value)) {
        *number = (long)value;
        return true;
    }
    error_text_set(error, "expected a whole number from %ld to %ld, not '%.40s'", least, most, text);
    return false;
}

/* These return what follows, NULL when there is no id or range. */
static const char *read_id(const char *text, int32_t *id)
{
    text += *text == '-';
    size_t digits = strspn(text, "0123456789");
    long number = digits >= 1 && digits <= 7 ? strtol(text, NULL, 10) : -1;
    *id = (int32_t)number;
    return number >= 0 && number <= TAPEMARK_MAX_ID ? text + digits : NULL;
}

static const char *read_range(const char *text, print_id_range *range)
{
    const char *rest = read_id(text, &range->first);
    range->last = range->first;
    if (rest != NULL && strncmp(rest, "..", 2) == 0)
        rest = read_id(rest + 2, &range->last);
    return rest != NULL && range->first <= range->last ? rest : NULL;
}

bool value_id_ranges(const char *text, print_id_range **ranges, size_t *count, error_text *error)
{
    size_t most = 1;
    for (const char *at = text; *at != '\0'; at++)
        most += *at == ',';
    *count = 0;
    *ranges = calloc(most, sizeof **ranges);
    if (*ranges == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    for (const char *at = text; at != NULL && *count < most; at++) {
        at = read_range(at, &(*ranges)[*count]);
        if (at == NULL || (*at != ',' && *at != '\0'))
            break;
        if (++*count == most)
            return true;
    }
    free(*ranges);
    *ranges = NULL;
    error_text_set(error, "expected ids such as 17..20 or 5,17..20, from 0 to %d and the smaller first, not '%.40s'",
                   TAPEMARK_MAX_ID, text);
    return false;
}
