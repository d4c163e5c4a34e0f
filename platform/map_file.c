#include "map_file.h"

#include "byte_reader.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A kilometre of tape is 1.3 MB. */
#define MAP_MAX_BYTES ((size_t)256 << 20)

/* The plan of the largest hall is smaller, in metres. */
#define COORDINATE_MAX_M 1e6

enum { TM_NAME_MAX = 31 };

typedef struct map_entry {
    size_t number;  /* in the file, from 1 */
    map_cm cm;
    char code[MAP_CODE_MAX + 1];  /* empty for a CM that stands alone */
    char tm_name[TM_NAME_MAX + 1];
} map_entry;

typedef struct map_entries {
    map_entry *items;
    size_t count;
} map_entries;

/* ---- Text and JSON ------------------------------------------------------------------------------------- */

static char *read_text(const char *path, size_t *size, error_text *error)
{
    byte_reader *reader = byte_reader_open(path, error);
    if (reader == NULL)
        return NULL;
    char *text = (char *)byte_reader_read_all(reader, MAP_MAX_BYTES, size, error);
    byte_reader_close(reader);
    return text;
}

static void explain_place(const char *text, size_t offset, size_t size, error_text *error)
{
    size_t line = 1, column = 1;
    for (size_t i = 0; i < offset; i++) {
        column = text[i] == '\n' ? 1 : column + 1;
        line += text[i] == '\n';
    }
    error_text_set(error, "is not valid JSON: %s line %zu, column %zu",
                   offset < size ? "error near" : "it ends too early at", line, column);
}

static cJSON *parse_text(const char *text, size_t size, error_text *error)
{
    const char *end = text;
    /* The zero byte counts, so that whatever follows the array is noticed. */
    cJSON *root = cJSON_ParseWithLengthOpts(text, size + 1, &end, true);
    if (root == NULL)
        explain_place(text, (size_t)(end - text), size, error);
    return root;
}

static bool get_number(const cJSON *item, const char *key, double *value)
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(item, key);
    if (!cJSON_IsNumber(member))
        return false;
    *value = member->valuedouble;
    return true;
}

/* NULL when there is no such key or it is no text. */
static const char *get_text(const cJSON *item, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, key));
}

static bool is_blank(const char *text)
{
    return text == NULL || text[strspn(text, " ")] == '\0';
}

/* ---- One entry ----------------------------------------------------------------------------------------- */

static bool read_position(const cJSON *item, map_entry *entry, error_text *error)
{
    if (get_number(item, "x", &entry->cm.x_m) && get_number(item, "y", &entry->cm.y_m) &&
        fabs(entry->cm.x_m) <= COORDINATE_MAX_M && fabs(entry->cm.y_m) <= COORDINATE_MAX_M)
        return true;
    error_text_set(error, "entry %zu (id %d): \"x\" and \"y\" must be metres on the plan", entry->number,
                   entry->cm.id);
    return false;
}

static bool read_id(const cJSON *item, map_id_check check_id, map_entry *entry, error_text *error)
{
    double id;
    if (!get_number(item, "idcm_decimal", &id) || id != floor(id) || fabs(id) > INT32_MAX ||
        !check_id((int32_t)id, NULL, NULL)) {
        error_text_set(error, "entry %zu: \"idcm_decimal\" must be the id of a code marker", entry->number);
        return false;
    }
    entry->cm.id = (int32_t)id;
    if (check_id(entry->cm.id, get_text(item, "idcm"), get_text(item, "checksum")))
        return true;
    error_text_set(error, "entry %zu (id %d): \"idcm\" or \"checksum\" belongs to another id", entry->number,
                   entry->cm.id);
    return false;
}

/* The running number may be a text or a number. */
static bool read_tm_name(const cJSON *item, map_entry *entry)
{
    const char *text = get_text(item, "n_tm");
    double number;
    int length;
    if (!is_blank(text))
        length = snprintf(entry->tm_name, sizeof entry->tm_name, "%s", text);
    else if (get_number(item, "n_tm", &number))
        length = snprintf(entry->tm_name, sizeof entry->tm_name, "%.17g", number);
    else
        return false;
    return length < (int)sizeof entry->tm_name;
}

static bool read_tm(const cJSON *item, map_entry *entry, error_text *error)
{
    const char *code = get_text(item, "idtm");
    entry->cm.tm = MAP_NO_TM;
    bool named = read_tm_name(item, entry);
    if (is_blank(code) && !named)
        return true;
    size_t length = is_blank(code) ? 0 : strlen(code);
    if (!named || length == 0 || length > MAP_CODE_MAX || strspn(code, "01") != length) {
        error_text_set(error, "entry %zu (id %d): \"idtm\" must be a code of 0 and 1 and \"n_tm\" its number, or "
                       "both blank", entry->number, entry->cm.id);
        return false;
    }
    memcpy(entry->code, code, length + 1);
    return true;
}

