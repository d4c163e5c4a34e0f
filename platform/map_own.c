/* Our map format, version 1; apps/map/README.md describes it. */
#include "json_file.h"
#include "map_reading.h"

#include <stdlib.h>
#include <string.h>

/* ---- Segments -------------------------------------------------------------------------------------------------- */

/* The middle of the CMs stands for a segment whose ends are not known. */
static void place_by_cms(const tape_map *map, map_segment *segment)
{
    map_point middle = {0, 0};
    for (size_t i = 0; i < segment->cm_count; i++) {
        middle.x_m += map->cms[segment->first_cm + i].centre.x_m / (double)segment->cm_count;
        middle.y_m += map->cms[segment->first_cm + i].centre.y_m / (double)segment->cm_count;
    }
    segment->start = segment->end = middle;
}

static bool read_code(const map_reading *reading, const cJSON *item, map_segment *segment)
{
    const cJSON *complete = cJSON_GetObjectItemCaseSensitive(item, "complete");
    const char *code = json_get_text(item, "code");
    size_t length = code != NULL ? strlen(code) : 0;
    if (json_has(item, "code") && (length < MAP_CODE_MIN || length > MAP_CODE_MAX || strspn(code, "01") != length))
        return map_reading_refuse(reading, IN_SEGMENT, "\"code\" must be %d to %d characters 0 and 1", MAP_CODE_MIN,
                                  MAP_CODE_MAX);
    if (complete != NULL && !cJSON_IsBool(complete))
        return map_reading_refuse(reading, IN_SEGMENT, "\"complete\" must be true or false");
    if (length == 0 && cJSON_IsFalse(complete))
        return map_reading_refuse(reading, IN_SEGMENT, "has no \"code\", so it cannot be incomplete");
    memcpy(segment->code, code != NULL ? code : "", length + 1);
    segment->complete = complete == NULL || cJSON_IsTrue(complete);
    size_t wanted = length > 0 ? length : 1, count = segment->cm_count;
    if (segment->complete ? count == wanted : count > 0 && count < wanted)
        return true;
    if (!segment->complete)
        return map_reading_refuse(reading, IN_SEGMENT,
                                  "is not \"complete\", so \"cms\" needs 1 to %zu code markers, not %zu", wanted - 1,
                                  count);
    return map_reading_refuse(reading, IN_SEGMENT, "\"cms\" has %zu code markers, but %s%s has %zu", count,
                              length > 0 ? "the code " : "a segment without \"code\"", segment->code, wanted);
}

static bool read_mount(const map_reading *reading, const cJSON *item, map_segment *segment)
{
    const char *on = json_get_text(item, "on");
    if (!map_reading_number(reading, IN_SEGMENT, item, "above_floor_m", 0, 1000, &segment->above_floor_m))
        return false;
    if (!json_has(item, "on"))
        return true;
    if (on == NULL || (strcmp(on, "wall") != 0 && strcmp(on, "floor") != 0))
        return map_reading_refuse(reading, IN_SEGMENT, "\"on\" must be \"wall\" or \"floor\"");
    segment->mount = strcmp(on, "wall") == 0 ? MAP_ON_WALL : MAP_ON_FLOOR;
    return segment->mount == MAP_ON_WALL || segment->above_floor_m == 0 ||
           map_reading_refuse(reading, IN_SEGMENT, "is on the floor, so \"above_floor_m\" must be 0 or left out");
}

static bool read_segment(map_reading *reading, const cJSON *item)
{
    static const char *const keys[] = {"code", "complete", "on", "above_floor_m", "start", "end", "direction_deg",
                                       "cms", "comment", NULL};
    map_segment *segment = &reading->map->segments[reading->map->segment_count];
    const cJSON *cms = cJSON_GetObjectItemCaseSensitive(item, "cms");
    bool ends_given;
    if (!map_reading_check_keys(reading, IN_SEGMENT, item, keys))
        return false;
    if (!cJSON_IsArray(cms))
        return map_reading_refuse(reading, IN_SEGMENT, "\"cms\" must be an array of code markers");
    segment->first_cm = reading->map->cm_count;
    segment->cm_count = (size_t)cJSON_GetArraySize(cms);
    if (!read_code(reading, item, segment) || !read_mount(reading, item, segment) ||
        !map_reading_ends(reading, IN_SEGMENT, item, &segment->start, &segment->end, &ends_given) ||
        (ends_given && !map_reading_check_length(reading, segment)) ||
        !map_reading_cms(reading, cms, segment, ends_given))
        return false;
    if (!ends_given)
        place_by_cms(reading->map, segment);
    reading->map->segment_count++;
    return true;
}

/* ---- The map --------------------------------------------------------------------------------------------------- */

