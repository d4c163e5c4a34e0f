#include "places.h"

#include <stdlib.h>
#include <string.h>

static bool id_has(int32_t id, const char *word_text, const char *checksum_text)
{
    tapemark_word word;
    char word_bits[TAPEMARK_DATA_BITS + 1] = "", checksum_bits[8 + 1] = "";
    if (tapemark_word_from_id(id, &word) != TAPEMARK_OK)
        return false;
    unsigned checksum = tapemark_word_checksum(&word);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        word_bits[i] = tapemark_word_bit(&word, i) ? '1' : '0';
    for (unsigned i = 0; i < 8; i++)
        checksum_bits[i] = checksum >> (7 - i) & 1 ? '1' : '0';
    return (word_text == NULL || strcmp(word_text, word_bits) == 0) &&
           (checksum_text == NULL || strcmp(checksum_text, checksum_bits) == 0);
}

static int compare_entries(const void *left, const void *right)
{
    int32_t a = ((const place_entry *)left)->id, b = ((const place_entry *)right)->id;
    return (a > b) - (a < b);
}

bool places_load(const char *map_path, places *loaded, error_text *error)
{
    *loaded = (places){0};
    if (!map_file_read(map_path, id_has, &loaded->map, error))
        return false;
    const tape_map *map = &loaded->map;
    loaded->entries = malloc(map->cm_count * sizeof *loaded->entries);
    loaded->ids = malloc(map->cm_count * sizeof *loaded->ids);
    if (loaded->entries == NULL || loaded->ids == NULL) {
        error_text_set(error, "not enough memory for the ids of the map");
        places_release(loaded);
        return false;
    }
    for (size_t segment = 0; segment < map->segment_count; segment++) {
        size_t first = map->segments[segment].first_cm;
        for (size_t i = first; i < first + map->segments[segment].cm_count; i++)
            loaded->entries[i] = (place_entry){map->cms[i].id, i, segment};
    }
    qsort(loaded->entries, map->cm_count, sizeof *loaded->entries, compare_entries);
    for (size_t i = 0; i < map->cm_count; i++)
        loaded->ids[i] = loaded->entries[i].id;
    return true;
}

void places_release(places *loaded)
{
    tape_map_release(&loaded->map);
    free(loaded->entries);
    free(loaded->ids);
    *loaded = (places){0};
}

void places_configure(const places *known, tapemark_config *config)
{
    config->known_ids = known->ids;
    config->known_id_count = known->map.cm_count;
}

static const place_entry *find_entry(const places *known, int32_t id)
{
    place_entry wanted = {.id = id};
    return bsearch(&wanted, known->entries, known->map.cm_count, sizeof wanted, compare_entries);
}

bool places_find_cm(const places *known, int32_t id, map_point *point)
{
    const place_entry *entry = known != NULL ? find_entry(known, id) : NULL;
    if (entry != NULL)
        *point = known->map.cms[entry->cm].centre;
    return entry != NULL;
}

static bool is_tm(const tape_map *map, size_t segment)
{
    return map->segments[segment].code[0] != '\0';
}

/* The TM that all CMs read in this one belong to. False when no CM was read in it; *found is the number of segments
 * when they belong to none or to several. */
static bool find_by_cms(const places *known, const tapemark_result *result, size_t tm_index, size_t *found)
{
    bool any = false;
    for (size_t i = 0; i < result->cm_count; i++) {
        const place_entry *entry;
        if (result->cms[i].tm != (int16_t)tm_index || (entry = find_entry(known, result->cms[i].id)) == NULL)
            continue;
        if (!is_tm(&known->map, entry->segment) || (any && entry->segment != *found)) {
            *found = known->map.segment_count;
            return true;
        }
        *found = entry->segment;
        any = true;
    }
    return any;
}

static bool codes_match(const char *mapped, const tapemark_tm *tm)
{
    size_t length = tm->length;
    if (strcmp(mapped, tm->code) == 0)
        return true;
    if (tm->directed || strlen(mapped) != length)
        return false;
    for (size_t i = 0; i < length; i++)
        if (mapped[i] != tm->code[length - 1 - i])
            return false;
    return true;
}

static size_t find_by_code(const tape_map *map, const tapemark_tm *tm)
{
    size_t found = map->segment_count;
    for (size_t i = 0; i < map->segment_count; i++) {
        if (!codes_match(map->segments[i].code, tm))
            continue;
        if (found != map->segment_count)
            return map->segment_count;
        found = i;
    }
    return found;
}

bool places_find_tm(const places *known, const tapemark_result *result, size_t tm_index, map_point *point)
{
    size_t found;
    if (known == NULL)
        return false;
    if (!find_by_cms(known, result, tm_index, &found))
        found = find_by_code(&known->map, &result->tms[tm_index]);
    if (found == known->map.segment_count || !known->map.segments[found].complete)
        return false;
    const map_segment *segment = &known->map.segments[found];
    *point = (map_point){(segment->start.x_m + segment->end.x_m) / 2, (segment->start.y_m + segment->end.y_m) / 2};
    return true;
}