static bool read_entries(const cJSON *root, map_id_check check_id, map_entries *entries, error_text *error)
{
    if (!cJSON_IsArray(root) || cJSON_GetArraySize(root) == 0) {
        error_text_set(error, "is no map: expected an array of code markers");
        return false;
    }
    entries->items = calloc((size_t)cJSON_GetArraySize(root), sizeof *entries->items);
    if (entries->items == NULL) {
        error_text_set(error, "not enough memory for the map");
        return false;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, root) {
        map_entry *entry = &entries->items[entries->count++];
        entry->number = entries->count;
        if (!read_id(item, check_id, entry, error) || !read_position(item, entry, error) ||
            !read_tm(item, entry, error))
            return false;
    }
    return true;
}

/* ---- All entries together ------------------------------------------------------------------------------ */

static int compare_ids(const void *left, const void *right)
{
    const map_entry *a = left;
    const map_entry *b = right;
    return (a->cm.id > b->cm.id) - (a->cm.id < b->cm.id);
}

static int compare_tms(const void *left, const void *right)
{
    return strcmp(((const map_entry *)left)->tm_name, ((const map_entry *)right)->tm_name);
}

static bool check_repetition(map_entries *entries, error_text *error)
{
    qsort(entries->items, entries->count, sizeof *entries->items, compare_ids);
    for (size_t i = 1; i < entries->count; i++) {
        const map_entry *a = &entries->items[i - 1], *b = &entries->items[i];
        if (a->cm.id == b->cm.id) {
            size_t first = a->number < b->number ? a->number : b->number;
            error_text_set(error, "entries %zu and %zu both have the id %d", first, a->number + b->number - first,
                           a->cm.id);
            return false;
        }
    }
    return true;
}

/* Adds the TM whose CMs stand at entries[0 .. count). A light CM has an id of zero or more and is a 1 of the
 * code. */
static bool add_tm(tape_map *map, map_entry *entries, size_t count, error_text *error)
{
    map_tm *tm = &map->tms[map->tm_count];
    size_t length = strlen(entries[0].code), ones = 0, light = 0;
    double x_m = 0, y_m = 0;
    for (size_t i = 0; i < length; i++)
        ones += entries[0].code[i] == '1';
    for (size_t i = 0; i < count; i++) {
        if (strcmp(entries[i].code, entries[0].code) != 0) {
            error_text_set(error, "tape marker %s has the code %s in entry %zu and %s in entry %zu",
                           entries[0].tm_name, entries[0].code, entries[0].number, entries[i].code,
                           entries[i].number);
            return false;
        }
        light += entries[i].cm.id >= 0;
        x_m += entries[i].cm.x_m;
        y_m += entries[i].cm.y_m;
        entries[i].cm.tm = (int32_t)map->tm_count;
    }
    if (light > ones || count - light > length - ones) {
        error_text_set(error, "tape marker %s has the code %s, but %zu light and %zu dark code markers (entry %zu)",
                       entries[0].tm_name, entries[0].code, light, count - light, entries[0].number);
        return false;
    }
    memcpy(tm->code, entries[0].code, length + 1);
    tm->complete = count == length;
    tm->x_m = x_m / (double)count;
    tm->y_m = y_m / (double)count;
    map->tm_count++;
    return true;
}

static bool add_tms(tape_map *map, map_entries *entries, error_text *error)
{
    qsort(entries->items, entries->count, sizeof *entries->items, compare_tms);
    size_t begin = 0;
    while (begin < entries->count) {
        size_t end = begin + 1;
        while (end < entries->count && compare_tms(&entries->items[begin], &entries->items[end]) == 0)
            end++;
        if (entries->items[begin].tm_name[0] != '\0' &&
            !add_tm(map, entries->items + begin, end - begin, error))
            return false;
        begin = end;
    }
    return true;
}

static bool build_map(map_entries *entries, tape_map *map, error_text *error)
{
    map->cms = calloc(entries->count, sizeof *map->cms);
    map->tms = calloc(entries->count, sizeof *map->tms);
    if (map->cms == NULL || map->tms == NULL) {
        error_text_set(error, "not enough memory for the map");
        return false;
    }
    if (!check_repetition(entries, error) || !add_tms(map, entries, error))
        return false;
    qsort(entries->items, entries->count, sizeof *entries->items, compare_ids);
    for (size_t i = 0; i < entries->count; i++)
        map->cms[map->cm_count++] = entries->items[i].cm;
    return true;
}

bool map_file_read(const char *path, map_id_check check_id, tape_map *map, error_text *error)
{
    size_t size;
    map_entries entries = {0};
    *map = (tape_map){0};

    char *text = read_text(path, &size, error);
    cJSON *root = text != NULL ? parse_text(text, size, error) : NULL;
    bool done = root != NULL && read_entries(root, check_id, &entries, error) && build_map(&entries, map, error);
    if (!done)
        tape_map_release(map);
    free(entries.items);
    cJSON_Delete(root);
    free(text);
    return done;
}

void tape_map_release(tape_map *map)
{
    free(map->cms);
    free(map->tms);
    *map = (tape_map){0};
}

const map_cm *tape_map_find_cm(const tape_map *map, int32_t id)
{
    size_t begin = 0, end = map->cm_count;
    while (begin < end) {
        size_t middle = begin + (end - begin) / 2;
        if (map->cms[middle].id == id)
            return &map->cms[middle];
        if (map->cms[middle].id < id)
            begin = middle + 1;
        else
            end = middle;
    }
    return NULL;
}