static bool read_head(const map_reading *reading, const cJSON *root)
{
    static const char *const keys[] = {"format", "version", "units", "plan", "module_mm", "segments", "comment",
                                       NULL};
    static const char *const plan_keys[] = {"width_m", "height_m", "comment", NULL};
    const cJSON *plan = cJSON_GetObjectItemCaseSensitive(root, "plan");
    const char *format = json_get_text(root, "format"), *units = json_get_text(root, "units");
    tape_map *map = reading->map;
    double version;
    error_text reason;
    if (format == NULL || strcmp(format, MAP_FORMAT_NAME) != 0)
        return map_reading_refuse(reading, IN_MAP, "is no map: \"format\" must be \"%s\"", MAP_FORMAT_NAME);
    if (!json_get_number(root, "version", &version) || version != MAP_FORMAT_VERSION)
        return map_reading_refuse(reading, IN_MAP, "\"version\" must be %d, the only one known here",
                                  MAP_FORMAT_VERSION);
    if (units == NULL || strcmp(units, "m") != 0)
        return map_reading_refuse(reading, IN_MAP, "\"units\" must be \"m\": places are in metres");
    if (!map_reading_check_keys(reading, IN_MAP, root, keys) ||
        !map_reading_number(reading, IN_MAP, root, "module_mm", 0.001, 10000, &map->module_mm))
        return false;
    if (plan == NULL)
        return true;
    if (!json_check_keys(plan, plan_keys, false, &reason))
        return map_reading_refuse(reading, IN_MAP, "plan: %s", reason.text);
    if (!json_get_number(plan, "width_m", &map->width_m) || !json_get_number(plan, "height_m", &map->height_m) ||
        !(map->width_m > 0 && map->width_m <= MAP_COORDINATE_MAX_M && map->height_m > 0 &&
          map->height_m <= MAP_COORDINATE_MAX_M))
        return map_reading_refuse(reading, IN_MAP, "plan: \"width_m\" and \"height_m\" must be above 0 and up to %g",
                                  MAP_COORDINATE_MAX_M);
    return true;
}

static size_t count_cms(const cJSON *segments)
{
    const cJSON *segment;
    size_t count = 0;
    cJSON_ArrayForEach(segment, segments) {
        count += (size_t)cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(segment, "cms"));
    }
    return count;
}

typedef struct cm_place {
    int32_t id;
    size_t segment, cm;
} cm_place;

static int compare_places(const void *left, const void *right)
{
    const cm_place *a = left, *b = right;
    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    if (a->segment != b->segment)
        return a->segment < b->segment ? -1 : 1;
    return (a->cm > b->cm) - (a->cm < b->cm);
}

static bool check_repetition(const map_reading *reading)
{
    const tape_map *map = reading->map;
    cm_place *places = malloc(map->cm_count * sizeof *places);
    size_t count = 0;
    if (places == NULL)
        return map_reading_refuse(reading, IN_MAP, "not enough memory for the map");
    for (size_t segment = 0; segment < map->segment_count; segment++)
        for (size_t cm = 0; cm < map->segments[segment].cm_count; cm++, count++)
            places[count] = (cm_place){map->cms[count].id, segment, cm};
    qsort(places, count, sizeof *places, compare_places);
    bool unique = true;
    for (size_t i = 1; unique && i < count; i++) {
        const cm_place *a = &places[i - 1], *b = &places[i];
        if (a->id == b->id)
            unique = map_reading_refuse(reading, IN_MAP,
                                        "segments[%zu].cms[%zu] and segments[%zu].cms[%zu] both have the id %d",
                                        a->segment, a->cm, b->segment, b->cm, a->id);
    }
    free(places);
    return unique;
}

bool map_read_own(const cJSON *root, map_id_check check_id, tape_map *map, error_text *error)
{
    map_reading reading = {check_id, map, 0, 0, error};
    const cJSON *segments = cJSON_GetObjectItemCaseSensitive(root, "segments"), *item;
    if (!read_head(&reading, root))
        return false;
    size_t segment_count = (size_t)cJSON_GetArraySize(segments), cm_count = count_cms(segments);
    if (!cJSON_IsArray(segments) || segment_count == 0)
        return map_reading_refuse(&reading, IN_MAP, "\"segments\" must be an array of one segment or more");
    map->segments = calloc(segment_count, sizeof *map->segments);
    map->cms = calloc(cm_count > 0 ? cm_count : 1, sizeof *map->cms);
    if (map->segments == NULL || map->cms == NULL)
        return map_reading_refuse(&reading, IN_MAP, "not enough memory for the map");
    cJSON_ArrayForEach(item, segments) {
        if (!read_segment(&reading, item))
            return false;
        reading.segment++;
    }
    return check_repetition(&reading);
}
