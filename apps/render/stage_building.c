/* The building on a plan: floor, walls, boxes. */
#include <math.h>
#include <stdlib.h>

#include "map_lines.h"
#include "stage.h"

/* Lines of tape, and not walls, are on a map: what is less than this off a line hangs on its wall, */
static const double same_line_m = 0.001;

/* and walls go on to the next one's beginning when that is nearer than a CM that found no room, and the corner: there
 * is no door so narrow. */
static const double gap_closed_cms = 1.1, gap_closed_m = 0.25;

/* ---- Panels -------------------------------------------------------------------------------------------- */

static bool add_panels(stage *here, const scene_panel *panels, size_t count, error_text *error)
{
    if (here->panel_count + count > here->panel_capacity) {
        size_t capacity = 2 * here->panel_capacity + count + 16;
        scene_panel *more = realloc(here->panels, capacity * sizeof *more);
        if (more == NULL) {
            error_text_set(error, "not enough memory");
            return false;
        }
        here->panels = more;
        here->panel_capacity = capacity;
    }
    for (size_t i = 0; i < count; i++)
        here->panels[here->panel_count++] = panels[i];
    return true;
}

static void paint_surface(scene_panel *panel, const render_surface *surface, double light, double dark)
{
    static const double scales_m[SCENE_LOOK_COUNT] = {
        [SCENE_LOOK_PAINT] = 1,      [SCENE_LOOK_TILES] = 0.3,   [SCENE_LOOK_BRICKS] = 0.07,
        [SCENE_LOOK_WOOD] = 0.14,    [SCENE_LOOK_STONE] = 0.012, [SCENE_LOOK_PATTERN] = 0.03};
    bool pattern = surface->look == SCENE_LOOK_PATTERN;
    panel->look = surface->look;
    panel->pattern = surface->pattern;
    panel->light = light;
    panel->dark = pattern ? dark : 0.72 * light;
    panel->scale_m = scales_m[surface->look];
}

static bool add_wall(stage *here, scene_line line, bool furnished, error_text *error)
{
    const render_options *all = here->all;
    scene_panel panels[1 + SCENE_FURNISHING_MAX] = {scene_wall(line, all->wall_height_m)};
    paint_surface(&panels[0], &all->wall, all->view.background.light, all->view.background.dark);
    size_t count = 1;
    if (furnished)
        count += scene_furnish(line, all->wall_height_m, all->view.seed + here->panel_count, panels + 1,
                               SCENE_FURNISHING_MAX);
    return add_panels(here, panels, count, error);
}

/* ---- Walls --------------------------------------------------------------------------------------------- */

/* Whether the second line goes on, or lies, where the first one does, in its direction. */
static bool on_same_line(scene_line first, scene_line second)
{
    double length_m = line_length_m(first);
    double x = (first.to_x_m - first.from_x_m) / length_m, y = (first.to_y_m - first.from_y_m) / length_m;
    double off_from = x * (second.from_y_m - first.from_y_m) - y * (second.from_x_m - first.from_x_m);
    double off_to = x * (second.to_y_m - first.from_y_m) - y * (second.to_x_m - first.from_x_m);
    double ahead = x * (second.to_x_m - second.from_x_m) + y * (second.to_y_m - second.from_y_m);
    return fabs(off_from) < same_line_m && fabs(off_to) < same_line_m && ahead > 0;
}

/* Where two lines meet that are not parallel. */
static bool meet(scene_line a, scene_line b, double *x_m, double *y_m)
{
    const double least_sine = 0.05;
    double ax = a.to_x_m - a.from_x_m, ay = a.to_y_m - a.from_y_m, bx = b.to_x_m - b.from_x_m,
           by = b.to_y_m - b.from_y_m;
    double sine = ax * by - ay * bx;
    if (fabs(sine) < least_sine * line_length_m(a) * line_length_m(b))
        return false;
    double share = ((b.from_x_m - a.from_x_m) * by - (b.from_y_m - a.from_y_m) * bx) / sine;
    *x_m = a.from_x_m + share * ax;
    *y_m = a.from_y_m + share * ay;
    return true;
}

/* Closes a gap to where the next wall begins: both go on to the corner where they meet, if that is as near; else
 * there is a wall across. */
static bool close_gap(stage *here, scene_line *wall, scene_line *next, double widest_m, error_text *error)
{
    scene_line gap = {wall->to_x_m, wall->to_y_m, next->from_x_m, next->from_y_m};
    double x_m, y_m, width_m = line_length_m(gap);
    if (width_m == 0 || width_m > widest_m)
        return true;
    scene_line longer = *wall, longer_next = *next;
    if (meet(*wall, *next, &x_m, &y_m)) {
        longer.to_x_m = longer_next.from_x_m = x_m;
        longer.to_y_m = longer_next.from_y_m = y_m;
        double by_m = line_length_m(longer) - line_length_m(*wall);
        double next_by_m = line_length_m(longer_next) - line_length_m(*next);
        if (by_m >= 0 && by_m <= width_m && next_by_m >= 0 && next_by_m <= width_m) {
            *wall = longer;
            *next = longer_next;
            return true;
        }
    }
    return add_wall(here, gap, false, error);
}

