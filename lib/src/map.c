#include "tapemark.h"

#include <float.h>

/* ---- Codes as numbers ---------------------------------------------------------------------------------- */

typedef struct code_bits {
    uint64_t bits;
    unsigned length;
} code_bits;

/* False for what is no code of a TM. */
static bool parse_code(const char *text, code_bits *code)
{
    *code = (code_bits){0, 0};
    for (; *text != '\0'; text++) {
        if ((*text != '0' && *text != '1') || code->length == TAPEMARK_MAP_CODE_MAX)
            return false;
        code->bits = code->bits << 1 | (unsigned)(*text - '0');
        code->length++;
    }
    return code->length >= TAPEMARK_TM_MIN_CMS;
}

static code_bits reversed(code_bits code)
{
    code_bits result = {0, code.length};
    for (unsigned i = 0; i < code.length; i++)
        result.bits = result.bits << 1 | (code.bits >> i & 1);
    return result;
}

/* -1, 0 or 1: how a TM of the map stands to a code in the order of the table. */
static int compare_code(const tapemark_map_tm *tm, code_bits code)
{
    if (tm->length != code.length)
        return tm->length < code.length ? -1 : 1;
    return (tm->code > code.bits) - (tm->code < code.bits);
}

/* ---- The table ----------------------------------------------------------------------------------------- */

static bool table_given(const tapemark_map *map)
{
    return map != NULL && (map->cm_count == 0 || (map->ids != NULL && map->cms != NULL)) &&
           (map->tm_count == 0 || map->tms != NULL);
}

static bool is_finite(float value)
{
    return value >= -FLT_MAX && value <= FLT_MAX;
}

static bool is_direction(float dx, float dy)
{
    float square = dx * dx + dy * dy;
    return (dx == 0 && dy == 0) || (square > 0.98f && square < 1.02f);
}

static bool tm_in_order(const tapemark_map *map, size_t index)
{
    const tapemark_map_tm *tm = &map->tms[index];
    code_bits code = {tm->code, tm->length};
    return tm->length >= TAPEMARK_TM_MIN_CMS && tm->length <= TAPEMARK_MAP_CODE_MAX &&
           (tm->length == 64 || tm->code >> tm->length == 0) && is_direction(tm->dx, tm->dy) &&
           (!tm->placed || (is_finite(tm->x_m) && is_finite(tm->y_m))) &&
           (index == 0 || compare_code(&map->tms[index - 1], code) <= 0);
}

/* A light CM, with an id of zero or more, is a 1 of its TM's code. */
static bool slot_fits(const tapemark_map_tm *tm, int16_t slot, int32_t id)
{
    if (slot == -1)
        return true;
    if (slot < -1 || slot >= tm->length)
        return false;
    bool light = (tm->code >> (tm->length - 1 - slot) & 1) != 0;
    return id >= 0 ? light : !light;
}

static bool cm_in_order(const tapemark_map *map, size_t index)
{
    const tapemark_map_cm *cm = &map->cms[index];
    int32_t id = map->ids[index];
    if (id < -TAPEMARK_MAX_ID || id > TAPEMARK_MAX_ID || (index > 0 && map->ids[index - 1] >= id))
        return false;
    if (!is_finite(cm->x_m) || !is_finite(cm->y_m) || !is_direction(cm->dx, cm->dy))
        return false;
    if (cm->tm < 0)
        return cm->tm == -1 && cm->slot == -1;
    return (size_t)cm->tm < map->tm_count && slot_fits(&map->tms[cm->tm], cm->slot, id);
}

tapemark_status tapemark_map_check(const tapemark_map *map, size_t *index)
{
    if (!table_given(map))
        return TAPEMARK_BAD_CALL;
    size_t bad = 0, all = map->cm_count + map->tm_count;
    while (bad < map->tm_count && tm_in_order(map, bad))
        bad++;
    bool tms_good = bad == map->tm_count;
    if (tms_good) {
        bad = 0;
        while (bad < map->cm_count && cm_in_order(map, bad))
            bad++;
        if (bad == map->cm_count)
            bad = all;
    } else {
        bad += map->cm_count;
    }
    if (bad != all && index != NULL)
        *index = bad;
    return bad == all ? TAPEMARK_OK : TAPEMARK_BAD_MAP;
}

/* ---- Looking up ---------------------------------------------------------------------------------------- */

tapemark_status tapemark_map_find_cm(const tapemark_map *map, int32_t id, size_t *index)
{
    if (!table_given(map) || index == NULL)
        return TAPEMARK_BAD_CALL;
    /* Of `count` ids from `first` on, none before it is greater than the one looked for. */
    size_t first = 0, count = map->cm_count;
    while (count > 1) {
        size_t half = count / 2;
        first = map->ids[first + half] <= id ? first + half : first;
        count -= half;
    }
    if (count == 0 || map->ids[first] != id)
        return TAPEMARK_NOTHING_FOUND;
    *index = first;
    return TAPEMARK_OK;
}

/* How many TMs have a code: 0, 1 or 2, which stands for more, too; `index` is that of the first of them. */
static unsigned count_tms(const tapemark_map *map, code_bits code, size_t *index)
{
    /* All before `first` come before the code; of `left` from there on, it is not known. */
    size_t first = 0, left = map->tm_count;
    while (left > 0) {
        size_t half = left / 2;
        const tapemark_map_tm *middle = &map->tms[first + half];
        bool before = (middle->length < code.length) | ((middle->length == code.length) & (middle->code < code.bits));
        first = before ? first + half + 1 : first;
        left = before ? left - half - 1 : half;
    }
    unsigned count = 0;
    while (count < 2 && first + count < map->tm_count && compare_code(&map->tms[first + count], code) == 0)
        count++;
    if (count > 0)
        *index = first;
    return count;
}

