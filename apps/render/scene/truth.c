#include "truth.h"

#include <math.h>
#include <stdlib.h>

#include "cover.h"
#include "exposure.h"
#include "geometry.h"
#include "world.h"

static bool in_image(const scene *view, tapemark_point point)
{
    return point.x_px >= -0.5f && (double)point.x_px <= view->width_px - 0.5 && point.y_px >= -0.5f &&
           (double)point.y_px <= view->height_px - 0.5;
}

/* ---- Part of a thing ----------------------------------------------------------------------------------- */

/* A rectangle on a plane, in its units. */
typedef struct area {
    const world *seen;
    size_t thing_index;  /* what it is part of */
    plane on;
    matrix to_image;
    double left, top, width, height;
    int columns, rows;   /* points at which it is looked at */
    const size_t *fronts;  /* things that may hide it */
    size_t front_count;
} area;

/* What all truths have. */
typedef struct measure {
    tapemark_point corners[4];
    local_scale scale;
    double visible;
    bool whole;
    scene_shares lost;
    double distance_m, angle_deg;
} measure;

/* Where a place is seen when its row is exposed: that row is where it is seen, so this comes nearer step by step. */
static bool project_in_time(const area *part, double along, double across, tapemark_point *point)
{
    enum { STEPS = 8 };
    scene posed = *part->seen->view;
    if (!project(&part->to_image, along, across, point))
        return false;
    for (int i = 0; i < STEPS && posed.move.readout > 0; i++) {
        posed.camera = camera_after(part->seen->view, row_delay_exposures(&posed, (double)point->y_px));
        matrix to_image = plane_to_image(&posed, &part->on);
        if (!project(&to_image, along, across, point))
            return false;
    }
    return true;
}

static bool corners_of(const area *part, tapemark_point corners[4])
{
    double right = part->left + part->width, bottom = part->top + part->height;
    return project_in_time(part, part->left, part->top, &corners[0]) &&
           project_in_time(part, right, part->top, &corners[1]) &&
           project_in_time(part, right, bottom, &corners[2]) &&
           project_in_time(part, part->left, bottom, &corners[3]);
}

/* Of two in the same plane, the later one covers the earlier. */
static bool covers(const world *seen, size_t front, size_t behind, double x_px, double y_px)
{
    const thing *first = &seen->things[front], *second = &seen->things[behind];
    return thing_at(first, x_px, y_px) &&
           (front > behind ? !hides(second, first, x_px, y_px) : hides(first, second, x_px, y_px));
}

static bool is_hidden_at(const area *part, double x_px, double y_px)
{
    for (size_t i = 0; i < part->front_count; i++) {
        if (covers(part->seen, part->fronts[i], part->thing_index, x_px, y_px))
            return true;
    }
    return false;
}

/* Shares of the area by evenly spread points. */
static void measure_shares(const area *part, measure *found)
{
    const scene *view = part->seen->view;
    int seen = 0, outside = 0, covered = 0, hidden = 0, count = part->columns * part->rows;
    for (int i = 0; i < count; i++) {
        double along = part->left + (i % part->columns + 0.5) / part->columns * part->width;
        double across = part->top + (i / part->columns + 0.5) / part->rows * part->height;
        tapemark_point point;
        if (!project(&part->to_image, along, across, &point) || !in_image(view, point))
            outside++;
        else if (covered_at(view, (double)point.x_px, (double)point.y_px))
            covered++;
        else if (is_hidden_at(part, (double)point.x_px, (double)point.y_px))
            hidden++;
        else
            seen++;
    }
    found->visible = (double)seen / count;
    found->lost = (scene_shares){(double)outside / count, (double)covered / count, (double)hidden / count};
}

