#include "stage.h"

#include <math.h>
#include <stdlib.h>

#include "marker_picture.h"

/* ---- Tapes and pictures of the command line ------------------------------------------------------------ */

static scene_tape tape_of(const render_options *all, const render_thing *thing)
{
    const size_t tm_cms_min = 3;
    bool bars = all->bars == RENDER_BARS || (all->bars == RENDER_BARS_OF_TMS && thing->id_count >= tm_cms_min);
    scene_tape tape = scene_tape_of(thing->ids, thing->id_count, bars);
    tape.module_m = all->module_m;
    tape.light = all->paper;
    tape.dark = all->ink;
    return tape;
}

static bool load_picture(stage *here, const render_thing *thing, error_text *error)
{
    scene_picture *picture = &here->pictures[here->picture_count];
    const marker_print print = {thing->height_m, here->all->ink, here->all->paper};
    if (!marker_picture_read(thing->picture_path, &print, picture, error))
        return false;
    here->picture_count++;
    picture->border_m = here->all->border_m;
    picture->border_shade = here->all->paper;
    if (thing->modules > 0)
        picture->module_m = thing->height_m / thing->modules;
    return true;
}

/* Tapes come first in `tapes`, in the order of the command line; those of a map follow them. */
static bool take_things(stage *here, error_text *error)
{
    const render_options *all = here->all;
    here->tapes = calloc(all->thing_count + 1, sizeof *here->tapes);
    here->pictures = calloc(all->thing_count + 1, sizeof *here->pictures);
    if (here->tapes == NULL || here->pictures == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    for (size_t i = 0; i < all->thing_count; i++) {
        const render_thing *thing = &all->things[i];
        if (thing->picture_path == NULL)
            here->tapes[here->tape_count++] = tape_of(all, thing);
        else if (!load_picture(here, thing, error))
            return false;
    }
    return true;
}

/* ---- Frames -------------------------------------------------------------------------------------------- */

static bool open_path(stage *here, error_text *error)
{
    const size_t frames_max = 100000;
    const render_options *all = here->all;
    error_text reason;
    if (!camera_path_read(all->path_path, &here->path, &reason)) {
        error_text_set(error, "%.150s: %s", all->path_path, reason.text);
        return false;
    }
    const camera_waypoint *first = &here->path.waypoints[0], *last = first + here->path.count - 1;
    double frames = floor((last->time_s - first->time_s) * all->fps + 1e-6) + 1;
    if (frames > (double)frames_max && all->frame_count == 0) {
        error_text_set(error, "%.150s: %.0f frames at %g a second are more than %zu: lower --fps, or limit --frames",
                       all->path_path, frames, all->fps, frames_max);
        return false;
    }
    here->frame_count = (size_t)(all->frame_count > 0 ? fmin(all->frame_count, frames) : frames);
    return true;
}

/* Room for a cover for each tape and picture. */
static bool reserve_covers(stage *here, error_text *error)
{
    size_t count = here->tape_count + 2 * here->picture_count;
    scene_picture *more = realloc(here->pictures, (count + 1) * sizeof *more);
    if (more == NULL) {
        error_text_set(error, "not enough memory");
        return false;
    }
    here->pictures = more;
    return true;
}

bool stage_open(stage *here, const render_options *all, error_text *error)
{
    const size_t walk_frames = 24;
    *here = (stage){.all = all, .view = all->view};
    here->frame_count = all->frame_count > 0 ? (size_t)all->frame_count : all->kind == RENDER_WALK ? walk_frames : 1;
    if (!take_things(here, error) || (all->path_path != NULL && !open_path(here, error)))
        return false;
    switch (all->kind) {
    case RENDER_WALK:
        walk_begin(&here->way, &here->view);
        break;
    case RENDER_HEAD_ON:
        stage_set_row(here);
        break;
    case RENDER_ON_PLAN:
        if (!stage_set_plan(here, error))
            return false;
    }
    if (!reserve_covers(here, error))
        return false;
    here->view.tapes = here->tapes;
    here->view.tape_count = here->tape_count;
    here->view.pictures = here->pictures;
    here->view.picture_count = here->picture_count;
    here->view.panels = here->panels;
    here->view.panel_count = here->panel_count;
    const char *problem = scene_problem(&here->view);
    if (problem != NULL)
        error_text_set(error, "%s", problem);
    return problem == NULL;
}

static scene_camera camera_at(const stage *here, const camera_waypoint *place)
{
    return scene_plan_camera(here->all->focal_px, scene_plan_point(place->x_m, place->y_m, place->height_m),
                             place->heading_deg, place->pitch_deg, place->roll_deg);
}

/* The camera moves as the path does while the shutter is open. */
static void move_along_path(stage *here)
{
    const render_options *all = here->all;
    camera_waypoint place = camera_path_at(&here->path, here->time_s);
    here->view.camera = camera_at(here, &place);
    if (all->shutter_s == 0)
        return;
    camera_waypoint before = camera_path_at(&here->path, here->time_s - all->shutter_s / 2);
    camera_waypoint after = camera_path_at(&here->path, here->time_s + all->shutter_s / 2);
    here->view.move = (scene_move){
        .by_m = {after.x_m - before.x_m, before.height_m - after.height_m, before.y_m - after.y_m},
        .yaw_deg = remainder(after.heading_deg - before.heading_deg, 360),
        .pitch_deg = after.pitch_deg - before.pitch_deg,
        .roll_deg = remainder(after.roll_deg - before.roll_deg, 360),
        .readout = all->readout_s / all->shutter_s,
    };
}

/* Paths may jump further during an exposure than can be rendered. */
static bool can_be_rendered(const stage *here, size_t frame, error_text *error)
{
    const char *problem = scene_problem(&here->view);
    if (problem != NULL)
        error_text_set(error, "%.150s: frame %zu, at %.10g s: %s", here->all->path_path, frame, here->time_s,
                       problem);
    return problem == NULL;
}

bool stage_show(stage *here, size_t frame, error_text *error)
{
    const render_options *all = here->all;
    here->time_s = (double)frame / all->fps;
    if (all->kind == RENDER_WALK) {
        walk_to(&here->way, (int)frame, (int)here->frame_count);
        here->view = here->way.view;
        return true;
    }
    here->view.seed = all->view.seed + frame;
    if (here->path.count > 0) {
        here->time_s += here->path.waypoints[0].time_s;
        move_along_path(here);
    } else if (all->camera_given) {
        here->view.camera = camera_at(here, &all->camera);
    }
    if (all->covered_share > 0)
        stage_cover(here, frame);
    return here->path.count == 0 || can_be_rendered(here, frame, error);
}

void stage_close(stage *here)
{
    for (size_t i = 0; i < here->picture_count; i++)
        marker_picture_release(&here->pictures[i]);
    camera_path_release(&here->path);
    free(here->tapes);
    free(here->pictures);
    free(here->panels);
    free(here->ids);
}
