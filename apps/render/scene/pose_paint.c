#include "pose_paint.h"

#include "background.h"
#include "mixed_paint.h"
#include "panel_paint.h"
#include "picture_paint.h"
#include "sensor.h"
#include "tape_paint.h"
#include "world.h"

static void shades_to_light(double gamma, canvas *picture)
{
    if (gamma == 1)
        return;
    for (size_t i = 0; i < canvas_size(picture); i++)
        picture->at[i] = (float)light_of_shade((double)picture->at[i], gamma);
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

static bool paint_things(world *seen, prints *all, canvas *behind, canvas *picture)
{
    if (seen->count == 0)
        return true;
    if (!world_find_front(seen))
        return false;
    canvas_copy(picture, behind);
    paint_panels(seen, all, picture);
    for (size_t i = 0; i < seen->count; i++) {
        if (seen->things[i].kind != THING_PANEL && !paint_thing(seen, i, all, picture))
            return false;
    }
    return paint_mixed(seen, all, behind, picture);
}

bool paint_pose(const scene *view, prints *all, canvas *picture)
{
    world seen = {.view = view};
    canvas behind;
    bool done = canvas_create(&behind, view->width_px, view->height_px) && paint_background(view, picture) &&
                world_see(view, &seen);
    if (done) {
        shades_to_light(view->sensor.gamma, picture);
        done = paint_things(&seen, all, &behind, picture);
    }
    world_release(&seen);
    canvas_release(&behind);
    return done;
}
