/*
 * The map format of the marker's inventors: a JSON array with one object a CM and the keys
 *
 *     idcm_decimal    the id, a whole number
 *     x, y            its centre on the plan, in metres
 *     idtm            the code of its TM, '0' and '1', or blank for a CM that stands alone
 *     n_tm            the running number of its TM, or blank
 *     idcm, checksum  the 78 bits of its code word and the 8 of its checksum; may be left out
 *     largura, altura the width and height of the plan, in metres; may be left out
 *
 * Other keys are let pass: x1, y1, x2 and y2, the ends of a TM, contradict the places of its CMs in the only map that
 * was published. Some CMs of a TM may be missing, and there may be gaps between them; but those that are there
 * follow its code, in the order of the file or in that of the ids without their signs.
 */
#include "json_file.h"
#include "map_read.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TM_NAME_MAX = 31 };

typedef struct map_entry {
    size_t number;  /* in the file, from 1 */
    size_t group;   /* number of the first entry of its TM */
    int32_t id;
    map_point centre;
    char code[MAP_CODE_MAX + 1];  /* empty for a CM that stands alone */
    char tm_name[TM_NAME_MAX + 1];
} map_entry;

/* ---- One entry ----------------------------------------------------------------------------------------------- */

/* A text, or NULL where there is none; false for anything else. */
static bool get_optional_text(const cJSON *item, const char *key, const char **text)
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(item, key);
    *text = cJSON_GetStringValue(member);
    return member == NULL || cJSON_IsNull(member) || *text != NULL;
}

static bool read_id(const cJSON *item, map_id_check check_id, map_entry *entry, error_text *error)
{
    double id;
    if (!json_get_number(item, "idcm_decimal", &id) || id != floor(id) || fabs(id) > INT32_MAX ||
        !check_id((int32_t)id, NULL, NULL)) {
        error_text_set(error, "entry %zu: \"idcm_decimal\" must be the id of a code marker", entry->number);
        return false;
    }
    entry->id = (int32_t)id;
    const char *word, *checksum;
    if (get_optional_text(item, "idcm", &word) && get_optional_text(item, "checksum", &checksum) &&
        check_id(entry->id, word, checksum))
        return true;
    error_text_set(error, "entry %zu (id %d): \"idcm\" or \"checksum\" belongs to another id", entry->number,
                   entry->id);
    return false;
}

static bool read_position(const cJSON *item, const tape_map *map, map_entry *entry, error_text *error)
{
    map_point *centre = &entry->centre;
    if (!json_get_number(item, "x", &centre->x_m) || !json_get_number(item, "y", &centre->y_m) ||
        !(fabs(centre->x_m) <= MAP_COORDINATE_MAX_M && fabs(centre->y_m) <= MAP_COORDINATE_MAX_M)) {
        error_text_set(error, "entry %zu (id %d): \"x\" and \"y\" must be metres on the plan", entry->number,
                       entry->id);
        return false;
    }
    if (map_point_on_plan(map, *centre))
        return true;
    error_text_set(error, "entry %zu (id %d): (%.3f, %.3f) lies outside of the plan, %.3f m x %.3f m", entry->number,
                   entry->id, centre->x_m, centre->y_m, map->width_m, map->height_m);
    return false;
}

static bool is_blank(const char *text)
{
    return text == NULL || text[strspn(text, " ")] == '\0';
}

/* The running number may be a text or a number. */
static bool read_tm_name(const cJSON *item, map_entry *entry)
{
    const char *text = json_get_text(item, "n_tm");
    double number;
    int length;
    if (!is_blank(text))
        length = snprintf(entry->tm_name, sizeof entry->tm_name, "%s", text);
    else if (json_get_number(item, "n_tm", &number))
        length = snprintf(entry->tm_name, sizeof entry->tm_name, "%.17g", number);
    else
        return false;
    return length < (int)sizeof entry->tm_name;
}

