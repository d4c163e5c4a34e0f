#include "map_table.h"

#include "map_ids.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Places -------------------------------------------------------------------------------------------------- */

static void set_direction(map_point from, map_point to, float *dx, float *dy)
{
    double x_m = to.x_m - from.x_m, y_m = to.y_m - from.y_m, length_m = hypot(x_m, y_m);
    *dx = length_m > 0 ? (float)(x_m / length_m) : 0;
    *dy = length_m > 0 ? (float)(y_m / length_m) : 0;
}

static bool is_known(map_point from, map_point to)
{
    return from.x_m != to.x_m || from.y_m != to.y_m;
}

/* From where to where a segment reads; both the same where the map does not tell. */
static void find_extent(const tape_map *source, const map_segment *segment, map_point *from, map_point *to)
{
    const map_cm *cms = source->cms + segment->first_cm;
    bool by_cms = segment->complete && !is_known(segment->start, segment->end);
    *from = by_cms ? cms[0].centre : segment->start;
    *to = by_cms ? cms[segment->cm_count - 1].centre : segment->end;
}

/* ---- Filling the table --------------------------------------------------------------------------------------- */

/* What the entries are sorted by, and which CM or segment of the source they are. */
typedef struct tm_order {
    tapemark_map_tm tm;
    size_t segment;
} tm_order;

typedef struct cm_order {
    int32_t id;
    tapemark_map_cm cm;
} cm_order;

static int compare_tms(const void *left, const void *right)
{
    const tm_order *a = left, *b = right;
    if (a->tm.length != b->tm.length)
        return a->tm.length < b->tm.length ? -1 : 1;
    if (a->tm.code != b->tm.code)
        return a->tm.code < b->tm.code ? -1 : 1;
    return (a->segment > b->segment) - (a->segment < b->segment);
}

static int compare_cms(const void *left, const void *right)
{
    const cm_order *a = left, *b = right;
    return (a->id > b->id) - (a->id < b->id);
}

static tapemark_map_tm make_tm(const tape_map *source, const map_segment *segment)
{
    tapemark_map_tm tm = {.length = (uint8_t)strlen(segment->code)};
    map_point from, to;
    for (const char *bit = segment->code; *bit != '\0'; bit++)
        tm.code = tm.code << 1 | (*bit == '1' ? 1u : 0u);
    find_extent(source, segment, &from, &to);
    tm.placed = segment->complete || is_known(segment->start, segment->end);
    if (tm.placed) {
        tm.x_m = (float)((segment->start.x_m + segment->end.x_m) / 2);
        tm.y_m = (float)((segment->start.y_m + segment->end.y_m) / 2);
    }
    set_direction(from, to, &tm.dx, &tm.dy);
    return tm;
}

static void add_cms(const tape_map *source, const map_segment *segment, int32_t tm, cm_order *cms)
{
    map_point from, to;
    find_extent(source, segment, &from, &to);
    for (size_t i = 0; i < segment->cm_count; i++) {
        const map_cm *given = &source->cms[segment->first_cm + i];
        tapemark_map_cm cm = {.x_m = (float)given->centre.x_m, .y_m = (float)given->centre.y_m, .tm = tm, .slot = -1};
        if (tm >= 0 && segment->complete)
            cm.slot = (int16_t)i;
        set_direction(from, to, &cm.dx, &cm.dy);
        cms[segment->first_cm + i] = (cm_order){given->id, cm};
    }
}

static void fill(const tape_map *source, tm_order *tms, cm_order *cms, map_table *table)
{
    size_t tm_count = 0;
    for (size_t i = 0; i < source->segment_count; i++) {
        if (source->segments[i].code[0] != '\0')
            tms[tm_count++] = (tm_order){make_tm(source, &source->segments[i]), i};
        else
            add_cms(source, &source->segments[i], -1, cms);
    }
    qsort(tms, tm_count, sizeof *tms, compare_tms);
    for (size_t i = 0; i < tm_count; i++) {
        table->tms[i] = tms[i].tm;
        add_cms(source, &source->segments[tms[i].segment], (int32_t)i, cms);
    }
    qsort(cms, source->cm_count, sizeof *cms, compare_cms);
    for (size_t i = 0; i < source->cm_count; i++) {
        table->ids[i] = cms[i].id;
        table->cms[i] = cms[i].cm;
    }
    table->map = (tapemark_map){table->ids, table->cms, source->cm_count, table->tms, tm_count};
}

/* ---- Tables -------------------------------------------------------------------------------------------------- */

bool map_table_make(const tape_map *source, map_table *table, error_text *error)
{
    tm_order *tms = malloc((source->segment_count + 1) * sizeof *tms);
    cm_order *cms = malloc((source->cm_count + 1) * sizeof *cms);
    *table = (map_table){.ids = malloc((source->cm_count + 1) * sizeof *table->ids),
                         .cms = malloc((source->cm_count + 1) * sizeof *table->cms),
                         .tms = malloc((source->segment_count + 1) * sizeof *table->tms)};
    bool done = tms != NULL && cms != NULL && table->ids != NULL && table->cms != NULL && table->tms != NULL;
    if (done) {
        fill(source, tms, cms, table);
    } else {
        error_text_set(error, "not enough memory for the map");
        map_table_release(table);
    }
    free(tms);
    free(cms);
    return done;
}

bool map_table_load(const char *path, map_table *table, error_text *error)
{
    tape_map source;
    *table = (map_table){0};
    if (!map_file_read(path, map_ids_check, &source, error))
        return false;
    bool done = map_table_make(&source, table, error);
    tape_map_release(&source);
    return done;
}

void map_table_release(map_table *table)
{
    free(table->ids);
    free(table->cms);
    free(table->tms);
    *table = (map_table){0};
}

void map_table_configure(const map_table *table, tapemark_config *config)
{
    config->known_ids = table->map.ids;
    config->known_id_count = table->map.cm_count;
}
