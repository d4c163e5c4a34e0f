/* The library's look-up of places, over tables that hold anything: no memory outside of them may be touched, and
 * those that are found in order have to answer rightly. */
#include "byte_script.h"
#include "tapemark.h"

enum { CMS_MAX = 24, TMS_MAX = 12 };

typedef struct table_arrays {
    int32_t *ids;
    tapemark_map_cm *cms;
    tapemark_map_tm *tms;
} table_arrays;

/* Most are in order, so that those that are not are seen for themselves. */
static void read_cm(byte_script *script, size_t index, size_t tm_count, int32_t *id, tapemark_map_cm *cm)
{
    const uint8_t kind = script_byte(script);
    *id = (int32_t)index * 3 - 30;
    *cm = (tapemark_map_cm){.tm = -1, .slot = -1};
    if (kind % 4 == 1 && tm_count > 0) {
        cm->tm = script_byte(script) % (int32_t)tm_count;
        cm->slot = (int16_t)(script_byte(script) % 8 - 1);
    }
    if (kind % 16 == 2) {
        cm->tm = script_i32(script);
        cm->slot = (int16_t)script_u16(script);
    }
    if (kind % 16 == 3)
        *id = script_i32(script);
    if (kind >= 192) {
        cm->x_m = script_float(script);
        cm->y_m = script_float(script);
        cm->dx = script_float(script);
        cm->dy = script_float(script);
    }
}

static void read_tm(byte_script *script, size_t index, tapemark_map_tm *tm)
{
    const uint8_t kind = script_byte(script);
    *tm = (tapemark_map_tm){.code = index, .length = 6};
    if (kind % 4 == 1)
        tm->length = (uint8_t)(3 + script_byte(script) % 8);
    if (kind % 8 == 2) {
        tm->code = script_u32(script) | (uint64_t)script_u32(script) << 32;
        tm->length = script_byte(script);
    }
    if (kind >= 192) {
        tm->placed = true;
        tm->x_m = script_float(script);
        tm->y_m = script_float(script);
        tm->dx = script_float(script);
        tm->dy = script_float(script);
    }
}

static tapemark_map read_table(byte_script *script, table_arrays *arrays)
{
    tapemark_map map = {.cm_count = script_byte(script) % CMS_MAX, .tm_count = script_byte(script) % TMS_MAX};
    arrays->ids = exact_memory(map.cm_count * sizeof *arrays->ids);
    arrays->cms = exact_memory(map.cm_count * sizeof *arrays->cms);
    arrays->tms = exact_memory(map.tm_count * sizeof *arrays->tms);
    for (size_t i = 0; i < map.tm_count; i++)
        read_tm(script, i, &arrays->tms[i]);
    for (size_t i = 0; i < map.cm_count; i++)
        read_cm(script, i, map.tm_count, &arrays->ids[i], &arrays->cms[i]);
    const uint8_t missing = script_byte(script);
    map.ids = missing == 250 ? NULL : arrays->ids;
    map.cms = missing == 251 ? NULL : arrays->cms;
    map.tms = missing == 252 ? NULL : arrays->tms;
    return map;
}

static void read_code(byte_script *script, char *code, size_t most)
{
    const size_t length = script_byte(script) % (most + 1);
    for (size_t i = 0; i < length; i++)
        code[i] = "01\0x"[script_byte(script) % 64 < 62 ? script_byte(script) % 2 : script_byte(script) % 4];
    code[length] = '\0';
}

static void look_up(byte_script *script, const tapemark_map *map, bool in_order)
{
    size_t index = SIZE_MAX;
    char code[TAPEMARK_MAP_CODE_MAX + 9];
    const int32_t id = script_byte(script) % 4 == 0 ? script_i32(script) : script_within(script, -40, 40);
    tapemark_status status = tapemark_map_find_cm(map, id, &index);
    if (status == TAPEMARK_OK)
        CLAIM(index < map->cm_count && map->ids[index] == id);
    for (size_t i = 0; in_order && i < map->cm_count; i++)
        CLAIM(map->ids[i] != id || (status == TAPEMARK_OK && index == i));
    read_code(script, code, sizeof code - 1);
    index = SIZE_MAX;
    status = tapemark_map_find_tm(map, code, script_byte(script) % 2, &index);
    CLAIM(status == TAPEMARK_OK ? index < map->tm_count : index == SIZE_MAX);
}

static void locate(byte_script *script, const tapemark_map *map)
{
    enum { READ_MAX = 8 };
    tapemark_cm *cms = exact_memory(READ_MAX * sizeof *cms);
    tapemark_tm *tms = exact_memory(sizeof *tms);
    tapemark_result result = {.cms = cms, .cm_count = script_byte(script) % READ_MAX, .tms = tms, .tm_count = 1};
    tapemark_tm_place place = {TAPEMARK_AGREES, -1, false};
    read_code(script, tms->code, TAPEMARK_TM_MAX_CMS);
    tms->length = (uint8_t)strlen(tms->code);
    tms->directed = script_byte(script) % 2;
    tms->unknown_cms = (uint8_t)(script_byte(script) % 8 / 7);
    for (size_t i = 0; i < result.cm_count; i++)
        cms[i] = (tapemark_cm){.id = script_within(script, -31, 41), .tm = (int16_t)(script_byte(script) % 8 / 7),
                               .slot = (int16_t)(script_byte(script) % 16)};
    const tapemark_status status = tapemark_map_locate_tm(map, &result, script_byte(script) % 16 / 15, &place);
    if (status == TAPEMARK_OK)
        CLAIM(place.tm >= 0 && (size_t)place.tm < map->tm_count);
    free(cms);
    free(tms);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    byte_script script = {bytes, size};
    table_arrays arrays;
    const tapemark_map map = read_table(&script, &arrays);
    size_t bad = SIZE_MAX;
    const tapemark_status status = tapemark_map_check(&map, &bad);
    CLAIM(status == TAPEMARK_OK || status == TAPEMARK_BAD_CALL || status == TAPEMARK_BAD_MAP);
    if (status == TAPEMARK_BAD_MAP)
        CLAIM(bad < map.cm_count + map.tm_count);
    while (script.left > 0) {
        look_up(&script, &map, status == TAPEMARK_OK);
        locate(&script, &map);
    }
    free(arrays.ids);
    free(arrays.cms);
    free(arrays.tms);
    return 0;
}