static bool read_tm(const cJSON *item, map_entry *entry, error_text *error)
{
    const char *code;
    bool is_text = get_optional_text(item, "idtm", &code), named = read_tm_name(item, entry);
    if (is_text && is_blank(code) && !named)
        return true;
    size_t length = is_blank(code) ? 0 : strlen(code);
    if (!named || length < MAP_CODE_MIN || length > MAP_CODE_MAX || strspn(code, "01") != length) {
        error_text_set(error, "entry %zu (id %d): \"idtm\" must be a code of %d to %d 0 and 1 and \"n_tm\" its "
                       "number, or both blank", entry->number, entry->id, MAP_CODE_MIN, MAP_CODE_MAX);
        return false;
    }
    memcpy(entry->code, code, length + 1);
    return true;
}

/* The size of the plan stands in each entry, or in none. */
static bool read_plan(const cJSON *item, tape_map *map, const map_entry *entry, error_text *error)
{
    double width_m = 0, height_m = 0;
    bool given = json_has(item, "largura") || json_has(item, "altura");
    if (given && !(json_get_number(item, "largura", &width_m) && json_get_number(item, "altura", &height_m) &&
                   width_m > 0 && width_m <= MAP_COORDINATE_MAX_M && height_m > 0 &&
                   height_m <= MAP_COORDINATE_MAX_M)) {
        error_text_set(error, "entry %zu: \"largura\" and \"altura\" must be metres above 0", entry->number);
        return false;
    }
    if (entry->number == 1) {
        map->width_m = width_m;
        map->height_m = height_m;
    } else if (fabs(width_m - map->width_m) > MAP_TOLERANCE_M || fabs(height_m - map->height_m) > MAP_TOLERANCE_M) {
        error_text_set(error, "entry %zu: \"largura\" or \"altura\" differs from that of entry 1", entry->number);
        return false;
    }
    return true;
}

static bool read_entry(const cJSON *item, map_id_check check_id, tape_map *map, map_entry *entry, error_text *error)
{
    static const char *const keys[] = {"idcm_decimal", "x", "y", "idtm", "n_tm", "idcm", "checksum", "largura",
                                       "altura", NULL};
    error_text reason;
    if (!json_check_keys(item, keys, true, &reason)) {
        error_text_set(error, "entry %zu: %s", entry->number, reason.text);
        return false;
    }
    return read_id(item, check_id, entry, error) && read_plan(item, map, entry, error) &&
           read_position(item, map, entry, error) && read_tm(item, entry, error);
}

/* ---- All entries together ------------------------------------------------------------------------------------ */

static int compare_ids(const void *left, const void *right)
{
    const map_entry *a = left, *b = right;
    return (a->id > b->id) - (a->id < b->id);
}

static int compare_names(const void *left, const void *right)
{
    const map_entry *a = left, *b = right;
    int order = strcmp(a->tm_name, b->tm_name);
    return order != 0 ? order : (a->number > b->number) - (a->number < b->number);
}

static int compare_groups(const void *left, const void *right)
{
    const map_entry *a = left, *b = right;
    return a->group != b->group ? (a->group > b->group) - (a->group < b->group)
                                : (a->number > b->number) - (a->number < b->number);
}

static int compare_magnitudes(const void *left, const void *right)
{
    int32_t a = ((const map_entry *)left)->id, b = ((const map_entry *)right)->id;
    a = a < 0 ? -a : a;
    b = b < 0 ? -b : b;
    return (a > b) - (a < b);
}

static bool check_repetition(map_entry *entries, size_t count, error_text *error)
{
    qsort(entries, count, sizeof *entries, compare_ids);
    for (size_t i = 1; i < count; i++) {
        const map_entry *a = &entries[i - 1], *b = &entries[i];
        if (a->id == b->id) {
            size_t first = a->number < b->number ? a->number : b->number;
            error_text_set(error, "entries %zu and %zu both have the id %d", first, a->number + b->number - first,
                           a->id);
            return false;
        }
    }
    return true;
}

/* Puts the entries of each TM together, in the order of the file, TMs by their first entries. */
static void group_entries(map_entry *entries, size_t count)
{
    qsort(entries, count, sizeof *entries, compare_names);
    for (size_t i = 0; i < count; i++) {
        bool same = i > 0 && entries[i].tm_name[0] != '\0' && strcmp(entries[i - 1].tm_name, entries[i].tm_name) == 0;
        entries[i].group = same ? entries[i - 1].group : entries[i].number;
    }
    qsort(entries, count, sizeof *entries, compare_groups);
}

