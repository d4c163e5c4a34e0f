/* A map as a plan gives it: TMs of three to six CMs and CMs alone, on lines in all directions, for tests that need a
 * large one. */
#ifndef PLANNED_MAP_H
#define PLANNED_MAP_H

#include <math.h>
#include <stdlib.h>

#include "map_file.h"

static inline map_point planned_point(map_point origin, double angle, double modules, double module_mm)
{
    double along_m = modules * module_mm / 1000;
    return (map_point){origin.x_m + along_m * cos(angle), origin.y_m + along_m * sin(angle)};
}

static inline void add_planned_segment(tape_map *map, size_t cms)
{
    size_t number = map->segment_count++;
    map_segment *segment = &map->segments[number];
    const map_point origin = {3 + (double)(number % 1000) * 1.7, 3 + (double)(number / 1000) * 1.7};
    double angle = (double)number * 0.61, begin = cms > 1 ? 8 : 0;
    *segment = (map_segment){.first_cm = map->cm_count, .cm_count = cms, .complete = true,
                             .mount = number % 3 == 0 ? MAP_ON_FLOOR : MAP_ON_WALL};
    segment->above_floor_m = segment->mount == MAP_ON_WALL ? 0.03 : 0;
    for (size_t slot = 0; slot < cms; slot++) {
        map_cm *cm = &map->cms[map->cm_count];
        bool light = cms == 1 || (number >> slot & 1) != 0 || map->cm_count == 0;
        double start = begin + 25 * (double)slot;
        *cm = (map_cm){.id = light ? (int32_t)map->cm_count : -(int32_t)map->cm_count,
                       .centre = planned_point(origin, angle, start + 16, map->module_mm),
                       .start = planned_point(origin, angle, start, map->module_mm),
                       .end = planned_point(origin, angle, start + 32, map->module_mm)};
        if (cms > 1)
            segment->code[slot] = light ? '1' : '0';
        map->cm_count++;
    }
    segment->start = origin;
    segment->end = planned_point(origin, angle, 2 * begin + 25 * (double)cms + 7, map->module_mm);
}

/* False when memory runs out. */
static inline bool make_planned_map(size_t cm_count, tape_map *map)
{
    static const size_t lengths[] = {6, 6, 5, 4, 1, 6, 3, 1};
    *map = (tape_map){.width_m = 1710, .height_m = 1000, .module_mm = 60.0 / 7};
    map->cms = calloc(cm_count, sizeof *map->cms);
    map->segments = calloc(cm_count, sizeof *map->segments);
    if (map->cms == NULL || map->segments == NULL) {
        tape_map_release(map);
        return false;
    }
    for (size_t i = 0; map->cm_count < cm_count; i++) {
        size_t length = lengths[i % (sizeof lengths / sizeof *lengths)];
        add_planned_segment(map, length <= cm_count - map->cm_count ? length : 1);
    }
    return true;
}

#endif
