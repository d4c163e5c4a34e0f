/* Where things are: before the camera, or on a floor plan. */
#include <math.h>

#include "elementary.h"
#include "geometry.h"
#include "scene.h"

static scene_vector plus(scene_vector a, scene_vector b, double times)
{
    return (scene_vector){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

/* ---- Before the camera --------------------------------------------------------------------------------- */

/* The thing's own directions, seen from the camera. */
static scene_vector turned(scene_vector v, const scene_pose *pose)
{
    const direction yaw = direction_of(pose->yaw_deg), pitch = direction_of(pose->pitch_deg);
    const direction roll = direction_of(pose->roll_deg);
    scene_vector yawed = {yaw.x * v.x - yaw.y * v.z, v.y, yaw.y * v.x + yaw.x * v.z};
    scene_vector pitched = {yawed.x, pitch.x * yawed.y - pitch.y * yawed.z, pitch.y * yawed.y + pitch.x * yawed.z};
    return (scene_vector){roll.x * pitched.x - roll.y * pitched.y, roll.y * pitched.x + roll.x * pitched.y,
                          pitched.z};
}

/* Where something of this size lies. */
typedef struct spot {
    scene_vector origin_m, along, down;
} spot;

static spot before_camera(const scene *view, double module_m, double width_m, double height_m, const scene_pose *pose)
{
    matrix axes = camera_axes(&view->camera);
    double depth_m = view->camera.focal_px * module_m / pose->px_per_module;
    scene_vector centre = {pose->dx_px / view->camera.focal_px * depth_m,
                           pose->dy_px / view->camera.focal_px * depth_m, depth_m};
    spot here;
    here.along = transposed_times(&axes, turned((scene_vector){1, 0, 0}, pose));
    here.down = transposed_times(&axes, turned((scene_vector){0, 1, 0}, pose));
    here.origin_m = plus(view->camera.position_m, transposed_times(&axes, centre), 1);
    here.origin_m = plus(here.origin_m, here.along, -width_m / 2);
    here.origin_m = plus(here.origin_m, here.down, -height_m / 2);
    return here;
}

static void put_tape(scene_tape *tape, spot here)
{
    tape->origin_m = here.origin_m;
    tape->along = here.along;
    tape->down = here.down;
}

static void put_picture(scene_picture *picture, spot here)
{
    picture->origin_m = here.origin_m;
    picture->along = here.along;
    picture->down = here.down;
}

void scene_place(const scene *view, scene_tape *tape, scene_pose pose)
{
    double width = (double)tapemark_segment_width_modules(tape->cm_count, tape->bars);
    put_tape(tape, before_camera(view, tape->module_m, width * tape->module_m,
                                 TAPEMARK_HEIGHT_MODULES * tape->module_m, &pose));
}

void scene_place_picture(const scene *view, scene_picture *picture, scene_pose pose)
{
    put_picture(picture, before_camera(view, picture->module_m, picture->width_m, picture->height_m, &pose));
}

/* ---- On a plan ----------------------------------------------------------------------------------------- */

scene_vector scene_plan_point(double x_m, double y_m, double height_m)
{
    return (scene_vector){x_m, -height_m, -y_m};
}

scene_camera scene_plan_camera(double focal_px, scene_vector position_m, double heading_deg, double pitch_deg,
                               double roll_deg)
{
    return (scene_camera){focal_px, position_m, heading_deg + 90, pitch_deg, roll_deg};
}

static double length_of(scene_line line)
{
    double x = line.to_x_m - line.from_x_m, y = line.to_y_m - line.from_y_m;
    return sqrt(x * x + y * y);
}

/* A point on the floor some way along a line, and the directions along it and to its right. */
typedef struct way {
    scene_vector from_m, along, right;
} way;

static way way_along(scene_line line, double start_m)
{
    double length_m = length_of(line);
    scene_vector along = {(line.to_x_m - line.from_x_m) / length_m, 0, -(line.to_y_m - line.from_y_m) / length_m};
    return (way){plus(scene_plan_point(line.from_x_m, line.from_y_m, 0), along, start_m), along,
                 {along.z, 0, -along.x}};
}

static spot on_wall(scene_line line, double start_m, double above_floor_m, double height_m)
{
    const way wall = way_along(line, start_m);
    const scene_vector down = {0, 1, 0};
    return (spot){plus(wall.from_m, down, -above_floor_m - height_m / 2), wall.along, down};
}

static spot on_floor(scene_line line, double start_m, double height_m)
{
    const way floor_line = way_along(line, start_m);
    return (spot){plus(floor_line.from_m, floor_line.right, -height_m / 2), floor_line.along, floor_line.right};
}

void scene_tape_on_wall(scene_tape *tape, scene_line line, double start_m, double above_floor_m)
{
    put_tape(tape, on_wall(line, start_m, above_floor_m, TAPEMARK_HEIGHT_MODULES * tape->module_m));
}

void scene_tape_on_floor(scene_tape *tape, scene_line line, double start_m)
{
    put_tape(tape, on_floor(line, start_m, TAPEMARK_HEIGHT_MODULES * tape->module_m));
}

void scene_picture_on_wall(scene_picture *picture, scene_line line, double start_m, double above_floor_m)
{
    put_picture(picture, on_wall(line, start_m, above_floor_m, picture->height_m));
}

void scene_picture_on_floor(scene_picture *picture, scene_line line, double start_m)
{
    put_picture(picture, on_floor(line, start_m, picture->height_m));
}

/* ---- Walls, floors, boxes ------------------------------------------------------------------------------ */

static const double paint_light = 176, paint_dark = 140;

scene_panel scene_wall(scene_line line, double height_m)
{
    const way foot = way_along(line, 0);
    return (scene_panel){.origin_m = {foot.from_m.x, -height_m, foot.from_m.z}, .along = foot.along,
                         .down = {0, 1, 0}, .width_m = length_of(line), .height_m = height_m,
                         .look = SCENE_LOOK_PAINT, .light = paint_light, .dark = paint_dark, .scale_m = 1};
}

scene_panel scene_floor(double left_m, double top_m, double width_m, double depth_m, double above_floor_m)
{
    return (scene_panel){.origin_m = scene_plan_point(left_m, top_m, above_floor_m), .along = {1, 0, 0},
                         .down = {0, 0, -1}, .width_m = width_m, .height_m = depth_m, .look = SCENE_LOOK_PAINT,
                         .light = paint_light, .dark = paint_dark, .scale_m = 1};
}

/* On the floor, to the left of a side that goes clockwise around. */
static scene_panel shadow_beside(scene_line side, double reach_m)
{
    scene_panel shadow = scene_wall((scene_line){side.to_x_m, side.to_y_m, side.from_x_m, side.from_y_m}, reach_m);
    shadow.origin_m.y = 0;
    shadow.down = (scene_vector){shadow.along.z, 0, -shadow.along.x};
    shadow.look = SCENE_LOOK_SHADOW;
    shadow.dark = 0.6 * shadow.light;
    return shadow;
}

void scene_box_panels(const scene_box *box, scene_panel panels[SCENE_BOX_PANELS])
{
    enum { SIDES = 4, TOP = 4, SHADOWS = 5 };
    static const double brightness[TOP + 1] = {0.8, 0.92, 1, 0.88, 1.1};
    const direction along = direction_of(box->turned_deg);
    double x[SIDES], y[SIDES];
    for (int i = 0; i < SIDES; i++) {
        double half_width = (i == 0 || i == 3 ? -0.5 : 0.5) * box->width_m;
        double half_depth = (i < 2 ? -0.5 : 0.5) * box->depth_m;
        x[i] = box->x_m + along.x * half_width - along.y * half_depth;
        y[i] = box->y_m + along.y * half_width + along.x * half_depth;
    }
    for (int i = 0; i < SIDES; i++) {
        const scene_line side = {x[i], y[i], x[(i + 1) % SIDES], y[(i + 1) % SIDES]};
        panels[i] = scene_wall(side, box->height_m);
        panels[SHADOWS + i] = shadow_beside(side, fmin(box->height_m, 0.25));
    }
    panels[TOP] = scene_floor(0, 0, box->width_m, box->depth_m, 0);
    panels[TOP].origin_m = scene_plan_point(x[0], y[0], box->height_m);
    panels[TOP].along = panels[0].along;
    panels[TOP].down = panels[1].along;
    for (int i = 0; i <= TOP; i++)
        panels[i].light = fmin(box->shade * brightness[i], 255);
}

scene_picture scene_picture_of(const uint8_t *texels, int32_t columns, int32_t rows, double height_m)
{
    return (scene_picture){.texels = texels, .columns = columns, .rows = rows, .width_m = height_m * columns / rows,
                           .height_m = height_m, .module_m = height_m / rows, .border_shade = 190,
                           .origin_m = {0, 0, 1}, .along = {1, 0, 0}, .down = {0, 1, 0}};
}
