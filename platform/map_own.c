/* Our map format, version 1; apps/map/README.md describes it. */
#include "json_file.h"
#include "map_read.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TM_CMS_MIN = 3 };

/* What is being read, and where in the file. */
typedef struct map_reading {
    map_id_check check_id;
    tape_map *map;
    size_t segment;  /* index in the file */
    size_t cm;
    error_text *error;
} map_reading;

typedef enum reading_place { IN_MAP, IN_SEGMENT, IN_CM } reading_place;

__attribute__((format(printf, 3, 4)))
static bool refuse(const map_reading *reading, reading_place where, const char *format, ...)
{
    error_text reason;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason.text, sizeof reason.text, format, arguments);
    va_end(arguments);
    if (where == IN_MAP)
        *reading->error = reason;
    else if (where == IN_SEGMENT)
        error_text_set(reading->error, "segments[%zu]: %.300s", reading->segment, reason.text);
    else
        error_text_set(reading->error, "segments[%zu].cms[%zu]: %.300s", reading->segment, reading->cm, reason.text);
    return false;
}

/* ---- Members ------------------------------------------------------------------------------------------------- */

static bool check_keys(const map_reading *reading, reading_place where, const cJSON *item, const char *const *keys)
{
    error_text reason;
    return json_check_keys(item, keys, false, &reason) || refuse(reading, where, "%s", reason.text);
}

/* A number within bounds; `number` stays as it is where the key is missing. */
static bool read_optional_number(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                                 double least, double most, double *number)
{
    double value;
    if (!json_has(item, key))
        return true;
    if (!json_get_number(item, key, &value) || !(value >= least && value <= most))
        return refuse(reading, where, "\"%s\" must be a number from %g to %g", key, least, most);
    *number = value;
    return true;
}

static bool read_point(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                       map_point *point)
{
    const cJSON *pair = cJSON_GetObjectItemCaseSensitive(item, key);
    const cJSON *x = cJSON_GetArrayItem(pair, 0), *y = cJSON_GetArrayItem(pair, 1);
    const tape_map *map = reading->map;
    if (!cJSON_IsArray(pair) || !cJSON_IsNumber(x) || !cJSON_IsNumber(y) || y->next != NULL ||
        !(fabs(x->valuedouble) <= MAP_COORDINATE_MAX_M && fabs(y->valuedouble) <= MAP_COORDINATE_MAX_M))
        return refuse(reading, where, "\"%s\" must be a place on the plan in metres, [x, y]", key);
    *point = (map_point){x->valuedouble, y->valuedouble};
    return map_point_on_plan(map, *point) ||
           refuse(reading, where, "\"%s\", [%.3f, %.3f], lies outside of the plan, %.3f m x %.3f m", key, point->x_m,
                  point->y_m, map->width_m, map->height_m);
}

static double distance_m(map_point from, map_point to)
{
    return hypot(to.x_m - from.x_m, to.y_m - from.y_m);
}

/* Both ends, and a direction that goes from one to the other; or neither: false in *given. */
static bool read_ends(const map_reading *reading, reading_place where, const cJSON *item, map_point *start,
                      map_point *end, bool *given)
{
    const double tolerance_deg = 0.5, degrees_per_radian = 57.29577951308232;
    double direction_deg = NAN;
    bool has_start = json_has(item, "start"), has_end = json_has(item, "end");
    *given = has_start;
    if (has_start != has_end || (!has_start && json_has(item, "direction_deg")))
        return refuse(reading, where, "has \"%s\", but no \"%s\"",
                      has_start ? "start" : has_end ? "end" : "direction_deg", has_start ? "end" : "start");
    if (!*given)
        return true;
    if (!read_point(reading, where, item, "start", start) || !read_point(reading, where, item, "end", end) ||
        !read_optional_number(reading, where, item, "direction_deg", -360, 360, &direction_deg))
        return false;
    if (distance_m(*start, *end) < MAP_TOLERANCE_M)
        return refuse(reading, where, "\"start\" and \"end\" are the same place");
    double from_ends_deg = atan2(end->y_m - start->y_m, end->x_m - start->x_m) * degrees_per_radian;
    return isnan(direction_deg) || fabs(remainder(direction_deg - from_ends_deg, 360)) <= tolerance_deg ||
           refuse(reading, where, "\"direction_deg\" is %.2f, but from \"start\" to \"end\" it is %.2f", direction_deg,
                  from_ends_deg < 0 ? from_ends_deg + 360 : from_ends_deg);
}

