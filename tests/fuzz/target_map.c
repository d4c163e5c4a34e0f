/* Map files, ours and the inventors', as the programs read them: the file, the library's table, places, and the same
 * map written and read again. */
#include <math.h>
#include <string.h>

#include "content_file.h"
#include "map_ids.h"
#include "map_table.h"
#include "tapemark.h"

static void claim_cm_found(const tapemark_map *table, const map_cm *cm)
{
    size_t index = table->cm_count;
    CLAIM(tapemark_map_find_cm(table, cm->id, &index) == TAPEMARK_OK);
    CLAIM(table->ids[index] == cm->id);
    CLAIM(fabs((double)table->cms[index].x_m - cm->centre.x_m) <= 1e-6 * fabs(cm->centre.x_m) + 1e-6);
}

/* A TM of the map, read with all of its CMs. */
static void claim_tm_located(const tapemark_map *table, const tape_map *map, const map_segment *segment)
{
    tapemark_cm cms[TAPEMARK_TM_MAX_CMS] = {{0}};
    tapemark_tm tm = {.length = (uint8_t)segment->cm_count, .directed = true};
    tapemark_result result = {.cms = cms, .cm_count = segment->cm_count, .tms = &tm, .tm_count = 1};
    tapemark_tm_place place;
    if (segment->code[0] == '\0' || !segment->complete || segment->cm_count > TAPEMARK_TM_MAX_CMS)
        return;
    memcpy(tm.code, segment->code, segment->cm_count);
    for (size_t i = 0; i < segment->cm_count; i++) {
        cms[i].id = map->cms[segment->first_cm + i].id;
        cms[i].slot = (int16_t)i;
    }
    CLAIM(tapemark_map_locate_tm(table, &result, 0, &place) == TAPEMARK_OK);
    CLAIM(place.agreement == TAPEMARK_AGREES && place.tm >= 0 && (size_t)place.tm < table->tm_count);
}

static void claim_table(const tape_map *map)
{
    error_text error;
    map_table table = {0};
    size_t index = 0;
    CLAIM(map_table_make(map, &table, &error));
    CLAIM(tapemark_map_check(&table.map, &index) == TAPEMARK_OK);
    CLAIM(table.map.cm_count == map->cm_count && table.map.cm_count > 0);
    for (size_t i = 0; i < map->cm_count; i++)
        claim_cm_found(&table.map, &map->cms[i]);
    for (size_t i = 0; i < map->segment_count; i++)
        claim_tm_located(&table.map, map, &map->segments[i]);
    map_table_release(&table);
}

static void claim_same(const tape_map *map, const tape_map *again)
{
    CLAIM(again->cm_count == map->cm_count && again->segment_count == map->segment_count);
    for (size_t i = 0; i < map->cm_count; i++)
        CLAIM(again->cms[i].id == map->cms[i].id &&
              fabs(again->cms[i].centre.x_m - map->cms[i].centre.x_m) <= 2e-6 + 1e-9 * fabs(map->cms[i].centre.x_m));
    for (size_t i = 0; i < map->segment_count; i++)
        CLAIM(strcmp(again->segments[i].code, map->segments[i].code) == 0 &&
              again->segments[i].cm_count == map->segments[i].cm_count &&
              again->segments[i].mount == map->segments[i].mount);
}

static void claim_written_alike(const tape_map *map)
{
    char path[CONTENT_PATH_BYTES];
    error_text error = {""};
    tape_map again;
    named_file_path("map.json", path);
    CLAIM(map_file_write(path, map, &error));
    if (!map_file_read(path, map_ids_check, &again, &error)) {
        fprintf(stderr, "%s\n", error.text);
        abort();
    }
    claim_same(map, &again);
    tape_map_release(&again);
    CLAIM(map_file_write_paper(path, map, map_ids_bits, &error));
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const content_file file = content_file_open(bytes, size);
    error_text error = {""};
    tape_map map;
    if (map_file_read(file.path, map_ids_check, &map, &error)) {
        claim_table(&map);
        claim_written_alike(&map);
        tape_map_release(&map);
    } else {
        CLAIM(error.text[0] != '\0');
    }
    content_file_close(&file);
    return 0;
}
