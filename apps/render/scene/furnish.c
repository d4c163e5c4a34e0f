/* What stands and hangs along the walls of a building. */
#include <math.h>

#include "random.h"
#include "scene.h"

/* A wall to be furnished; panels beyond the capacity are left out. */
typedef struct furnishing {
    scene_panel wall;
    scene_panel *panels;
    size_t count, capacity;
    random_source random;
} furnishing;

static double between(furnishing *all, double least, double most)
{
    return least + random_unit(&all->random) * (most - least);
}

static void add(furnishing *all, scene_panel panel)
{
    if (all->count < all->capacity)
        all->panels[all->count++] = panel;
}

/* On the wall, from its left end and from the floor. */
static void add_on_wall(furnishing *all, double left_m, double above_floor_m, double width_m, double height_m,
                        scene_panel look)
{
    const scene_panel *wall = &all->wall;
    double top_m = wall->height_m - above_floor_m - height_m;
    look.origin_m = (scene_vector){wall->origin_m.x + left_m * wall->along.x, wall->origin_m.y + top_m,
                                   wall->origin_m.z + left_m * wall->along.z};
    look.along = wall->along;
    look.down = wall->down;
    look.width_m = width_m;
    look.height_m = height_m;
    add(all, look);
}

static scene_panel painted(double shade)
{
    return (scene_panel){.look = SCENE_LOOK_PAINT, .light = shade, .dark = shade, .scale_m = 1};
}

static void add_foot(furnishing *all)
{
    const scene_panel *wall = &all->wall;
    const double base_m = 0.09, groove_m = 0.006, shadow_m = 0.3;
    double width_m = wall->width_m;
    add_on_wall(all, 0, 0, width_m, base_m, painted(196));
    add_on_wall(all, 0, base_m, width_m, groove_m, painted(120));
    add_on_wall(all, 0, 0, width_m, groove_m, painted(70));
    add(all, (scene_panel){.origin_m = {wall->origin_m.x, 0, wall->origin_m.z}, .along = wall->along,
                           .down = {wall->along.z, 0, -wall->along.x}, .width_m = width_m, .height_m = shadow_m,
                           .look = SCENE_LOOK_SHADOW, .light = 100, .dark = 62, .scale_m = 1});
}

static void add_door(furnishing *all, double left_m)
{
    const double width_m = 0.9, height_m = 2.0, frame_m = 0.07;
    double shade = between(all, 90, 190);
    add_on_wall(all, left_m, 0, width_m + 2 * frame_m, height_m + frame_m, painted(205));
    add_on_wall(all, left_m + frame_m, 0, width_m, height_m, painted(shade));
    add_on_wall(all, left_m + frame_m + 0.06, 1.0, 0.12, 0.025, painted(60));
}

static void add_socket(furnishing *all, double left_m)
{
    const double side_m = 0.081, hole_m = 0.042;
    double above_floor_m = random_unit(&all->random) < 0.7 ? 0.3 : 1.1;
    add_on_wall(all, left_m, above_floor_m, side_m, side_m, painted(225));
    add_on_wall(all, left_m + (side_m - hole_m) / 2, above_floor_m + (side_m - hole_m) / 2, hole_m, hole_m,
                painted(150));
}

static void add_poster(furnishing *all, double left_m)
{
    double width_m = between(all, 0.3, 0.7), height_m = 1.41 * width_m, margin_m = 0.06 * width_m;
    double above_floor_m = between(all, 0.9, 1.3);
    scene_clutter pattern = random_unit(&all->random) < 0.75 ? SCENE_TEXT : SCENE_GRID_CODES;
    scene_panel print = {.look = SCENE_LOOK_PATTERN, .pattern = pattern, .light = 222, .dark = 48,
                         .scale_m = between(all, 0.0025, 0.006)};
    add_on_wall(all, left_m, above_floor_m, width_m, height_m, painted(222));
    add_on_wall(all, left_m + margin_m, above_floor_m + margin_m, width_m - 2 * margin_m, height_m - 2 * margin_m,
                print);
}

/* Slats lie level: the pattern's stripes run down, so the panel's own directions change places. */
static void add_blinds(furnishing *all, double left_m)
{
    const double frame_m = 0.05, above_floor_m = 0.95;
    double width_m = between(all, 0.8, 1.3), height_m = fmin(1.1, all->wall.height_m - above_floor_m - 0.2);
    add_on_wall(all, left_m, above_floor_m - frame_m, width_m + 2 * frame_m, height_m + 2 * frame_m, painted(200));
    add_on_wall(all, left_m + frame_m, above_floor_m, width_m, height_m,
                (scene_panel){.look = SCENE_LOOK_PATTERN, .pattern = SCENE_BLINDS, .light = 235, .dark = 110,
                              .scale_m = 0.02});
    if (all->count == all->capacity)
        return;
    scene_panel *slats = &all->panels[all->count - 1];
    const scene_vector along = slats->along;
    slats->along = slats->down;
    slats->down = along;
    slats->width_m = height_m;
    slats->height_m = width_m;
}

/* One thing every few metres, none of them beyond the wall's end. */
static void add_thing(furnishing *all, double left_m, double room_m)
{
    double kind = random_unit(&all->random), slack_m = room_m - 1.5;
    double at_m = left_m + fmax(slack_m, 0) * random_unit(&all->random);
    if (all->wall.height_m < 2.2 || kind < 0.3)
        add_socket(all, at_m);
    else if (kind < 0.5)
        add_door(all, at_m);
    else if (kind < 0.8)
        add_poster(all, at_m);
    else
        add_blinds(all, at_m);
}

size_t scene_furnish(scene_line wall, double height_m, uint64_t seed, scene_panel *panels, size_t capacity)
{
    enum { THINGS_MAX = 6 };
    const double least_room_m = 1.6, least_height_m = 1.3;
    furnishing all = {.wall = scene_wall(wall, height_m), .panels = panels, .capacity = capacity, .random = {seed}};
    add_foot(&all);
    int things = height_m < least_height_m ? 0 : (int)fmin(floor(all.wall.width_m / least_room_m), THINGS_MAX);
    for (int i = 0; i < things; i++) {
        double room_m = all.wall.width_m / things;
        if (random_unit(&all.random) < 0.85)
            add_thing(&all, i * room_m + 0.05, room_m);
    }
    return all.count;
}