/* ---- CMs ----------------------------------------------------------------------------------------------------- */

static bool read_id(const map_reading *reading, const cJSON *item, int32_t *id)
{
    double number;
    if (!json_get_number(item, "id", &number) || number != floor(number) || fabs(number) > INT32_MAX ||
        !reading->check_id((int32_t)number, NULL, NULL))
        return refuse(reading, IN_CM, "\"id\" must be the id of a code marker");
    *id = (int32_t)number;
    return true;
}

/* With its ends, which give its centre, or with its centre alone. */
static bool read_cm(const map_reading *reading, const cJSON *item, bool ends_wanted, map_cm *cm)
{
    static const char *const keys[] = {"id", "start", "end", "direction_deg", "centre", "comment", NULL};
    bool ends_given, centre_given = json_has(item, "centre");
    if (!check_keys(reading, IN_CM, item, keys) || !read_id(reading, item, &cm->id) ||
        !read_ends(reading, IN_CM, item, &cm->start, &cm->end, &ends_given))
        return false;
    if (ends_given == centre_given)
        return refuse(reading, IN_CM, "needs either \"start\" and \"end\" or \"centre\"");
    if (ends_given != ends_wanted)
        return refuse(reading, IN_CM, "must have \"start\" and \"end\" if and only if its segment has them");
    if (ends_given) {
        cm->centre = (map_point){(cm->start.x_m + cm->end.x_m) / 2, (cm->start.y_m + cm->end.y_m) / 2};
        return true;
    }
    if (!read_point(reading, IN_CM, item, "centre", &cm->centre))
        return false;
    cm->start = cm->end = cm->centre;
    return true;
}

/* A light CM has an id of zero or more and is a 1 of the code. Finds the slot of a CM, after that of the one before;
 * where some CMs are missing, the first that its sign allows. */
static bool find_slot(const map_reading *reading, const map_segment *segment, const map_cm *cm, size_t *slot)
{
    char bit = cm->id >= 0 ? '1' : '0';
    const char *found = segment->complete && segment->code[*slot] != bit ? NULL : strchr(segment->code + *slot, bit);
    if (found == NULL)
        return refuse(reading, IN_CM, "the id %d is %s, which does not fit the code %s here", cm->id,
                      cm->id >= 0 ? "light" : "dark", segment->code);
    *slot = (size_t)(found - segment->code);
    return true;
}

/* ---- Where the CMs of a segment stand along it --------------------------------------------------------------- */

enum { BAR_MODULES = 8, PITCH_MODULES = 25, CM_MODULES = 32 };

static double length_modules(const map_segment *segment)
{
    size_t length = strlen(segment->code);
    return length == 0 ? CM_MODULES : PITCH_MODULES * (double)length + 7 + 2 * BAR_MODULES;
}

static bool check_length(const map_reading *reading, const map_segment *segment)
{
    double given_m = distance_m(segment->start, segment->end);
    double wanted_m = length_modules(segment) * reading->map->module_mm / 1000;
    return wanted_m <= 0 || fabs(given_m - wanted_m) <= MAP_TOLERANCE_M ||
           refuse(reading, IN_SEGMENT, "is %.4f m long from \"start\" to \"end\", but its code markers take %.4f m at "
                  "%.4g mm a module", given_m, wanted_m, reading->map->module_mm);
}

static map_point point_along(const map_segment *segment, double share)
{
    return (map_point){segment->start.x_m + share * (segment->end.x_m - segment->start.x_m),
                       segment->start.y_m + share * (segment->end.y_m - segment->start.y_m)};
}

static bool check_point(const map_reading *reading, const char *key, map_point given, map_point wanted, size_t slot)
{
    double off_mm = distance_m(given, wanted) * 1000;
    return off_mm <= MAP_TOLERANCE_M * 1000 ||
           refuse(reading, IN_CM, "\"%s\", [%.4f, %.4f], is %.1f mm off: code marker %zu of this segment has it at "
                  "[%.4f, %.4f]", key, given.x_m, given.y_m, off_mm, slot, wanted.x_m, wanted.y_m);
}

