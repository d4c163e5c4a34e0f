#include "layout_map.h"

#include <stdlib.h>

static map_point point_on(const plan *wanted, const plan_line *line, double modules)
{
    double share = modules * wanted->module_mm / 1000 / plan_line_length_m(line);
    return (map_point){line->from.x_m + share * (line->to.x_m - line->from.x_m),
                       line->from.y_m + share * (line->to.y_m - line->from.y_m)};
}

static map_cm cm_on(const plan *wanted, const plan_line *line, int32_t id, uint32_t start_modules)
{
    double start = start_modules, width = TAPEMARK_CM_WIDTH_MODULES;
    return (map_cm){.id = id,
                    .centre = point_on(wanted, line, start + width / 2),
                    .start = point_on(wanted, line, start),
                    .end = point_on(wanted, line, start + width)};
}

static map_segment segment_on(const plan *wanted, const tape_layout *layout, const layout_segment *segment)
{
    const plan_line *line = &wanted->lines[segment->line];
    double start = segment->start_modules;
    double width = (double)tapemark_segment_width_modules(segment->cm_count, segment->bars);
    map_segment placed = {.first_cm = segment->first_cm,
                          .cm_count = segment->cm_count,
                          .complete = true,
                          .start = point_on(wanted, line, start),
                          .end = point_on(wanted, line, start + width),
                          .mount = line->mount == PLAN_ON_WALL ? MAP_ON_WALL : MAP_ON_FLOOR,
                          .above_floor_m = line->above_floor_m};
    for (size_t slot = 0; segment->bars && slot < segment->cm_count; slot++)
        placed.code[slot] = layout->ids[segment->first_cm + slot] >= 0 ? '1' : '0';
    return placed;
}

bool layout_map(const plan *wanted, const tape_layout *layout, tape_map *map, error_text *error)
{
    *map = (tape_map){.width_m = wanted->width_m, .height_m = wanted->height_m, .module_mm = wanted->module_mm};
    map->cms = calloc(layout->cm_count + 1, sizeof *map->cms);
    map->segments = calloc(layout->segment_count + 1, sizeof *map->segments);
    if (map->cms == NULL || map->segments == NULL) {
        tape_map_release(map);
        error_text_set(error, "not enough memory for the map");
        return false;
    }
    for (size_t i = 0; i < layout->segment_count; i++) {
        const layout_segment *segment = &layout->segments[i];
        map->segments[map->segment_count++] = segment_on(wanted, layout, segment);
        for (size_t slot = 0; slot < segment->cm_count; slot++)
            map->cms[map->cm_count++] = cm_on(wanted, &wanted->lines[segment->line],
                                              layout->ids[segment->first_cm + slot],
                                              layout_cm_start_modules(segment, slot));
    }
    return true;
}
