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

bool places_load(const char *map_path, places *loaded, error_text *error)
{
    loaded->ids = NULL;
    if (!map_file_read(map_path, id_has, &loaded->map, error))
        return false;
    loaded->ids = malloc(loaded->map.cm_count * sizeof *loaded->ids);
    if (loaded->ids == NULL) {
        error_text_set(error, "not enough memory for the ids of the map");
        tape_map_release(&loaded->map);
        return false;
    }
    for (size_t i = 0; i < loaded->map.cm_count; i++)
        loaded->ids[i] = loaded->map.cms[i].id;
    return true;
}

void places_release(places *loaded)
{
    tape_map_release(&loaded->map);
    free(loaded->ids);
    loaded->ids = NULL;
}

void places_configure(const places *known, tapemark_config *config)
{
    config->known_ids = known->ids;
    config->known_id_count = known->map.cm_count;
}

bool places_find_cm(const places *known, int32_t id, plan_point *point)
{
    const map_cm *cm = known != NULL ? tape_map_find_cm(&known->map, id) : NULL;
    if (cm != NULL)
        *point = (plan_point){cm->x_m, cm->y_m};
    return cm != NULL;
}

/* The TM that all CMs read in this one belong to. False when no CM was read in it; *found is MAP_NO_TM when they
 * belong to none or to several. */
static bool find_by_cms(const tape_map *map, const tapemark_result *result, size_t tm_index, int32_t *found)
{
    bool any = false;
    for (size_t i = 0; i < result->cm_count; i++) {
        const map_cm *cm;
        if (result->cms[i].tm != (int16_t)tm_index || (cm = tape_map_find_cm(map, result->cms[i].id)) == NULL)
            continue;
        if (any && cm->tm != *found) {
            *found = MAP_NO_TM;
            return true;
        }
        *found = cm->tm;
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

static int32_t find_by_code(const tape_map *map, const tapemark_tm *tm)
{
    int32_t found = MAP_NO_TM;
    for (size_t i = 0; i < map->tm_count; i++) {
        if (!codes_match(map->tms[i].code, tm))
            continue;
        if (found != MAP_NO_TM)
            return MAP_NO_TM;
        found = (int32_t)i;
    }
    return found;
}

bool places_find_tm(const places *known, const tapemark_result *result, size_t tm_index, plan_point *point)
{
    int32_t found;
    if (known == NULL)
        return false;
    if (!find_by_cms(&known->map, result, tm_index, &found))
        found = find_by_code(&known->map, &result->tms[tm_index]);
    if (found == MAP_NO_TM || !known->map.tms[found].complete)
        return false;
    *point = (plan_point){known->map.tms[found].x_m, known->map.tms[found].y_m};
    return true;
}