/* Where CMs of a TM are missing, the place tells the slot. */
static bool check_place(const map_reading *reading, const map_segment *segment, const map_cm *cm, size_t *slot)
{
    bool is_tm = segment->code[0] != '\0';
    double all = length_modules(segment), before = is_tm ? BAR_MODULES : 0;
    if (!segment->complete) {
        double from_start_modules = distance_m(segment->start, cm->start) / distance_m(segment->start, segment->end) * all;
        double nearest = round((from_start_modules - before) / PITCH_MODULES);
        if (nearest < (double)*slot || nearest >= (double)strlen(segment->code))
            return refuse(reading, IN_CM, "lies outside of its tape marker or out of order");
        *slot = (size_t)nearest;
        if (!find_slot(reading, segment, cm, slot))
            return false;
    }
    double begin = before + PITCH_MODULES * (double)*slot;
    return check_point(reading, "start", cm->start, point_along(segment, begin / all), *slot) &&
           check_point(reading, "end", cm->end, point_along(segment, (begin + CM_MODULES) / all), *slot);
}

/* ---- Segments ------------------------------------------------------------------------------------------------ */

static bool read_cms(map_reading *reading, const cJSON *cms, map_segment *segment, bool ends_given)
{
    const cJSON *item;
    size_t slot = 0;
    reading->cm = 0;
    cJSON_ArrayForEach(item, cms) {
        map_cm *cm = &reading->map->cms[reading->map->cm_count];
        if (!read_cm(reading, item, ends_given, cm))
            return false;
        if (segment->code[0] != '\0' && !find_slot(reading, segment, cm, &slot))
            return false;
        if (ends_given && !check_place(reading, segment, cm, &slot))
            return false;
        reading->map->cm_count++;
        reading->cm++;
        slot++;
    }
    return true;
}

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
    if (json_has(item, "code") &&
        (length < TM_CMS_MIN || length > MAP_CODE_MAX || strspn(code, "01") != length))
        return refuse(reading, IN_SEGMENT, "\"code\" must be %d to %d characters 0 and 1", TM_CMS_MIN, MAP_CODE_MAX);
    if (complete != NULL && !cJSON_IsBool(complete))
        return refuse(reading, IN_SEGMENT, "\"complete\" must be true or false");
    memcpy(segment->code, code != NULL ? code : "", length + 1);
    segment->complete = complete == NULL || cJSON_IsTrue(complete);
    size_t wanted = length > 0 ? length : 1, count = segment->cm_count;
    if (segment->complete ? count == wanted : count > 0 && count < wanted)
        return true;
    if (!segment->complete && length > 0)
        return refuse(reading, IN_SEGMENT, "is not \"complete\", so \"cms\" needs 1 to %zu code markers, not %zu",
                      wanted - 1, count);
    return refuse(reading, IN_SEGMENT, "\"cms\" has %zu code markers, but %s%s has %zu", count,
                  length > 0 ? "the code " : "a segment without \"code\"", segment->code, wanted);
}

static bool read_mount(const map_reading *reading, const cJSON *item, map_segment *segment)
{
    const char *on = json_get_text(item, "on");
    if (!read_optional_number(reading, IN_SEGMENT, item, "above_floor_m", 0, 1000, &segment->above_floor_m))
        return false;
    if (!json_has(item, "on"))
        return true;
    if (on == NULL || (strcmp(on, "wall") != 0 && strcmp(on, "floor") != 0))
        return refuse(reading, IN_SEGMENT, "\"on\" must be \"wall\" or \"floor\"");
    segment->mount = strcmp(on, "wall") == 0 ? MAP_ON_WALL : MAP_ON_FLOOR;
    return segment->mount == MAP_ON_WALL || segment->above_floor_m == 0 ||
           refuse(reading, IN_SEGMENT, "is on the floor, so \"above_floor_m\" must be 0 or left out");
}

