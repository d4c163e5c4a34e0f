/* Writing maps: ours, as apps/map/README.md describes it, and those of the marker's inventors. */
#include "map_file.h"

#include "map_read.h"
#include "output_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PLACE_DECIMALS = 6, MODULE_DECIMALS = 6, DIRECTION_DECIMALS = 4 };

/* ---- Numbers ------------------------------------------------------------------------------------------------- */

/* Rounded to so many decimals, trailing zeros left out. printf would put the locale's decimal sign. */
static void write_decimal(FILE *file, double number, int decimals)
{
    int64_t scale = 1;
    for (int i = 0; i < decimals; i++)
        scale *= 10;
    int64_t scaled = llround(number * (double)scale);
    uint64_t magnitude = scaled < 0 ? 0 - (uint64_t)scaled : (uint64_t)scaled;
    uint64_t fraction = magnitude % (uint64_t)scale;
    while (decimals > 0 && fraction % 10 == 0) {
        fraction /= 10;
        decimals--;
    }
    fprintf(file, "%s%" PRIu64, scaled < 0 ? "-" : "", magnitude / (uint64_t)scale);
    if (decimals > 0)
        fprintf(file, ".%0*" PRIu64, decimals, fraction);
}

static void write_point(FILE *file, const char *key, map_point point)
{
    fprintf(file, "\"%s\": [", key);
    write_decimal(file, point.x_m, PLACE_DECIMALS);
    fputs(", ", file);
    write_decimal(file, point.y_m, PLACE_DECIMALS);
    fputs("]", file);
}

/* Whether the map tells where the ink begins and ends. */
static bool ends_known(map_point start, map_point end)
{
    return start.x_m != end.x_m || start.y_m != end.y_m;
}

static void write_ends(FILE *file, map_point start, map_point end)
{
    const double degrees_per_radian = 57.29577951308232, just_below_0 = -0.5e-4;
    double direction_deg = atan2(end.y_m - start.y_m, end.x_m - start.x_m) * degrees_per_radian;
    write_point(file, "start", start);
    fputs(", ", file);
    write_point(file, "end", end);
    fputs(", \"direction_deg\": ", file);
    write_decimal(file, direction_deg < just_below_0 ? direction_deg + 360 : fabs(direction_deg), DIRECTION_DECIMALS);
}

/* ---- What can be written ------------------------------------------------------------------------------------- */

static bool point_writable(map_point point)
{
    return fabs(point.x_m) <= MAP_COORDINATE_MAX_M && fabs(point.y_m) <= MAP_COORDINATE_MAX_M;
}

static bool check_writable(const tape_map *map, error_text *error)
{
    bool writable = map->segment_count > 0;
    for (size_t i = 0; writable && i < map->segment_count; i++) {
        const map_segment *segment = &map->segments[i];
        writable = segment->cm_count > 0 && segment->first_cm <= map->cm_count &&
                   segment->cm_count <= map->cm_count - segment->first_cm && point_writable(segment->start) &&
                   point_writable(segment->end) && isfinite(segment->above_floor_m);
    }
    for (size_t i = 0; writable && i < map->cm_count; i++)
        writable = point_writable(map->cms[i].centre) && point_writable(map->cms[i].start) &&
                   point_writable(map->cms[i].end);
    if (!writable)
        error_text_set(error, "the map is empty, or has places that are no places");
    return writable;
}

/* ---- Our format ---------------------------------------------------------------------------------------------- */

static void write_head(FILE *file, const tape_map *map)
{
    fprintf(file, "{\n  \"format\": \"%s\",\n  \"version\": %d,\n  \"units\": \"m\"", MAP_FORMAT_NAME,
            MAP_FORMAT_VERSION);
    if (map->width_m > 0) {
        fputs(",\n  \"plan\": {\"width_m\": ", file);
        write_decimal(file, map->width_m, PLACE_DECIMALS);
        fputs(", \"height_m\": ", file);
        write_decimal(file, map->height_m, PLACE_DECIMALS);
        fputs("}", file);
    }
    if (map->module_mm > 0) {
        fputs(",\n  \"module_mm\": ", file);
        write_decimal(file, map->module_mm, MODULE_DECIMALS);
    }
    fputs(",\n  \"segments\": [", file);
}

