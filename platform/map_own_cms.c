/* The CMs of a segment in our own map format, and whether they stand where it has them. */
#include "json_file.h"
#include "map_reading.h"

#include <math.h>
#include <string.h>

/* ---- CMs ------------------------------------------------------------------------------------------------------- */

static bool read_id(const map_reading *reading, const cJSON *item, int32_t *id)
{
    double number;
    if (!json_get_number(item, "id", &number) || number != floor(number) || fabs(number) > INT32_MAX ||
        !reading->check_id((int32_t)number, NULL, NULL))
        return map_reading_refuse(reading, IN_CM, "\"id\" must be the id of a code marker");
    *id = (int32_t)number;
    return true;
}

/* With its ends, which give its centre, or with its centre alone. */
static bool read_cm(const map_reading *reading, const cJSON *item, bool ends_wanted, map_cm *cm)
{
    static const char *const keys[] = {"id", "start", "end", "direction_deg", "centre", "comment", NULL};
    bool ends_given, centre_given = json_has(item, "centre");
    if (!map_reading_check_keys(reading, IN_CM, item, keys) || !read_id(reading, item, &cm->id) ||
        !map_reading_ends(reading, IN_CM, item, &cm->start, &cm->end, &ends_given))
        return false;
    if (ends_given == centre_given)
        return map_reading_refuse(reading, IN_CM, "needs either \"start\" and \"end\" or \"centre\"");
    if (ends_given != ends_wanted)
        return map_reading_refuse(reading, IN_CM,
                                  "must have \"start\" and \"end\" if and only if its segment has them");
    if (ends_given) {
        cm->centre = (map_point){(cm->start.x_m + cm->end.x_m) / 2, (cm->start.y_m + cm->end.y_m) / 2};
        return true;
    }
    if (!map_reading_point(reading, IN_CM, item, "centre", &cm->centre))
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
        return map_reading_refuse(reading, IN_CM, "the id %d is %s, which does not fit the code %s here", cm->id,
                                  cm->id >= 0 ? "light" : "dark", segment->code);
    *slot = (size_t)(found - segment->code);
    return true;
}

/* ---- Where the CMs of a segment stand along it ----------------------------------------------------------------- */

enum { BAR_MODULES = 8, PITCH_MODULES = 25, CM_MODULES = 32 };

static double length_modules(const map_segment *segment)
{
    size_t length = strlen(segment->code);
    return length == 0 ? CM_MODULES : PITCH_MODULES * (double)length + 7 + 2 * BAR_MODULES;
}

bool map_reading_check_length(const map_reading *reading, const map_segment *segment)
{
    double given_m = map_distance_m(segment->start, segment->end);
    double wanted_m = length_modules(segment) * reading->map->module_mm / 1000;
    return wanted_m <= 0 || fabs(given_m - wanted_m) <= MAP_TOLERANCE_M ||
           map_reading_refuse(reading, IN_SEGMENT,
                              "is %.4f m long from \"start\" to \"end\", but its code markers take %.4f m at "
                              "%.4g mm a module",
                              given_m, wanted_m, reading->map->module_mm);
}

static map_point point_along(const map_segment *segment, double share)
{
    return (map_point){segment->start.x_m + share * (segment->end.x_m - segment->start.x_m),
                       segment->start.y_m + share * (segment->end.y_m - segment->start.y_m)};
}

static bool check_point(const map_reading *reading, const char *key, map_point given, map_point wanted, size_t slot)
{
    double off_mm = map_distance_m(given, wanted) * 1000;
    return off_mm <= MAP_TOLERANCE_M * 1000 ||
           map_reading_refuse(reading, IN_CM,
                              "\"%s\", [%.4f, %.4f], is %.1f mm off: code marker %zu of this segment has it at "
                              "[%.4f, %.4f]",
                              key, given.x_m, given.y_m, off_mm, slot, wanted.x_m, wanted.y_m);
}

/* Where CMs of a TM are missing, the place tells the slot. */
static bool check_place(const map_reading *reading, const map_segment *segment, const map_cm *cm, size_t *slot)
{
    bool is_tm = segment->code[0] != '\0';
    double all = length_modules(segment), before = is_tm ? BAR_MODULES : 0;
    if (!segment->complete) {
        double from_start_modules =
            map_distance_m(segment->start, cm->start) / map_distance_m(segment->start, segment->end) * all;
        double nearest = round((from_start_modules - before) / PITCH_MODULES);
        if (nearest < (double)*slot || nearest >= (double)strlen(segment->code))
            return map_reading_refuse(reading, IN_CM, "lies outside of its tape marker or out of order");
        *slot = (size_t)nearest;
        if (!find_slot(reading, segment, cm, slot))
            return false;
    }
    double begin = before + PITCH_MODULES * (double)*slot;
    return check_point(reading, "start", cm->start, point_along(segment, begin / all), *slot) &&
           check_point(reading, "end", cm->end, point_along(segment, (begin + CM_MODULES) / all), *slot);
}

/* ---- All of a segment ------------------------------------------------------------------------------------------ */

bool map_reading_cms(map_reading *reading, const cJSON *cms, const map_segment *segment, bool ends_given)
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
