#include "thing_options.h"

#include <stdlib.h>
#include <string.h>

#include "option_values.h"

static render_thing *add_thing(render_options *all, error_text *error)
{
    if (all->thing_count < RENDER_THINGS_MAX)
        return &all->things[all->thing_count++];
    error_text_set(error, "there are more than %d tapes and pictures; use a map", RENDER_THINGS_MAX);
    return NULL;
}

bool take_ids(render_options *all, const char *text, error_text *error)
{
    render_thing *thing = add_thing(all, error);
    return thing != NULL && parse_ids(text, RENDER_IDS_MAX, thing->ids, &thing->id_count, error);
}

/* FILE:HEIGHT or FILE:HEIGHT:MODULES; there may be colons in FILE. */
bool take_picture(render_options *all, const char *text, error_text *error)
{
    const value_range height = {VALUE_LENGTH, 0.001, 1000}, modules = {VALUE_WHOLE, 1, SCENE_SIDE_MAX_PX};
    render_thing *thing = add_thing(all, error);
    if (thing == NULL)
        return false;
    thing->picture_name = malloc(strlen(text) + 1);
    if (thing->picture_name == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    strcpy(thing->picture_name, text);
    thing->picture_path = thing->picture_name;

    char *last = strrchr(thing->picture_name, ':');
    if (last != NULL && parse_value(last + 1, modules, &thing->modules, error)) {
        *last = '\0';
        last = strrchr(thing->picture_name, ':');
    }
    if (last == NULL || last == thing->picture_name || !parse_value(last + 1, height, &thing->height_m, error)) {
        error_text_set(error, "expected FILE:HEIGHT or FILE:HEIGHT:MODULES, HEIGHT from 1mm to 1000m, not \"%.60s\"",
                       text);
        return false;
    }
    *last = '\0';
    return true;
}

bool take_place(render_options *all, const char *text, error_text *error)
{
    double place[4];
    if (all->thing_count == 0) {
        error_text_set(error, "comes after the --ids or --picture that it places");
        return false;
    }
    if (!parse_numbers(text, 4, 4, place, "X,Y,HEIGHT,FACING in metres and degrees", error))
        return false;
    const camera_waypoint checked = {.x_m = place[0], .y_m = place[1], .height_m = 1, .heading_deg = place[3]};
    const char *problem = camera_waypoint_problem(&checked);
    if (problem == NULL && !(place[2] >= 0 && place[2] <= 1000))
        problem = "the height is out of range, 0 to 1000 m";
    if (problem != NULL) {
        error_text_set(error, "%s", problem);
        return false;
    }
    render_thing *thing = &all->things[all->thing_count - 1];
    thing->placed = true;
    thing->x_m = place[0];
    thing->y_m = place[1];
    thing->above_floor_m = place[2];
    thing->facing_deg = place[3];
    return true;
}

bool take_map(render_options *all, const char *text, error_text *error)
{
    (void)error;
    all->map_path = text;
    return true;
}

bool take_bars(render_options *all, const char *text, error_text *error)
{
    static const char *const names[] = {
        [RENDER_NO_BARS] = "no", [RENDER_BARS] = "yes", [RENDER_BARS_OF_TMS] = "auto"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    all->bars = (render_bars)choice;
    return true;
}

bool take_cover(render_options *all, const char *text, error_text *error)
{
    double cover[5] = {0};
    if (all->cover_count == RENDER_COVERS_MAX) {
        error_text_set(error, "there are more than %d covers", RENDER_COVERS_MAX);
        return false;
    }
    if (!parse_numbers(text, 4, 5, cover, "X,Y,WIDTH,HEIGHT or X,Y,WIDTH,HEIGHT,ANGLE in px and degrees", error))
        return false;
    if (!(cover[2] > 0 && cover[2] <= 1e6 && cover[3] > 0 && cover[3] <= 1e6)) {
        error_text_set(error, "expected a width and a height above 0 to 1000000 px, not \"%.60s\"", text);
        return false;
    }
    all->covers[all->cover_count++] = (scene_cover){.x_px = cover[0], .y_px = cover[1], .width_px = cover[2],
                                                    .height_px = cover[3], .angle_deg = cover[4], .shade = 105,
                                                    .texture = 6};
    return true;
}

bool take_box(render_options *all, const char *text, error_text *error)
{
    const double most_m = 1e5;
    double box[6] = {0};
    if (all->box_count == RENDER_BOXES_MAX) {
        error_text_set(error, "there are more than %d boxes", RENDER_BOXES_MAX);
        return false;
    }
    if (!parse_numbers(text, 5, 6, box, "X,Y,WIDTH,DEPTH,HEIGHT[,ANGLE] in metres and degrees", error))
        return false;
    for (size_t i = 0; i < 6; i++) {
        bool size = i >= 2 && i < 5;
        if (box[i] > most_m || box[i] < (size ? 0.001 : -most_m)) {
            error_text_set(error, "expected sizes of 0.001 m or more and no number beyond %g, not \"%.60s\"", most_m,
                           text);
            return false;
        }
    }
    all->boxes[all->box_count++] = (scene_box){box[0], box[1], box[2], box[3], box[4], box[5], 120};
    return true;
}

bool take_furnished(render_options *all, const char *text, error_text *error)
{
    static const char *const names[] = {"no", "yes"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    all->furnished = choice == 1;
    return true;
}

bool take_background(render_options *all, const char *text, error_text *error)
{
    static const char *const names[] = {
        [SCENE_PLAIN] = "plain", [SCENE_NOISE] = "noise", [SCENE_POPCORN] = "popcorn", [SCENE_BLINDS] = "blinds",
        [SCENE_CHECKERBOARD] = "checkerboard", [SCENE_STRIPES] = "stripes", [SCENE_TEXT] = "text",
        [SCENE_SQUARES] = "squares", [SCENE_GRID_CODES] = "grid-codes", [SCENE_FINDER_ROWS] = "finder-rows"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    all->view.background.kind = (scene_clutter)choice;
    return true;
}

static bool take_surface(render_surface *surface, const char *text, error_text *error)
{
    static const char *const names[] = {"paint", "tiles", "bricks", "wood", "stone", "blinds", "checkerboard",
                                        "stripes", "text", "squares", "grid-codes", "finder-rows"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    if (choice < SCENE_LOOK_PATTERN)
        *surface = (render_surface){.look = (scene_look)choice};
    else
        *surface = (render_surface){SCENE_LOOK_PATTERN, (scene_clutter)(choice - SCENE_LOOK_PATTERN + SCENE_BLINDS)};
    return true;
}

bool take_wall(render_options *all, const char *text, error_text *error)
{
    return take_surface(&all->wall, text, error);
}

bool take_floor(render_options *all, const char *text, error_text *error)
{
    return take_surface(&all->floor, text, error);
}
