/* JSON files, read whole, and what is wrong with them and where. */
#ifndef PLATFORM_JSON_FILE_H
#define PLATFORM_JSON_FILE_H

#include "error_text.h"

#include <cjson/cJSON.h>

#include <stdbool.h>
#include <stddef.h>

/* Beyond these a file is refused before anything is made of it: a value takes some 100 bytes of memory. */
enum { JSON_FILE_BYTES_MAX = 128 << 20, JSON_FILE_VALUES_MAX = 8000000, JSON_FILE_DEPTH_MAX = 64 };

/* NULL, with line and column, when the file is no JSON or is larger or nested deeper than any sensible one. The
 * caller deletes what it gets. */
cJSON *json_file_read(const char *path, error_text *error);

bool json_has(const cJSON *object, const char *key);

/* False when there is no such key, or its value is no number. Numbers beyond those of double become infinite. */
bool json_get_number(const cJSON *object, const char *key, double *number);

/* NULL when there is no such key, or its value is no text. */
const char *json_get_text(const cJSON *object, const char *key);

/* Whether it is an object in which no known key stands twice; and no other keys are there unless they may. `known`
 * ends with NULL and has at most 32 keys. */
bool json_check_keys(const cJSON *item, const char *const *known, bool others_allowed, error_text *error);

#endif
