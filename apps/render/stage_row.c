/* Things in a row before the camera. */
#include "stage.h"

typedef struct row {
    scene_vector centre_m, along, down;
    double at_m;  /* where the next thing begins, from the centre */
} row;

static scene_vector plus(scene_vector a, scene_vector b, double times)
{
    return (scene_vector){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

static double tape_width_m(const scene_tape *tape)
{
    return (double)tapemark_segment_width_modules(tape->cm_count, tape->bars) * tape->module_m;
}

static double row_width_m(const stage *here)
{
    double width_m = here->all->gap_m * (double)(here->all->thing_count - 1);
    for (size_t i = 0; i < here->tape_count; i++)
        width_m += tape_width_m(&here->tapes[i]);
    for (size_t i = 0; i < here->picture_count; i++)
        width_m += here->pictures[i].width_m;
    return width_m;
}

/* Where a tape of one CM would be is where the row is. */
static row row_before_camera(const stage *here)
{
    static const int32_t any_id = 0;
    scene_tape tape = scene_tape_of(&any_id, 1, false);
    tape.module_m = here->all->module_m;
    scene_place(&here->view, &tape, here->all->pose);
    scene_vector middle = plus(tape.origin_m, tape.along, tape_width_m(&tape) / 2);
    middle = plus(middle, tape.down, TAPEMARK_HEIGHT_MODULES * tape.module_m / 2);
    return (row){middle, tape.along, tape.down, -row_width_m(here) / 2};
}

/* The top left corner of the next thing. */
static scene_vector take_place(row *line, double width_m, double height_m, double gap_m)
{
    scene_vector corner = plus(plus(line->centre_m, line->along, line->at_m), line->down, -height_m / 2);
    line->at_m += width_m + gap_m;
    return corner;
}

void stage_set_row(stage *here)
{
    const render_options *all = here->all;
    if (here->tape_count == 1 && here->picture_count == 0) {
        scene_place(&here->view, &here->tapes[0], all->pose);
        return;
    }
    row line = row_before_camera(here);
    scene_tape *tape = here->tapes;
    scene_picture *picture = here->pictures;
    for (size_t i = 0; i < all->thing_count; i++) {
        if (all->things[i].picture_path == NULL) {
            tape->origin_m =
                take_place(&line, tape_width_m(tape), TAPEMARK_HEIGHT_MODULES * tape->module_m, all->gap_m);
            tape->along = line.along;
            tape->down = line.down;
            tape++;
        } else {
            picture->origin_m = take_place(&line, picture->width_m, picture->height_m, all->gap_m);
            picture->along = line.along;
            picture->down = line.down;
            picture++;
        }
    }
}
