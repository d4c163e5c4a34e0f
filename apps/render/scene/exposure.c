#include "exposure.h"

#include <math.h>

#include "background.h"
#include "elementary.h"
#include "geometry.h"
#include "pose_paint.h"
#include "prints.h"
#include "world.h"

/* Things move by no more than this from one pose to the next; beyond this many, by more. */
static const double step_px = 0.5;
enum { POSES_MAX = 256 };

scene_camera camera_after(const scene *view, double exposures)
{
    const scene_move *move = &view->move;
    scene_camera camera = view->camera;
    camera.position_m = blend(1, camera.position_m, exposures, move->by_m);
    camera.yaw_deg += exposures * move->yaw_deg;
    camera.pitch_deg += exposures * move->pitch_deg;
    camera.roll_deg += exposures * move->roll_deg;
    return camera;
}

double row_delay_exposures(const scene *view, double y_px)
{
    return view->move.readout * ((y_px + 0.5) / view->height_px - 0.5);
}

/* ---- How far things move in the image ------------------------------------------------------------------ */

/* Two poses of the camera, one exposure apart. */
typedef struct pose_pair {
    scene first, last;
} pose_pair;

static bool seen_at(const scene *view, scene_vector place_m, double *x_px, double *y_px)
{
    const plane point = {place_m, {1, 0, 0}, {0, 1, 0}, 1};
    const matrix to_image = plane_to_image(view, &point);
    const double least_depth_m = 1e-3;
    double depth_m = to_image.at[2][2];
    if (depth_m < least_depth_m)
        return false;
    *x_px = to_image.at[0][2] / depth_m;
    *y_px = to_image.at[1][2] / depth_m;
    return true;
}

/* Of a place in the world; nothing when it passes the camera. */
static double moved_px(const pose_pair *between, scene_vector place_m)
{
    double x[2], y[2];
    if (!seen_at(&between->first, place_m, &x[0], &y[0]) || !seen_at(&between->last, place_m, &x[1], &y[1]))
        return 0;
    return length_2d(x[1] - x[0], y[1] - y[0]);
}

static plane plane_of_thing(const scene *view, const thing *part)
{
    switch (part->kind) {
    case THING_TAPE: return plane_of_tape(&view->tapes[part->index]);
    case THING_PICTURE: return plane_of_picture(&view->pictures[part->index]);
    default: return plane_of_panel(&view->panels[part->index]);
    }
}

/* The most at points spread over its part of the image. */
static double thing_moved_px(const scene *view, const pose_pair *between, const thing *part)
{
    enum { SIDE = 5 };
    const plane on = plane_of_thing(view, part);
    double most_px = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x = part->box.left + (part->box.right - 1 - part->box.left) * (i % SIDE) / (SIDE - 1.0);
        double y = part->box.top + (part->box.bottom - 1 - part->box.top) * (i / SIDE) / (SIDE - 1.0);
        const scene_vector p = matrix_times(&part->to_plane, (scene_vector){x, y, 1});
        if (!(p.z > 0) || (!thing_at(part, x, y) && i != SIDE * SIDE / 2))
            continue;
        scene_vector place_m = blend(1, on.origin_m, 1, blend(p.x / p.z * on.unit_m, on.along, p.y / p.z * on.unit_m,
                                                              on.down));
        most_px = fmax(most_px, moved_px(between, place_m));
    }
    return most_px;
}

/* What is very far away moves when the camera turns. */
static double horizon_moved_px(const scene *view, const pose_pair *between)
{
    const double far_m = 1e6;
    const matrix axes = camera_axes(&view->camera);
    double most_px = 0;
    for (int i = 0; i < 9; i++) {
        double x = (i % 3 - 1) * 0.5 * view->width_px / view->camera.focal_px;
        double y = (i / 3 - 1) * 0.5 * view->height_px / view->camera.focal_px;
        const scene_vector ray = transposed_times(&axes, (scene_vector){x, y, 1});
        most_px = fmax(most_px, moved_px(between, blend(1, view->camera.position_m, far_m, ray)));
    }
    return most_px;
}

/* During one exposure. False when memory runs out. */
static bool most_moved_px(const scene *view, double *most_px)
{
    pose_pair between = {*view, *view};
    between.first.camera = camera_after(view, -0.5);
    between.last.camera = camera_after(view, 0.5);
    world seen;
    bool done = world_see(view, all_rows(view), &seen);
    *most_px = done ? horizon_moved_px(view, &between) : 0;
    for (size_t i = 0; done && i < seen.count; i++)
        *most_px = fmax(*most_px, thing_moved_px(view, &between, &seen.things[i]));
    world_release(&seen);
    return done;
}

/* ---- Poses of a frame ---------------------------------------------------------------------------------- */

static int steps_for(double moved_px, int most)
{
    return (int)fmin(fmax(ceil(moved_px / step_px), 1), most);
}

static void add_rows(const canvas *from, pixel_rows rows, float share, canvas *sum)
{
    for (int32_t y = rows.top; y < rows.bottom; y++) {
        const float *row = canvas_row(from, y);
        float *sums = canvas_row(sum, y);
        for (int32_t x = 0; x < from->width_px; x++)
            sums[x] += share * row[x];
    }
}

/* Rows that are exposed at the same time, nearly. */
static bool paint_rows(const scene *view, prints *all, canvas *behind, pixel_rows rows, int poses, canvas *one,
                       canvas *sum)
{
    double delay = row_delay_exposures(view, (rows.top + rows.bottom - 1) / 2.0);
    scene posed = *view;
    for (int i = 0; i < poses; i++) {
        posed.camera = camera_after(view, delay + (i + 0.5) / poses - 0.5);
        if (!paint_pose(&posed, all, rows, behind, one))
            return false;
        add_rows(one, rows, 1 / (float)poses, sum);
    }
    return true;
}

static bool paint_moving(const scene *view, prints *all, canvas *behind, canvas *picture)
{
    double moved_px;
    canvas one;
    bool done = canvas_create(&one, view->width_px, view->height_px) && most_moved_px(view, &moved_px);
    int poses = done ? steps_for(moved_px, POSES_MAX) : 0;
    int bands = done ? steps_for(moved_px * view->move.readout, view->height_px) : 0;
    for (int i = 0; done && i < bands; i++) {
        const pixel_rows rows = {(int32_t)((int64_t)view->height_px * i / bands),
                                 (int32_t)((int64_t)view->height_px * (i + 1) / bands)};
        done = paint_rows(view, all, behind, rows, poses, &one, picture);
    }
    canvas_release(&one);
    return done;
}

static bool stands_still(const scene_move *move)
{
    return move->by_m.x == 0 && move->by_m.y == 0 && move->by_m.z == 0 && move->yaw_deg == 0 &&
           move->pitch_deg == 0 && move->roll_deg == 0;
}

bool paint_exposure(const scene *view, canvas *picture)
{
    prints all;
    canvas behind = {0};
    bool done = prints_create(&all, view) && canvas_create(&behind, view->width_px, view->height_px) &&
                paint_backdrop(view, &behind);
    if (done && stands_still(&view->move))
        done = paint_pose(view, &all, all_rows(view), &behind, picture);
    else if (done)
        done = paint_moving(view, &all, &behind, picture);
    canvas_release(&behind);
    prints_release(&all);
    return done;
}