static tapemark_status find_code(const tapemark_map *map, code_bits code, bool directed, size_t *index,
                                 bool *backwards)
{
    size_t forward = 0, backward = 0;
    unsigned count = count_tms(map, code, &forward);
    *backwards = count == 0;
    if (!directed && reversed(code).bits != code.bits)
        count += count_tms(map, reversed(code), &backward);
    if (count != 1)
        return count == 0 ? TAPEMARK_NOTHING_FOUND : TAPEMARK_AMBIGUOUS;
    *index = *backwards ? backward : forward;
    return TAPEMARK_OK;
}

tapemark_status tapemark_map_find_tm(const tapemark_map *map, const char *code, bool directed, size_t *index)
{
    code_bits bits;
    bool backwards;
    if (!table_given(map) || code == NULL || index == NULL || !parse_code(code, &bits))
        return TAPEMARK_BAD_CALL;
    return find_code(map, bits, directed, index, &backwards);
}

/* ---- A TM and its CMs ---------------------------------------------------------------------------------- */

static bool belongs(const tapemark_cm *cm, size_t tm_index)
{
    return cm->tm >= 0 && (size_t)cm->tm == tm_index;
}

/* The TM of the map that all CMs read in this one belong to: TAPEMARK_AGREES; TAPEMARK_CODE_ALONE when none could be
 * read. Codes are few, and each plan has the same ones: where CMs of other ids stand in it, the code says nothing. */
static tapemark_agreement tm_of_cms(const tapemark_map *map, const tapemark_result *result, size_t tm_index,
                                    int32_t *tm)
{
    *tm = -1;
    if (result->tms[tm_index].unknown_cms > 0)
        return TAPEMARK_CM_UNKNOWN;
    for (size_t i = 0; i < result->cm_count; i++) {
        size_t index;
        if (!belongs(&result->cms[i], tm_index))
            continue;
        if (tapemark_map_find_cm(map, result->cms[i].id, &index) != TAPEMARK_OK)
            return TAPEMARK_CM_UNKNOWN;
        int32_t own = map->cms[index].tm;
        if (own < 0 || (size_t)own >= map->tm_count)
            return TAPEMARK_CM_WITHOUT_TM;
        if (*tm >= 0 && *tm != own)
            return TAPEMARK_CMS_OF_SEVERAL_TMS;
        *tm = own;
    }
    return *tm >= 0 ? TAPEMARK_AGREES : TAPEMARK_CODE_ALONE;
}

/* Whether the CMs, all of which are on the map, stand where it has them, seen one way or the other. */
static bool slots_fit(const tapemark_map *map, const tapemark_result *result, size_t tm_index, bool backwards)
{
    int length = result->tms[tm_index].length;
    for (size_t i = 0; i < result->cm_count; i++) {
        const tapemark_cm *cm = &result->cms[i];
        size_t index;
        if (!belongs(cm, tm_index) || tapemark_map_find_cm(map, cm->id, &index) != TAPEMARK_OK)
            continue;
        int slot = backwards ? length - 1 - cm->slot : cm->slot;
        if (map->cms[index].slot >= 0 && map->cms[index].slot != slot)
            return false;
    }
    return true;
}

static tapemark_agreement compare_with_tm(const tapemark_map *map, const tapemark_result *result, size_t tm_index,
                                          code_bits code, tapemark_tm_place *place)
{
    const tapemark_map_tm *mapped = &map->tms[place->tm];
    bool same = compare_code(mapped, code) == 0, turned = compare_code(mapped, reversed(code)) == 0;
    if (same && slots_fit(map, result, tm_index, false))
        return TAPEMARK_AGREES;
    if (turned && slots_fit(map, result, tm_index, true)) {
        place->backwards = !result->tms[tm_index].directed;
        return place->backwards ? TAPEMARK_AGREES : TAPEMARK_RUNS_BACKWARDS;
    }
    return same || turned ? TAPEMARK_CM_IN_OTHER_SLOT : TAPEMARK_CODE_OF_OTHER_TM;
}

static tapemark_status locate_by_code(const tapemark_map *map, code_bits code, bool directed,
                                      tapemark_tm_place *place)
{
    size_t index;
    bool backwards;
    tapemark_status status = find_code(map, code, directed, &index, &backwards);
    if (status == TAPEMARK_OK) {
        place->tm = (int32_t)index;
        place->backwards = backwards;
        place->agreement = TAPEMARK_CODE_ALONE;
    } else {
        place->agreement = status == TAPEMARK_AMBIGUOUS ? TAPEMARK_CODE_AMBIGUOUS : TAPEMARK_CODE_UNKNOWN;
    }
    return status;
}

tapemark_status tapemark_map_locate_tm(const tapemark_map *map, const tapemark_result *result, size_t tm_index,
                                       tapemark_tm_place *place)
{
    code_bits code;
    if (!table_given(map) || result == NULL || place == NULL || result->tms == NULL ||
        tm_index >= result->tm_count || (result->cm_count > 0 && result->cms == NULL) ||
        !parse_code(result->tms[tm_index].code, &code))
        return TAPEMARK_BAD_CALL;
    *place = (tapemark_tm_place){.tm = -1};
    place->agreement = tm_of_cms(map, result, tm_index, &place->tm);
    if (place->agreement == TAPEMARK_CODE_ALONE)
        return locate_by_code(map, code, result->tms[tm_index].directed, place);
    if (place->agreement == TAPEMARK_AGREES)
        place->agreement = compare_with_tm(map, result, tm_index, code, place);
    if (place->agreement == TAPEMARK_AGREES)
        return TAPEMARK_OK;
    place->tm = -1;
    return TAPEMARK_NOTHING_FOUND;
}
