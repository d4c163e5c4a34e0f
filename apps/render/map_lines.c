#include "map_lines.h"

#include <math.h>

double line_length_m(scene_line line)
{
    return hypot(line.to_x_m - line.from_x_m, line.to_y_m - line.from_y_m);
}

bool map_segment_hangs(const map_segment *segment)
{
    return segment->mount != MAP_ON_FLOOR;
}

static double distance_m(map_point a, map_point b)
{
    return hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

/* Goes on at both ends by so much, in the direction of the line. */
static scene_line lengthened(scene_line line, double by_m)
{
    double length_m = line_length_m(line);
    double x_m = by_m * (line.to_x_m - line.from_x_m) / length_m,
           y_m = by_m * (line.to_y_m - line.from_y_m) / length_m;
    return (scene_line){line.from_x_m - x_m, line.from_y_m - y_m, line.to_x_m + x_m, line.to_y_m + y_m};
}

/* Of a CM that stands alone: from the CM before it in the map to it, or from it to the one behind, whichever is
 * nearer. */
static bool line_of_single(const tape_map *map, const map_segment *segment, double module_m, scene_line *line)
{
    size_t index = segment->first_cm;
    const map_cm *cm = &map->cms[index];
    double before_m = index > 0 ? distance_m(cm[-1].centre, cm->centre) : HUGE_VAL;
    double behind_m = index + 1 < map->cm_count ? distance_m(cm->centre, cm[1].centre) : HUGE_VAL;
    double nearest_m = fmin(before_m, behind_m);
    if (!(nearest_m > 0) || nearest_m == HUGE_VAL)
        return false;
    const map_cm *from = before_m <= behind_m ? cm - 1 : cm;
    double half_m = TAPEMARK_CM_WIDTH_MODULES * module_m / 2;
    double x_m = half_m * (from[1].centre.x_m - from->centre.x_m) / nearest_m;
    double y_m = half_m * (from[1].centre.y_m - from->centre.y_m) / nearest_m;
    *line = (scene_line){cm->centre.x_m - x_m, cm->centre.y_m - y_m, cm->centre.x_m + x_m, cm->centre.y_m + y_m};
    return true;
}

bool map_segment_line(const tape_map *map, size_t index, double module_m, scene_line *line)
{
    const map_segment *segment = &map->segments[index];
    double module = map->module_mm > 0 ? map->module_mm / 1000 : module_m;
    *line = (scene_line){segment->start.x_m, segment->start.y_m, segment->end.x_m, segment->end.y_m};
    if (line_length_m(*line) > 0)
        return true;
    if (segment->cm_count == 1)
        return line_of_single(map, segment, module, line);

    map_point first = map->cms[segment->first_cm].centre;
    map_point last = map->cms[segment->first_cm + segment->cm_count - 1].centre;
    *line = (scene_line){first.x_m, first.y_m, last.x_m, last.y_m};
    double length_m = line_length_m(*line);
    if (!(length_m > 0))
        return false;
    double pitches = (double)(segment->cm_count - 1);
    double beyond_modules = TAPEMARK_CM_WIDTH_MODULES / 2.0 + (segment->code[0] != '\0' ? TAPEMARK_BAR_MODULES : 0);
    *line = lengthened(*line, beyond_modules * length_m / (pitches * TAPEMARK_CM_PITCH_MODULES));
    return true;
}