static double length_3d(scene_vector v)
{
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

static void measure_distance(const area *part, measure *found)
{
    const scene_vector eye = part->seen->view->camera.position_m;
    double along_m = (part->left + part->width / 2) * part->on.unit_m;
    double across_m = (part->top + part->height / 2) * part->on.unit_m;
    scene_vector to = blend(1, blend(along_m, part->on.along, across_m, part->on.down), 1,
                            blend(1, part->on.origin_m, -1, eye));
    found->distance_m = length_3d(to);
    double cosine = camera_distance_m(part->seen->view, &part->on) / found->distance_m;
    found->angle_deg = acos(fmin(cosine, 1)) * (180 / 3.14159265358979323846);
}

static bool measure_area(const area *part, measure *found)
{
    const scene *view = part->seen->view;
    if (!corners_of(part, found->corners))
        return false;
    measure_shares(part, found);
    found->whole = found->visible == 1;
    for (int i = 0; i < 4; i++)
        found->whole = found->whole && in_image(view, found->corners[i]);
    found->scale = scale_at(&part->to_image, part->left + part->width / 2, part->top + part->height / 2);
    measure_distance(part, found);
    return found->visible > 0;
}

/* ---- What may hide it ---------------------------------------------------------------------------------- */

static bool boxes_meet(const pixel_box *a, const pixel_box *b)
{
    return a->left < b->right && b->left < a->right && a->top < b->bottom && b->top < a->bottom;
}

/* An earlier thing hides another one only where it is nearer, which somewhere in the box it has to be. */
static bool may_hide(const world *seen, size_t front, size_t behind)
{
    const thing *first = &seen->things[front], *second = &seen->things[behind];
    if (front == behind || is_shadow(seen->view, first) || !boxes_meet(&first->box, &second->box))
        return false;
    if (front > behind)
        return true;
    const pixel_box *box = &second->box;
    return hides(first, second, box->left, box->top) || hides(first, second, box->right, box->top) ||
           hides(first, second, box->left, box->bottom) || hides(first, second, box->right, box->bottom);
}

static size_t find_fronts(const world *seen, size_t behind, size_t *fronts)
{
    size_t count = 0;
    for (size_t i = 0; i < seen->count; i++) {
        if (may_hide(seen, i, behind))
            fronts[count++] = i;
    }
    return count;
}

/* ---- Truths -------------------------------------------------------------------------------------------- */

/* Points a module, in both directions. */
enum { POINTS_A_MODULE = 2, POINTS_OF_PICTURE = 32 };

static area strip_of(const area *tape, double left, double width)
{
    area strip = *tape;
    strip.left = left;
    strip.width = width;
    strip.height = TAPEMARK_HEIGHT_MODULES;
    strip.columns = POINTS_A_MODULE * (int)width;
    strip.rows = POINTS_A_MODULE * TAPEMARK_HEIGHT_MODULES;
    return strip;
}

static void add_cm(const area *whole, size_t slot, scene_truth *truth)
{
    size_t tape_index = whole->seen->things[whole->thing_index].index;
    const scene_tape *tape = &whole->seen->view->tapes[tape_index];
    size_t left = slot * TAPEMARK_CM_PITCH_MODULES + (tape->bars ? TAPEMARK_BAR_MODULES : 0);
    const area part = strip_of(whole, (double)left, TAPEMARK_CM_WIDTH_MODULES);
    measure found;
    if (!measure_area(&part, &found))
        return;
    if (truth->cm_count == SCENE_CMS_MAX) {
        truth->left_out++;
        return;
    }
    scene_cm_truth *cm = &truth->cms[truth->cm_count++];
    *cm = (scene_cm_truth){.id = tape->ids[slot], .tape = tape_index, .slot = slot,
                           .px_along = found.scale.along, .px_across = found.scale.across,
                           .px_min = found.scale.least, .visible = found.visible, .whole = found.whole,
                           .lost = found.lost, .distance_m = found.distance_m, .angle_deg = found.angle_deg};
    for (int i = 0; i < 4; i++)
        cm->corners[i] = found.corners[i];
}

static void add_tape(const area *whole, scene_truth *truth)
{
    size_t tape_index = whole->seen->things[whole->thing_index].index;
    const scene_tape *tape = &whole->seen->view->tapes[tape_index];
    for (size_t slot = 0; slot < tape->cm_count; slot++)
        add_cm(whole, slot, truth);

    const area part = strip_of(whole, 0, (double)tapemark_segment_width_modules(tape->cm_count, tape->bars));
    measure found;
    if (!measure_area(&part, &found))
        return;
    if (truth->tape_count == SCENE_TAPES_MAX) {
        truth->left_out++;
        return;
    }
    scene_tape_truth *entry = &truth->tapes[truth->tape_count++];
    *entry = (scene_tape_truth){.tape = tape_index, .px_along = found.scale.along, .px_across = found.scale.across,
                                .px_min = found.scale.least, .visible = found.visible, .whole = found.whole,
                                .lost = found.lost, .distance_m = found.distance_m, .angle_deg = found.angle_deg};
    for (int i = 0; i < 4; i++)
        entry->corners[i] = found.corners[i];
}

static void add_picture(const area *whole, scene_truth *truth)
{
    size_t picture_index = whole->seen->things[whole->thing_index].index;
    const scene_picture *picture = &whole->seen->view->pictures[picture_index];
    area part = *whole;
    part.width = picture->width_m;
    part.height = picture->height_m;
    part.columns = part.rows = POINTS_OF_PICTURE;
    measure found;
    if (!measure_area(&part, &found))
        return;
    if (truth->picture_count == SCENE_PICTURES_MAX) {
        truth->left_out++;
        return;
    }
    double module_m = picture->module_m;
    scene_picture_truth *entry = &truth->pictures[truth->picture_count++];
    *entry = (scene_picture_truth){.picture = picture_index, .px_along = found.scale.along * module_m,
                                   .px_across = found.scale.across * module_m,
                                   .px_min = found.scale.least * module_m, .visible = found.visible,
                                   .whole = found.whole, .lost = found.lost, .distance_m = found.distance_m,
                                   .angle_deg = found.angle_deg};
    for (int i = 0; i < 4; i++)
        entry->corners[i] = found.corners[i];
}

static void add_thing(const world *seen, size_t index, size_t *fronts, scene_truth *truth)
{
    const thing *part = &seen->things[index];
    if (part->kind == THING_PANEL)
        return;
    const scene *view = seen->view;
    const plane on = part->kind == THING_TAPE ? plane_of_tape(&view->tapes[part->index])
                                              : plane_of_picture(&view->pictures[part->index]);
    const area whole = {.seen = seen, .thing_index = index, .on = on, .to_image = plane_to_image(view, &on),
                        .fronts = fronts, .front_count = find_fronts(seen, index, fronts)};
    if (part->kind == THING_TAPE)
        add_tape(&whole, truth);
    else
        add_picture(&whole, truth);
}

bool find_truth(const scene *view, scene_truth *truth)
{
    world seen;
    bool done = world_see(view, all_rows(view), &seen);
    size_t *fronts = done ? malloc((seen.count + 1) * sizeof *fronts) : NULL;
    done = fronts != NULL;
    if (done) {
        truth->cm_count = truth->tape_count = truth->picture_count = truth->left_out = 0;
        for (size_t i = 0; i < seen.count; i++)
            add_thing(&seen, i, fronts, truth);
    }
    free(fronts);
    world_release(&seen);
    return done;
}
