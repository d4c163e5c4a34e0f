/* Tapes of a map, and things that are placed, on a floor plan. */
#include <math.h>
#include <stdlib.h>

#include "map_file.h"
#include "map_ids.h"
#include "map_lines.h"
#include "stage.h"

static bool out_of_memory(error_text *error)
{
    error_text_set(error, "not enough memory");
    return false;
}

/* ---- Where tapes of a map lie -------------------------------------------------------------------------- */

/* The map's module may be rounded: the ink fills the line from end to end. */
static void put_segment(scene_tape *tape, const map_segment *segment, scene_line line)
{
    const double standing_modules = 4.5;  /* from the middle of the ink to the lower edge of the quiet zone */
    double modules = (double)tapemark_segment_width_modules(tape->cm_count, tape->bars);
    tape->module_m = line_length_m(line) / modules;
    if (map_segment_hangs(segment))
        scene_tape_on_wall(tape, line, 0,
                           segment->above_floor_m > 0 ? segment->above_floor_m : standing_modules * tape->module_m);
    else
        scene_tape_on_floor(tape, line, 0);
}

static bool add_map_tapes(stage *here, const tape_map *map, error_text *error)
{
    scene_tape *more = realloc(here->tapes, (here->tape_count + map->segment_count + 1) * sizeof *more);
    here->tapes = more != NULL ? more : here->tapes;
    here->ids = malloc((map->cm_count + 1) * sizeof *here->ids);
    if (more == NULL || here->ids == NULL)
        return out_of_memory(error);
    for (size_t i = 0; i < map->cm_count; i++)
        here->ids[i] = map->cms[i].id;
    for (size_t i = 0; i < map->segment_count; i++) {
        const map_segment *segment = &map->segments[i];
        scene_line line;
        if (!map_segment_line(map, i, here->all->module_m, &line))
            continue;
        scene_tape tape = scene_tape_of(here->ids + segment->first_cm, segment->cm_count, segment->code[0] != '\0');
        tape.light = here->all->paper;
        tape.dark = here->all->ink;
        put_segment(&tape, segment, line);
        here->tapes[here->tape_count++] = tape;
    }
    return true;
}

/* ---- Things that are placed ---------------------------------------------------------------------------- */

/* Through the middle of a thing, as long as it is, so that it faces where it is told to. */
static scene_line line_through(const render_thing *thing, double width_m)
{
    const double degree = 3.14159265358979323846 / 180;
    double reading = (thing->facing_deg - 90) * degree;
    double x_m = cos(reading) * width_m / 2, y_m = sin(reading) * width_m / 2;
    return (scene_line){thing->x_m - x_m, thing->y_m - y_m, thing->x_m + x_m, thing->y_m + y_m};
}

static void place_things(stage *here)
{
    scene_tape *tape = here->tapes;
    scene_picture *picture = here->pictures;
    for (size_t i = 0; i < here->all->thing_count; i++) {
        const render_thing *thing = &here->all->things[i];
        bool on_floor = thing->above_floor_m == 0;
        if (thing->picture_path == NULL) {
            double modules = (double)tapemark_segment_width_modules(tape->cm_count, tape->bars);
            scene_line line = line_through(thing, modules * tape->module_m);
            if (on_floor)
                scene_tape_on_floor(tape++, line, 0);
            else
                scene_tape_on_wall(tape++, line, 0, thing->above_floor_m);
        } else {
            scene_line line = line_through(thing, picture->width_m);
            if (on_floor)
                scene_picture_on_floor(picture++, line, 0);
            else
                scene_picture_on_wall(picture++, line, 0, thing->above_floor_m);
        }
    }
}

bool stage_set_plan(stage *here, error_text *error)
{
    tape_map map = {0};
    error_text reason;
    const char *path = here->all->map_path;
    if (path != NULL && !map_file_read(path, map_ids_check, &map, &reason)) {
        error_text_set(error, "%.150s: %s", path, reason.text);
        return false;
    }
    place_things(here);
    bool done = stage_build(here, &map, error) && add_map_tapes(here, &map, error);
    tape_map_release(&map);
    return done;
}
