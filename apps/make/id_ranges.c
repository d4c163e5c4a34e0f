#include "id_ranges.h"

#include "tapemark.h"

#include <stdlib.h>
#include <string.h>

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

bool parse_id_ranges(const char *text, print_id_range **ranges, size_t *count, error_text *error)
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
    error_text_set(error, "expected ids such as 17..20 or 5,17..20, from 0 to %d and the smaller first, not "
                   "\"%.40s\"", TAPEMARK_MAX_ID, text);
    return false;
}
