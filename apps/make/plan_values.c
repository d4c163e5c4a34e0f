#include "plan_values.h"

#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- Places ------------------------------------------------------------------------------------------------- */

json_path path_of_member(const json_path *parent, const char *key)
{
    json_path path;
    const char *dot = parent->text[0] == '\0' ? "" : ".";
    snprintf(path.text, sizeof path.text, "%.40s%s%.30s", parent->text, dot, key);
    return path;
}

json_path path_of_element(const json_path *parent, int index)
{
    json_path path;
    snprintf(path.text, sizeof path.text, "%.60s[%d]", parent->text, index);
    return path;
}

/* ---- Keys ---------------------------------------------------------------------------------------------------- */

enum { KEY_MAX = 40 };

static size_t smallest(size_t a, size_t b, size_t c)
{
    size_t least = a < b ? a : b;
    return least < c ? least : c;
}

/* Letters to add, drop or change until one word is the other. */
static size_t edit_distance(const char *a, const char *b)
{
    size_t row[KEY_MAX + 1], length = strlen(b);
    for (size_t j = 0; j <= length; j++)
        row[j] = j;
    for (size_t i = 0; a[i] != '\0'; i++) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < length; j++) {
            size_t changed = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = smallest(row[j] + 1, row[j + 1] + 1, changed);
        }
    }
    return row[length];
}

/* NULL when none is near. */
static const char *nearest_key(const char *wrong, const char *const *known)
{
    const char *nearest = NULL;
    size_t least = 4;
    for (; *known != NULL; known++) {
        size_t distance = strlen(wrong) <= KEY_MAX ? edit_distance(wrong, *known) : KEY_MAX;
        if (strstr(*known, wrong) != NULL && strlen(wrong) >= 4 && least > 3)
            distance = 3;
        if (distance < least) {
            least = distance;
            nearest = *known;
        }
    }
    return nearest;
}

static const char *unit_of_key(const char *key)
{
    size_t length = strlen(key);
    if (length > 3 && strcmp(key + length - 3, "_mm") == 0)
        return ", in millimetres";
    return length > 2 && strcmp(key + length - 2, "_m") == 0 ? ", in metres" : "";
}

static void refuse_key(const json_path *place, const char *wrong, const char *const *known, error_text *error)
{
    json_path path = path_of_member(place, wrong);
    const char *nearest = nearest_key(wrong, known);
    if (nearest != NULL) {
        error_text_set(error, "%s: there is no such key; did you mean \"%s\"%s?", path.text, nearest,
                       unit_of_key(nearest));
        return;
    }
    char all[240] = "";
    for (size_t length = 0; *known != NULL && length < sizeof all; known++)
        length += (size_t)snprintf(all + length, sizeof all - length, " %s", *known);
    error_text_set(error, "%s: there is no such key; expected%s", path.text, all);
}

bool plan_check_keys(const cJSON *object, const json_path *place, const char *const *known, error_text *error)
{
    error_text reason;
    for (const cJSON *item = cJSON_IsObject(object) ? object->child : NULL; item != NULL; item = item->next) {
        const char *const *key = known;
        while (*key != NULL && strcmp(*key, item->string) != 0)
            key++;
        if (*key == NULL) {
            refuse_key(place, item->string, known, error);
            return false;
        }
    }
    if (json_check_keys(object, known, false, &reason))
        return true;
    error_text_set(error, "%s: %s", place->text[0] == '\0' ? "the plan" : place->text, reason.text);
    return false;
}

/* ---- Numbers ------------------------------------------------------------------------------------------------- */

bool plan_within(double value, const number_rule *rule)
{
    return value >= rule->least && value <= rule->most;
}

void plan_unit_hint(double value, const number_rule *rule, char *hint, size_t size)
{
    bool metres = strcmp(rule->unit, " m") == 0;
    double other = metres ? value / 1000 : value * 1000;
    hint[0] = '\0';
    if (rule->unit[0] != '\0' && other > 0 && plan_within(other, rule))
        snprintf(hint, size, " (%s? that would be %.6g%s)", metres ? "millimetres" : "metres", other, rule->unit);
}

bool plan_read_number(const cJSON *item, const json_path *path, const number_rule *rule, double *value,
                      error_text *error)
{
    bool whole = rule->unit[0] == '\0';
    if (!cJSON_IsNumber(item)) {
        error_text_set(error, "%s: expected a %s%s%s, without quotes", path->text, whole ? "whole number" : "number",
                       whole ? "" : " in", rule->unit);
        return false;
    }
    *value = item->valuedouble;
    if (!plan_within(*value, rule)) {
        char hint[80];
        plan_unit_hint(*value, rule, hint, sizeof hint);
        error_text_set(error, "%s: %.10g%s is out of range, %.10g to %.10g%s", path->text, *value, rule->unit,
                       rule->least, rule->most, hint);
        return false;
    }
    if (whole && *value != floor(*value)) {
        error_text_set(error, "%s: %.10g is no whole number", path->text, *value);
        return false;
    }
    return true;
}

bool plan_refuse_missing(const json_path *place, const char *key, const char *what, error_text *error)
{
    json_path path = path_of_member(place, key);
    error_text_set(error, "%s: is missing: %s", path.text, what);
    return false;
}

bool plan_read_optional(const cJSON *object, const json_path *place, const number_rule *rule, double *value,
                        error_text *error)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, rule->key);
    json_path path = path_of_member(place, rule->key);
    return item == NULL || plan_read_number(item, &path, rule, value, error);
}

bool plan_check_pair(const cJSON *item, const json_path *path, const char *what, error_text *error)
{
    if (cJSON_IsArray(item) && cJSON_GetArraySize(item) == 2)
        return true;
    error_text_set(error, "%s: expected two numbers, [%s], in metres", path->text, what);
    return false;
}