static void write_cm(FILE *file, const map_cm *cm, bool ends)
{
    fprintf(file, "      {\"id\": %" PRId32 ", ", cm->id);
    if (ends)
        write_ends(file, cm->start, cm->end);
    else
        write_point(file, "centre", cm->centre);
    fputs("}", file);
}

static void write_segment(FILE *file, const tape_map *map, const map_segment *segment)
{
    const map_cm *cms = map->cms + segment->first_cm;
    bool ends = ends_known(segment->start, segment->end);
    fputs("\n    {", file);
    if (segment->code[0] != '\0')
        fprintf(file, "\"code\": \"%s\", ", segment->code);
    if (!segment->complete)
        fputs("\"complete\": false, ", file);
    if (segment->mount != MAP_MOUNT_UNKNOWN)
        fprintf(file, "\"on\": \"%s\", ", segment->mount == MAP_ON_WALL ? "wall" : "floor");
    if (segment->above_floor_m != 0) {
        fputs("\"above_floor_m\": ", file);
        write_decimal(file, segment->above_floor_m, PLACE_DECIMALS);
        fputs(", ", file);
    }
    if (ends) {
        write_ends(file, segment->start, segment->end);
        fputs(", ", file);
    }
    fputs("\"cms\": [\n", file);
    for (size_t i = 0; i < segment->cm_count; i++) {
        write_cm(file, &cms[i], ends);
        fputs(i + 1 < segment->cm_count ? ",\n" : "]}", file);
    }
}

static void write_own(FILE *file, const tape_map *map)
{
    write_head(file, map);
    for (size_t i = 0; i < map->segment_count; i++) {
        write_segment(file, map, &map->segments[i]);
        fputs(i + 1 < map->segment_count ? "," : "\n  ]\n}\n", file);
    }
}

bool map_file_write(const char *path, const tape_map *map, error_text *error)
{
    if (!check_writable(map, error))
        return false;
    output_file *file = output_file_open(path, error);
    if (file == NULL)
        return false;
    write_own(output_file_stream(file), map);
    return output_file_publish(file, error);
}

/* ---- The format of the marker's inventors -------------------------------------------------------------------- */

static void write_key(FILE *file, const char *key, double number)
{
    fprintf(file, "\"%s\":", key);
    write_decimal(file, number, PLACE_DECIMALS);
    fputs(",", file);
}

/* All of a TM's entries have its first and its last CM. */
static void write_paper_segment(FILE *file, const tape_map *map, const map_segment *segment, size_t tm_number,
                                map_id_bits bits_of)
{
    const map_cm *cms = map->cms + segment->first_cm, *last = cms + segment->cm_count - 1;
    char word[79], checksum[9], name[24] = " ";
    if (segment->code[0] != '\0')
        snprintf(name, sizeof name, "%zu", tm_number);
    for (const map_cm *cm = cms; cm <= last; cm++) {
        bits_of(cm->id, word, checksum);
        fputs(cm == map->cms ? "{" : ",\n{", file);
        if (map->width_m > 0) {
            write_key(file, "largura", map->width_m);
            write_key(file, "altura", map->height_m);
        }
        write_key(file, "x1", cms->centre.x_m);
        write_key(file, "y1", cms->centre.y_m);
        write_key(file, "x2", last->centre.x_m);
        write_key(file, "y2", last->centre.y_m);
        fprintf(file,
                "\"idtm\":\"%s\",\"n_tm\":\"%s\",\"idcm\":\"%s\",\"idcm_decimal\":%" PRId32 ",\"checksum\":\"%s\",",
                segment->code[0] != '\0' ? segment->code : " ", name, word, cm->id, checksum);
        write_key(file, "x", cm->centre.x_m);
        fputs("\"y\":", file);
        write_decimal(file, cm->centre.y_m, PLACE_DECIMALS);
        fputs("}", file);
    }
}

bool map_file_write_paper(const char *path, const tape_map *map, map_id_bits bits_of, error_text *error)
{
    size_t tm_number = 0;
    if (!check_writable(map, error))
        return false;
    output_file *file = output_file_open(path, error);
    if (file == NULL)
        return false;
    FILE *stream = output_file_stream(file);
    fputs("[\n", stream);
    for (size_t i = 0; i < map->segment_count; i++) {
        tm_number += map->segments[i].code[0] != '\0';
        write_paper_segment(stream, map, &map->segments[i], tm_number, bits_of);
    }
    fputs("\n]\n", stream);
    return output_file_publish(file, error);
}