/* One for each row of segments that hang on one line. */
static size_t find_walls(const tape_map *map, double module_m, double widest_m, scene_line *walls)
{
    size_t count = 0;
    for (size_t i = 0; i < map->segment_count; i++) {
        scene_line line;
        if (!map_segment_hangs(&map->segments[i]) || !map_segment_line(map, i, module_m, &line))
            continue;
        scene_line *wall = &walls[count > 0 ? count - 1 : 0];
        scene_line gap = {wall->to_x_m, wall->to_y_m, line.from_x_m, line.from_y_m};
        if (count > 0 && on_same_line(*wall, line) && line_length_m(gap) < widest_m) {
            wall->to_x_m = line.to_x_m;
            wall->to_y_m = line.to_y_m;
        } else {
            walls[count++] = line;
        }
    }
    return count;
}

static bool add_map_walls(stage *here, const tape_map *map, error_text *error)
{
    double module_m = map->module_mm > 0 ? map->module_mm / 1000 : here->all->module_m;
    double widest_m = gap_closed_cms * TAPEMARK_CM_WIDTH_MODULES * module_m + gap_closed_m;
    scene_line *walls = calloc(map->segment_count + 1, sizeof *walls);
    if (walls == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    size_t count = find_walls(map, here->all->module_m, widest_m, walls);
    bool done = true;
    for (size_t i = 0; done && count > 1 && i < count; i++)
        done = close_gap(here, &walls[i], &walls[(i + 1) % count], widest_m, error);
    for (size_t i = 0; done && i < count; i++)
        done = add_wall(here, walls[i], here->all->furnished, error);
    free(walls);
    return done;
}

/* ---- The building -------------------------------------------------------------------------------------- */

typedef struct extent {
    double left_m, top_m, right_m, bottom_m;
} extent;

static void include(extent *all, double x_m, double y_m, double margin_m)
{
    all->left_m = fmin(all->left_m, x_m - margin_m);
    all->top_m = fmin(all->top_m, y_m - margin_m);
    all->right_m = fmax(all->right_m, x_m + margin_m);
    all->bottom_m = fmax(all->bottom_m, y_m + margin_m);
}

/* What of the floor can matter: the plan, or else some way around all that is on it. */
static extent floor_extent(const stage *here, const tape_map *map)
{
    const double around_m = 4;
    if (map->width_m > 0 && map->height_m > 0)
        return (extent){0, 0, map->width_m, map->height_m};
    extent floor = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < map->cm_count; i++)
        include(&floor, map->cms[i].centre.x_m, map->cms[i].centre.y_m, around_m);
    for (size_t i = 0; i < here->all->thing_count; i++)
        include(&floor, here->all->things[i].x_m, here->all->things[i].y_m, around_m);
    if (here->all->camera_given)
        include(&floor, here->all->camera.x_m, here->all->camera.y_m, around_m);
    for (size_t i = 0; i < here->path.count; i++)
        include(&floor, here->path.waypoints[i].x_m, here->path.waypoints[i].y_m, around_m);
    return floor;
}

static bool add_floor(stage *here, extent all, error_text *error)
{
    const double shade = 0.88;  /* of the walls' */
    scene_panel floor = scene_floor(all.left_m, all.top_m, all.right_m - all.left_m, all.bottom_m - all.top_m, 0);
    paint_surface(&floor, &here->all->floor, shade * here->all->view.background.light,
                  here->all->view.background.dark);
    return add_panels(here, &floor, 1, error);
}

/* The walls around the plan, where its size is known. They may be those of the map once more: these are furnished. */
static bool add_outer_walls(stage *here, const tape_map *map, error_text *error)
{
    const bool furnished = false;
    double right_m = map->width_m, bottom_m = map->height_m;
    if (!(right_m > 0 && bottom_m > 0))
        return true;
    return add_wall(here, (scene_line){0, 0, right_m, 0}, furnished, error) &&
           add_wall(here, (scene_line){right_m, 0, right_m, bottom_m}, furnished, error) &&
           add_wall(here, (scene_line){right_m, bottom_m, 0, bottom_m}, furnished, error) &&
           add_wall(here, (scene_line){0, bottom_m, 0, 0}, furnished, error);
}

static bool add_boxes(stage *here, error_text *error)
{
    for (size_t i = 0; i < here->all->box_count; i++) {
        scene_panel panels[SCENE_BOX_PANELS];
        scene_box_panels(&here->all->boxes[i], panels);
        if (!add_panels(here, panels, SCENE_BOX_PANELS, error))
            return false;
    }
    return true;
}

bool stage_build(stage *here, const tape_map *map, error_text *error)
{
    return add_floor(here, floor_extent(here, map), error) && add_outer_walls(here, map, error) &&
           add_map_walls(here, map, error) && add_boxes(here, error);
}
