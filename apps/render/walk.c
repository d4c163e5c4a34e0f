#include "walk.h"

#include <math.h>

/* The room: the camera moves along x, half a metre above the floor. */
static const double wall_z_m = 0.85, floor_y_m = 0.45, above_floor_m = 0.02, tape_height_m = 0.06;

static const struct {
    int32_t ids[4];
    size_t cm_count;
    bool bars;
    double left_m;
} pieces[WALK_TAPES] = {
    {{0, -1, -2, 3}, 4, true, -0.35},
    {{4}, 1, false, 0.78},
    {{5, 6, -7}, 3, true, 1.12},
};

void walk_begin(walk *way, const scene *like)
{
    const double tape_off_wall_m = 0.001;
    way->view = *like;
    way->seed = like->seed;
    way->view.background = (scene_background){.kind = SCENE_ROOM, .light = 166, .dark = 148, .scale_px = 1,
                                              .room = {wall_z_m, floor_y_m}};
    way->view.camera = (scene_camera){.focal_px = 0.8 * like->width_px};
    for (size_t i = 0; i < WALK_TAPES; i++) {
        way->tapes[i] = scene_tape_of(pieces[i].ids, pieces[i].cm_count, pieces[i].bars);
        way->tapes[i].origin_m = (scene_vector){pieces[i].left_m, floor_y_m - above_floor_m - tape_height_m,
                                                wall_z_m - tape_off_wall_m};
    }
    way->view.tapes = way->tapes;
    way->view.tape_count = WALK_TAPES;
}

/* A wheeled camera is never quite still: slow turns, a slight bob. */
void walk_to(walk *way, int frame, int frame_count)
{
    const double pi = 3.14159265358979323846;
    double share = frame_count > 1 ? (double)frame / (frame_count - 1) : 0, turn = 0.5 - 0.5 * cos(share * pi);
    way->view.seed = way->seed + (uint64_t)frame;
    way->view.camera.position_m = (scene_vector){-0.85 + 2.3 * share, 0.004 * sin(1.9 * frame), 0};
    way->view.camera.yaw_deg = 52 - 54 * turn + 0.8 * sin(0.9 * frame);
    way->view.camera.pitch_deg = -17 + 0.6 * sin(1.3 * frame);
    way->view.camera.roll_deg = 1.2 * sin(0.6 * frame);
}
