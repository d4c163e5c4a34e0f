#include "map_reading.h"

#include "json_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

bool map_reading_refuse(const map_reading *reading, reading_place where, const char *format, ...)
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

/* ---- Members --------------------------------------------------------------------------------------------------- */

bool map_reading_check_keys(const map_reading *reading, reading_place where, const cJSON *item,
                            const char *const *keys)
{
    error_text reason;
    return json_check_keys(item, keys, false, &reason) || map_reading_refuse(reading, where, "%s", reason.text);
}

bool map_reading_number(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                        double least, double most, double *number)
{
    double value;
    if (!json_has(item, key))
        return true;
    if (!json_get_number(item, key, &value) || !(value >= least && value <= most))
        return map_reading_refuse(reading, where, "\"%s\" must be a number from %g to %g", key, least, most);
    *number = value;
    return true;
}

bool map_reading_point(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                       map_point *point)
{
    const cJSON *pair = cJSON_GetObjectItemCaseSensitive(item, key);
    const cJSON *x = cJSON_GetArrayItem(pair, 0), *y = cJSON_GetArrayItem(pair, 1);
    const tape_map *map = reading->map;
    if (!cJSON_IsArray(pair) || !cJSON_IsNumber(x) || !cJSON_IsNumber(y) || y->next != NULL ||
        !(fabs(x->valuedouble) <= MAP_COORDINATE_MAX_M && fabs(y->valuedouble) <= MAP_COORDINATE_MAX_M))
        return map_reading_refuse(reading, where, "\"%s\" must be a place on the plan in metres, [x, y]", key);
    *point = (map_point){x->valuedouble, y->valuedouble};
    return map_point_on_plan(map, *point) ||
           map_reading_refuse(reading, where, "\"%s\", [%.3f, %.3f], lies outside of the plan, %.3f m x %.3f m", key,
                              point->x_m, point->y_m, map->width_m, map->height_m);
}

double map_distance_m(map_point from, map_point to)
{
    return hypot(to.x_m - from.x_m, to.y_m - from.y_m);
}

bool map_reading_ends(const map_reading *reading, reading_place where, const cJSON *item, map_point *start,
                      map_point *end, bool *given)
{
    const double tolerance_deg = 0.5, degrees_per_radian = 57.29577951308232;
    double direction_deg = NAN;
    bool has_end = json_has(item, "end"), has_direction = json_has(item, "direction_deg");
    *given = json_has(item, "start");
    if (*given && !has_end)
        return map_reading_refuse(reading, where, "has \"start\", but no \"end\"");
    if (!*given && (has_end || has_direction))
        return map_reading_refuse(reading, where, "has \"%s\", but no \"start\"", has_end ? "end" : "direction_deg");
    if (!*given)
        return true;
    if (!map_reading_point(reading, where, item, "start", start) ||
        !map_reading_point(reading, where, item, "end", end) ||
        !map_reading_number(reading, where, item, "direction_deg", -360, 360, &direction_deg))
        return false;
    if (map_distance_m(*start, *end) < MAP_TOLERANCE_M)
        return map_reading_refuse(reading, where, "\"start\" and \"end\" are the same place");
    double from_ends_deg = atan2(end->y_m - start->y_m, end->x_m - start->x_m) * degrees_per_radian;
    return isnan(direction_deg) || fabs(remainder(direction_deg - from_ends_deg, 360)) <= tolerance_deg ||
           map_reading_refuse(reading, where, "\"direction_deg\" is %.2f, but from \"start\" to \"end\" it is %.2f",
                              direction_deg, from_ends_deg < 0 ? from_ends_deg + 360 : from_ends_deg);
}
