/* Values of a plan file: where they stand, which keys there are, and numbers within their limits. */
#ifndef MAKE_PLAN_VALUES_H
#define MAKE_PLAN_VALUES_H

#include "error_text.h"

#include <cjson/cJSON.h>

#include <stdbool.h>
#include <stddef.h>

/* A place such as "lines[3].to_m[1]", put together as the reader goes down; empty for the whole plan. */
typedef struct json_path {
    char text[80];
} json_path;

json_path path_of_member(const json_path *parent, const char *key);
json_path path_of_element(const json_path *parent, int index);

typedef struct number_rule {
    const char *key;
    const char *unit;  /* " m", " mm", or nothing for whole numbers */
    double least, most;
} number_rule;

/* Whether it is an object with known keys alone, none twice; else with the key that was probably meant. `known` ends
 * with NULL. */
bool plan_check_keys(const cJSON *object, const json_path *place, const char *const *known, error_text *error);

/* Tells what is missing under a key; always false. */
bool plan_refuse_missing(const json_path *place, const char *key, const char *what, error_text *error);

bool plan_within(double value, const number_rule *rule);

/* Which unit was probably meant by a number that is out of range: nothing, or text to be put behind a message. */
void plan_unit_hint(double value, const number_rule *rule, char *hint, size_t size);

bool plan_read_number(const cJSON *item, const json_path *path, const number_rule *rule, double *value,
                      error_text *error);

/* Leaves the value alone when there is no such key. */
bool plan_read_optional(const cJSON *object, const json_path *place, const number_rule *rule, double *value,
                        error_text *error);

/* Whether it is an array of two values. */
bool plan_check_pair(const cJSON *item, const json_path *path, const char *what, error_text *error);

#endif