static bool read_segment(map_reading *reading, const cJSON *item)
{
    static const char *const keys[] = {"code", "complete", "on", "above_floor_m", "start", "end", "direction_deg", "cms",
                                       "comment", NULL};
    map_segment *segment = &reading->map->segments[reading->map->segment_count];
    const cJSON *cms = cJSON_GetObjectItemCaseSensitive(item, "cms");
    bool ends_given;
    if (!check_keys(reading, IN_SEGMENT, item, keys))
        return false;
    if (!cJSON_IsArray(cms))
        return refuse(reading, IN_SEGMENT, "\"cms\" must be an array of code markers");
    segment->first_cm = reading->map->cm_count;
    segment->cm_count = (size_t)cJSON_GetArraySize(cms);
    if (!read_code(reading, item, segment) || !read_mount(reading, item, segment) ||
        !read_ends(reading, IN_SEGMENT, item, &segment->start, &segment->end, &ends_given) ||
        (ends_given && !check_length(reading, segment)) || !read_cms(reading, cms, segment, ends_given))
        return false;
    if (!ends_given)
        place_by_cms(reading->map, segment);
    reading->map->segment_count++;
    return true;
}

/* ---- The map ------------------------------------------------------------------------------------------------- */

static bool read_head(const map_reading *reading, const cJSON *root)
{
    static const char *const keys[] = {"format", "version", "units", "plan", "module_mm", "segments", "comment", NULL};
    static const char *const plan_keys[] = {"width_m", "height_m", "comment", NULL};
    const cJSON *plan = cJSON_GetObjectItemCaseSensitive(root, "plan");
    const char *format = json_get_text(root, "format"), *units = json_get_text(root, "units");
    tape_map *map = reading->map;
    double version;
    error_text reason;
    if (format == NULL || strcmp(format, MAP_FORMAT_NAME) != 0)
        return refuse(reading, IN_MAP, "is no map: \"format\" must be \"%s\"", MAP_FORMAT_NAME);
    if (!json_get_number(root, "version", &version) || version != MAP_FORMAT_VERSION)
        return refuse(reading, IN_MAP, "\"version\" must be %d, the only one known here", MAP_FORMAT_VERSION);
    if (units == NULL || strcmp(units, "m") != 0)
        return refuse(reading, IN_MAP, "\"units\" must be \"m\": places are in metres");
    if (!check_keys(reading, IN_MAP, root, keys) ||
        !read_optional_number(reading, IN_MAP, root, "module_mm", 0.001, 10000, &map->module_mm))
        return false;
    if (plan == NULL)
        return true;
    if (!json_check_keys(plan, plan_keys, false, &reason))
        return refuse(reading, IN_MAP, "plan: %s", reason.text);
    if (!json_get_number(plan, "width_m", &map->width_m) || !json_get_number(plan, "height_m", &map->height_m) ||
        !(map->width_m > 0 && map->width_m <= MAP_COORDINATE_MAX_M && map->height_m > 0 &&
          map->height_m <= MAP_COORDINATE_MAX_M))
        return refuse(reading, IN_MAP, "plan: \"width_m\" and \"height_m\" must be above 0 and up to %g",
                      MAP_COORDINATE_MAX_M);
    return true;
}

static size_t count_cms(const cJSON *segments)
{
    const cJSON *segment;
    size_t count = 0;
    cJSON_ArrayForEach(segment, segments)
        count += (size_t)cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(segment, "cms"));
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
        return refuse(reading, IN_MAP, "not enough memory for the map");
    for (size_t segment = 0; segment < map->segment_count; segment++)
        for (size_t cm = 0; cm < map->segments[segment].cm_count; cm++, count++)
            places[count] = (cm_place){map->cms[count].id, segment, cm};
    qsort(places, count, sizeof *places, compare_places);
    bool unique = true;
    for (size_t i = 1; unique && i < count; i++) {
        const cm_place *a = &places[i - 1], *b = &places[i];
        unique = a->id != b->id || refuse(reading, IN_MAP, "segments[%zu].cms[%zu] and segments[%zu].cms[%zu] both have "
                                          "the id %d", a->segment, a->cm, b->segment, b->cm, a->id);
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
        return refuse(&reading, IN_MAP, "\"segments\" must be an array of one segment or more");
    map->segments = calloc(segment_count, sizeof *map->segments);
    map->cms = calloc(cm_count > 0 ? cm_count : 1, sizeof *map->cms);
    if (map->segments == NULL || map->cms == NULL)
        return refuse(&reading, IN_MAP, "not enough memory for the map");
    cJSON_ArrayForEach(item, segments) {
        if (!read_segment(&reading, item))
            return false;
        reading.segment++;
    }
    return check_repetition(&reading);
}
