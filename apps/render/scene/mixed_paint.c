#include "mixed_paint.h"

#include <math.h>
#include <stdlib.h>

#include "lattice.h"
#include "panel_paint.h"
#include "picture_paint.h"
#include "tape_paint.h"

enum { MEETING_MAX = 32 };

/* One of the things that meet in a pixel. */
typedef struct meeting {
    const thing *part;
    size_t thing_index;
    bool shadow;
    bool full;      /* covers all of the pixel */
    bool known;     /* whether the light is; of a tape it is another one at each point */
    double light;   /* of a shadow: the share that it leaves */
} meeting;

typedef struct pixel {
    const world *seen;
    prints *all;
    const lattice *points;
    int32_t x, y;
    meeting things[MEETING_MAX];
    int count;
} pixel;

/* The farthest that a function gets from its value at the centre of a pixel. */
static double sway(const linear *function)
{
    return 0.5 * (fabs(function->x) + fabs(function->y));
}

static bool reaches(const thing *part, int32_t x, int32_t y)
{
    bool all = linear_at(&part->near, x, y) + sway(&part->near) > 0;
    for (int i = 0; all && i < 4; i++)
        all = linear_at(&part->inside[i], x, y) + sway(&part->inside[i]) >= 0;
    return all;
}

static bool fills(const thing *part, int32_t x, int32_t y)
{
    bool all = linear_at(&part->near, x, y) - sway(&part->near) > 0;
    for (int i = 0; all && i < 4; i++)
        all = linear_at(&part->inside[i], x, y) - sway(&part->inside[i]) >= 0;
    return all;
}

/* What is hidden at all corners of a pixel is so all over it, and what is at none is nowhere: 1 / depth is linear. */
static int hidden_corners(const thing *front, const thing *behind, int32_t x, int32_t y)
{
    return hides(front, behind, x - 0.5, y - 0.5) + hides(front, behind, x + 0.5, y - 0.5) +
           hides(front, behind, x - 0.5, y + 0.5) + hides(front, behind, x + 0.5, y + 0.5);
}

/* Adds a thing, unless another one hides all of it; and drops those that it hides. */
static void meet(pixel *here, meeting next)
{
    for (int i = 0; i < here->count; i++) {
        if (here->things[i].full && hidden_corners(here->things[i].part, next.part, here->x, here->y) == 4)
            return;
    }
    int kept = 0;
    for (int i = 0; i < here->count; i++) {
        const meeting earlier = here->things[i];
        if (!next.full || earlier.shadow || hidden_corners(earlier.part, next.part, here->x, here->y) > 0)
            here->things[kept++] = earlier;
    }
    here->count = kept;
    if (here->count < MEETING_MAX)
        here->things[here->count++] = next;
}

/* Should more meet than there is room for, the first ones count. */
static void gather(pixel *here, const size_t *candidates, size_t candidate_count)
{
    here->count = 0;
    for (size_t i = 0; i < candidate_count; i++) {
        const thing *part = &here->seen->things[candidates[i]];
        if (here->x < part->box.left || here->x >= part->box.right || !reaches(part, here->x, here->y))
            continue;
        bool shadow = is_shadow(here->seen->view, part);
        meet(here, (meeting){part, candidates[i], shadow, !shadow && fills(part, here->x, here->y), false, 0});
    }
}

static bool is_at(const meeting *one, double x_px, double y_px)
{
    return one->full || thing_at(one->part, x_px, y_px);
}

static double light_of(pixel *here, meeting *of, double x_px, double y_px)
{
    const thing *part = of->part;
    if (part->kind == THING_TAPE)
        return (double)tape_light_at(part, print_of_tape(here->all, part->index), x_px, y_px);
    if (!of->known && part->kind == THING_PICTURE) {
        const picture_print *print = print_of_picture(here->all, part->index);
        of->light = (double)picture_light_at(here->seen, of->thing_index, print, here->x, here->y);
    } else if (!of->known) {
        const patch seen = patch_at(part, x_px, y_px);
        of->light = look_at(&here->all->looks[part->index], &seen);
    }
    of->known = true;
    return of->light;
}

static double light_at(pixel *here, double x_px, double y_px, double behind)
{
    meeting *front = NULL;
    for (int i = 0; i < here->count; i++) {
        meeting *next = &here->things[i];
        if (!next->shadow && is_at(next, x_px, y_px) &&
            (front == NULL || !hides(front->part, next->part, x_px, y_px)))
            front = next;
    }
    double light = front != NULL ? light_of(here, front, x_px, y_px) : behind;
    if (front != NULL && front->part->kind != THING_PANEL)
        return light;
    for (int i = 0; i < here->count; i++) {
        meeting *next = &here->things[i];
        if (next->shadow && is_at(next, x_px, y_px) &&
            (front == NULL || !hides(front->part, next->part, x_px, y_px)))
            light *= light_of(here, next, x_px, y_px);
    }
    return light;
}

static float mean_light(pixel *here, float behind)
{
    if (here->count == 1 && here->things[0].full && here->things[0].part->kind != THING_TAPE)
        return (float)light_of(here, &here->things[0], here->x, here->y);
    double sum = 0;
    for (int i = 0; i < here->points->count; i++)
        sum += light_at(here, here->x + here->points->dx_px[i], here->y + here->points->dy_px[i], (double)behind);
    return (float)(sum / here->points->count);
}

/* Prints of what is not painted yet, because all of it is in mixed pixels, are made here. */
static bool make_prints(const world *seen, prints *all)
{
    for (size_t i = 0; i < seen->count; i++) {
        const thing *part = &seen->things[i];
        if ((part->kind == THING_TAPE && print_of_tape(all, part->index) == NULL) ||
            (part->kind == THING_PICTURE && print_of_picture(all, part->index) == NULL))
            return false;
    }
    return true;
}

static void paint_mixed_row(pixel *here, size_t *candidates, const canvas *behind, canvas *picture)
{
    const world *seen = here->seen;
    const uint8_t *marks = seen->marks + pixel_index(seen, 0, here->y);
    size_t count = 0;
    for (size_t i = 0; i < seen->count; i++) {
        if (here->y >= seen->things[i].box.top && here->y < seen->things[i].box.bottom)
            candidates[count++] = i;
    }
    for (here->x = 0; here->x < seen->view->width_px; here->x++) {
        if (!(marks[here->x] & MARK_MIXED))
            continue;
        gather(here, candidates, count);
        canvas_row(picture, here->y)[here->x] = mean_light(here, canvas_row(behind, here->y)[here->x]);
    }
}

bool paint_mixed(const world *seen, prints *all, const canvas *behind, canvas *picture)
{
    size_t *candidates = malloc((seen->count + 1) * sizeof *candidates);
    bool done = candidates != NULL && make_prints(seen, all);
    if (done) {
        const lattice points = lattice_of(34, 21);
        pixel here = {.seen = seen, .all = all, .points = &points};
        for (here.y = seen->rows.top; here.y < seen->rows.bottom; here.y++)
            paint_mixed_row(&here, candidates, behind, picture);
    }
    free(candidates);
    return done;
}
