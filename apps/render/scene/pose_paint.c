#include "pose_paint.h"

#include <string.h>

#include "background.h"
#include "mixed_paint.h"
#include "panel_paint.h"
#include "picture_paint.h"
#include "sensor.h"
#include "tape_paint.h"

static void shades_to_light(double gamma, pixel_rows rows, canvas *picture)
{
    if (gamma == 1)
        return;
    size_t end = (size_t)rows.bottom * (size_t)picture->width_px;
    for (size_t i = (size_t)rows.top * (size_t)picture->width_px; i < end; i++)
        picture->at[i] = (float)light_of_shade((double)picture->at[i], gamma);
}

bool paint_backdrop(const scene *view, canvas *behind)
{
    if (view->background.kind == SCENE_ROOM)
        return true;
    if (!paint_background(view, behind))
        return false;
    shades_to_light(view->sensor.gamma, all_rows(view), behind);
    return true;
}

static bool paint_thing(world *seen, size_t index, prints *all, canvas *picture)
{
    const thing *part = &seen->things[index];
    if (part->kind == THING_TAPE) {
        const tape_print *print = print_of_tape(all, part->index);
        return print != NULL && paint_tape(seen, index, print, picture);
    }
    const picture_print *print = print_of_picture(all, part->index);
    return print != NULL && paint_picture(seen, index, print, picture);
}

static bool paint_things(world *seen, prints *all, const canvas *behind, canvas *picture)
{
    if (seen->count == 0)
        return true;
    if (!world_find_front(seen))
        return false;
    paint_panels(seen, all, picture);
    for (size_t i = 0; i < seen->count; i++) {
        if (seen->things[i].kind != THING_PANEL && !paint_thing(seen, i, all, picture))
            return false;
    }
    return paint_mixed(seen, all, behind, picture);
}

bool paint_pose(const scene *view, prints *all, pixel_rows rows, canvas *behind, canvas *picture)
{
    if (view->background.kind == SCENE_ROOM) {
        paint_room(view, rows.top, rows.bottom, behind);
        shades_to_light(view->sensor.gamma, rows, behind);
    }
    memcpy(canvas_row(picture, rows.top), canvas_row(behind, rows.top),
           (size_t)(rows.bottom - rows.top) * (size_t)picture->width_px * sizeof *picture->at);
    world seen;
    bool done = world_see(view, rows, &seen) && paint_things(&seen, all, behind, picture);
    world_release(&seen);
    return done;
}