/* Whether each CM, one after another, finds its 1 or 0 in what is left of the code. */
static bool signs_follow_code(const map_entry *entries, size_t count)
{
    const char *rest = entries[0].code;
    for (size_t i = 0; i < count; i++) {
        rest = strchr(rest, entries[i].id >= 0 ? '1' : '0');
        if (rest == NULL)
            return false;
        rest++;
    }
    return true;
}

/* A light CM has an id of zero or more and is a 1 of the code. Puts the CMs of a TM in the order in which it reads,
 * as far as that can be told: the order of the file, or else that of the ids without their signs. */
static bool check_tm(map_entry *entries, size_t count, error_text *error)
{
    const char *name = entries[0].tm_name, *code = entries[0].code;
    size_t length = strlen(code), ones = 0, light = 0;
    for (size_t i = 0; i < length; i++)
        ones += code[i] == '1';
    for (size_t i = 0; i < count; i++) {
        light += entries[i].id >= 0;
        if (strcmp(entries[i].code, code) != 0) {
            error_text_set(error, "tape marker %s has the code %s in entry %zu and %s in entry %zu", name, code,
                           entries[0].number, entries[i].code, entries[i].number);
            return false;
        }
    }
    if (light > ones || count - light > length - ones) {
        error_text_set(error, "tape marker %s has the code %s, but %zu light and %zu dark code markers (entry %zu)",
                       name, code, light, count - light, entries[0].number);
        return false;
    }
    if (signs_follow_code(entries, count))
        return true;
    size_t first_number = entries[0].number;
    qsort(entries, count, sizeof *entries, compare_magnitudes);
    if (signs_follow_code(entries, count))
        return true;
    error_text_set(error, "tape marker %s has the code %s, which the signs of its ids follow neither in the order of "
                   "the file nor in that of the ids (entry %zu)", name, code, first_number);
    return false;
}

static bool add_segment(map_entry *entries, size_t count, tape_map *map, error_text *error)
{
    map_segment *segment = &map->segments[map->segment_count];
    size_t length = strlen(entries[0].code);
    map_point sum = {0, 0};
    if (length > 0 && !check_tm(entries, count, error))
        return false;
    segment->first_cm = map->cm_count;
    segment->cm_count = count;
    segment->complete = length == 0 || count == length;
    memcpy(segment->code, entries[0].code, length + 1);
    for (size_t i = 0; i < count; i++) {
        map_point centre = entries[i].centre;
        map->cms[map->cm_count++] = (map_cm){entries[i].id, centre, centre, centre};
        sum.x_m += centre.x_m;
        sum.y_m += centre.y_m;
    }
    segment->start = segment->end = (map_point){sum.x_m / (double)count, sum.y_m / (double)count};
    map->segment_count++;
    return true;
}

static bool build_map(map_entry *entries, size_t count, tape_map *map, error_text *error)
{
    map->cms = calloc(count, sizeof *map->cms);
    map->segments = calloc(count, sizeof *map->segments);
    if (map->cms == NULL || map->segments == NULL) {
        error_text_set(error, "not enough memory for the map");
        return false;
    }
    if (!check_repetition(entries, count, error))
        return false;
    group_entries(entries, count);
    size_t begin = 0;
    while (begin < count) {
        size_t end = begin + 1;
        while (end < count && entries[end].group == entries[begin].group)
            end++;
        if (!add_segment(entries + begin, end - begin, map, error))
            return false;
        begin = end;
    }
    return true;
}

bool map_read_paper(const cJSON *root, map_id_check check_id, tape_map *map, error_text *error)
{
    const cJSON *item;
    size_t count = 0;
    if (cJSON_GetArraySize(root) == 0) {
        error_text_set(error, "is an array without code markers: no map");
        return false;
    }
    map_entry *entries = calloc((size_t)cJSON_GetArraySize(root), sizeof *entries);
    if (entries == NULL) {
        error_text_set(error, "not enough memory for the map");
        return false;
    }
    bool done = true;
    cJSON_ArrayForEach(item, root) {
        map_entry *entry = &entries[count++];
        entry->number = count;
        done = read_entry(item, check_id, map, entry, error);
        if (!done)
            break;
    }
    done = done && build_map(entries, count, map, error);
    free(entries);
    return done;
}
