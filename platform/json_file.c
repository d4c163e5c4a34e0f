#include "json_file.h"

#include "byte_reader.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- Before parsing ------------------------------------------------------------------------------------------ */

typedef struct text_place {
    size_t line, column;
} text_place;

static text_place place_of(const char *text, size_t offset)
{
    text_place place = {1, 1};
    for (size_t i = 0; i < offset; i++) {
        place.column = text[i] == '\n' ? 1 : place.column + 1;
        place.line += text[i] == '\n';
    }
    return place;
}

static bool refuse(const char *text, size_t offset, const char *what, error_text *error)
{
    text_place place = place_of(text, offset);
    error_text_set(error, "line %zu, column %zu: %s", place.line, place.column, what);
    return false;
}

/* A NUL would end a text early, and what stands behind it would be lost. */
static bool check_zeros(const char *text, size_t size, error_text *error)
{
    const char *zero = memchr(text, '\0', size);
    if (zero != NULL)
        return refuse(text, (size_t)(zero - text), "a zero byte in a text file", error);
    zero = strstr(text, "\\u0000");
    return zero == NULL || refuse(text, (size_t)(zero - text), "\\u0000 is not allowed", error);
}

/* Values and nesting, told by the punctuation outside of strings. */
static bool check_extent(const char *text, size_t size, error_text *error)
{
    size_t values = 1, depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        if (in_string) {
            if (c == '\\')
                i++;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            values++;
            if (++depth > JSON_FILE_DEPTH_MAX)
                return refuse(text, i, "nested too deeply", error);
        } else if (c == ']' || c == '}') {
            depth -= depth > 0;
        } else if (c == ',' && ++values > JSON_FILE_VALUES_MAX) {
            error_text_set(error, "holds more than %d values: it is too large", JSON_FILE_VALUES_MAX);
            return false;
        }
    }
    return true;
}

/* ---- Parsing ------------------------------------------------------------------------------------------------- */

static cJSON *parse(const char *text, size_t size, error_text *error)
{
    const char *end = text;
    if (!check_zeros(text, size, error) || !check_extent(text, size, error))
        return NULL;
    /* The zero byte counts, so that whatever follows the outermost value is noticed. */
    cJSON *root = cJSON_ParseWithLengthOpts(text, size + 1, &end, true);
    if (root == NULL) {
        size_t offset = (size_t)(end - text);
        text_place place = place_of(text, offset);
        error_text_set(error, "is not valid JSON: %s line %zu, column %zu",
                       offset < size ? "error near" : "it ends too early at", place.line, place.column);
    }
    return root;
}

cJSON *json_file_read(const char *path, error_text *error)
{
    size_t size;
    byte_reader *reader = byte_reader_open(path, error);
    if (reader == NULL)
        return NULL;
    char *text = (char *)byte_reader_read_all(reader, JSON_FILE_BYTES_MAX, &size, error);
    byte_reader_close(reader);
    cJSON *root = text != NULL ? parse(text, size, error) : NULL;
    free(text);
    return root;
}

/* ---- Members ------------------------------------------------------------------------------------------------- */

bool json_has(const cJSON *object, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(object, key) != NULL;
}

bool json_get_number(const cJSON *object, const char *key, double *number)
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(object, key);
    if (!cJSON_IsNumber(member))
        return false;
    *number = member->valuedouble;
    return true;
}

const char *json_get_text(const cJSON *object, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
}

bool json_check_keys(const cJSON *item, const char *const *known, bool others_allowed, error_text *error)
{
    uint32_t seen = 0;
    if (!cJSON_IsObject(item)) {
        error_text_set(error, "must be an object, {...}");
        return false;
    }
    for (const cJSON *member = item->child; member != NULL; member = member->next) {
        unsigned key = 0;
        while (known[key] != NULL && strcmp(known[key], member->string) != 0)
            key++;
        if (known[key] == NULL) {
            if (others_allowed)
                continue;
            error_text_set(error, "the key \"%.40s\" is unknown", member->string);
            return false;
        }
        if (seen >> key & 1) {
            error_text_set(error, "the key \"%s\" stands there twice", known[key]);
            return false;
        }
        seen |= UINT32_C(1) << key;
    }
    return true;
}
