#include "truth.h"

#include "cover.h"
#include "geometry.h"

static bool in_image(const scene *view, tapemark_point point)
{
    return point.x_px >= -0.5f && (double)point.x_px <= view->width_px - 0.5 && point.y_px >= -0.5f &&
           (double)point.y_px <= view->height_px - 0.5;
}

/* The columns of a tape from `left` to `left + width`, over its whole height. */
typedef struct strip {
    const scene *view;
    const matrix *to_image;
    double left, width;
} strip;

static bool corners_of(const strip *part, tapemark_point corners[4])
{
    double right = part->left + part->width, bottom = TAPEMARK_HEIGHT_MODULES;
    return project(part->to_image, part->left, 0, &corners[0]) && project(part->to_image, right, 0, &corners[1]) &&
           project(part->to_image, right, bottom, &corners[2]) &&
           project(part->to_image, part->left, bottom, &corners[3]);
}

/* Share of the strip that can be seen, from two points a module in both directions. */
static double visible_share(const strip *part)
{
    int columns = 2 * (int)part->width, rows = 2 * TAPEMARK_HEIGHT_MODULES, seen = 0;
    for (int i = 0; i < columns * rows; i++) {
        double along = part->left + (i % columns + 0.5) / 2, across = (i / columns + 0.5) / 2;
        tapemark_point point;
        seen += project(part->to_image, along, across, &point) && in_image(part->view, point) &&
                !covered_at(part->view, (double)point.x_px, (double)point.y_px);
    }
    return (double)seen / (columns * rows);
}

static bool all_in_image(const scene *view, const tapemark_point corners[4])
{
    return in_image(view, corners[0]) && in_image(view, corners[1]) && in_image(view, corners[2]) &&
           in_image(view, corners[3]);
}

static void add_cm(const scene *view, const matrix *to_image, size_t tape_index, size_t slot, scene_truth *truth)
{
    const scene_tape *tape = &view->tapes[tape_index];
    size_t left = slot * TAPEMARK_CM_PITCH_MODULES + (tape->bars ? TAPEMARK_BAR_MODULES : 0);
    strip part = {view, to_image, (double)left, TAPEMARK_CM_WIDTH_MODULES};
    scene_cm_truth cm = {.id = tape->ids[slot], .tape = tape_index, .slot = slot};
    if (!corners_of(&part, cm.corners))
        return;

    cm.visible = visible_share(&part);
    cm.whole = cm.visible == 1 && all_in_image(view, cm.corners);
    local_scale scale = scale_at(to_image, part.left + part.width / 2, TAPEMARK_HEIGHT_MODULES / 2.0);
    cm.px_along = scale.along;
    cm.px_across = scale.across;
    cm.px_min = scale.least;
    if (cm.visible > 0)
        truth->cms[truth->cm_count++] = cm;
}

static void add_tape(const scene *view, const matrix *to_image, size_t tape_index, scene_truth *truth)
{
    const scene_tape *tape = &view->tapes[tape_index];
    strip part = {view, to_image, 0, (double)tapemark_segment_width_modules(tape->cm_count, tape->bars)};
    scene_tape_truth entry = {.tape = tape_index};
    if (!corners_of(&part, entry.corners))
        return;

    entry.visible = visible_share(&part);
    entry.whole = entry.visible == 1 && all_in_image(view, entry.corners);
    local_scale scale = scale_at(to_image, part.width / 2, TAPEMARK_HEIGHT_MODULES / 2.0);
    entry.px_along = scale.along;
    entry.px_across = scale.across;
    if (entry.visible > 0)
        truth->tapes[truth->tape_count++] = entry;
}

void find_truth(const scene *view, scene_truth *truth)
{
    truth->cm_count = 0;
    truth->tape_count = 0;
    for (size_t i = 0; i < view->tape_count; i++) {
        matrix to_image = tape_to_image(view, &view->tapes[i]), to_tape;
        if (!image_to_tape(&to_image, &to_tape))
            continue;
        for (size_t slot = 0; slot < view->tapes[i].cm_count; slot++)
            add_cm(view, &to_image, i, slot, truth);
        add_tape(view, &to_image, i, truth);
    }
}
