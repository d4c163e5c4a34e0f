#include "mixed_paint.h"

#include <math.h>
#include <stdlib.h>

#include "panel_paint.h"
#include "picture_paint.h"
#include "tape_paint.h"

/* Points of a pixel, as those of tape_paint.c. */
enum { POINTS = 34, MULTIPLIER = 21, MEETING_MAX = 32 };

/* One of the things that meet in a pixel. */
typedef struct meeting {
    const thing *part;
    size_t thing_index;
    bool known;     /* whether the light is; of a tape it is another one at each point */
    double light;   /* of a shadow: the share that it leaves */
} meeting;

typedef struct pixel {
    const world *seen;
    prints *all;
    int32_t x, y;
    meeting things[MEETING_MAX];
    int count;
} pixel;

static double most_of(const linear *function, int32_t x, int32_t y)
{
    return linear_at(function, x, y) + 0.5 * (fabs(function->x) + fabs(function->y));
}

static bool reaches(const thing *part, int32_t x, int32_t y)
{
    return most_of(&part->near, x, y) > 0 && most_of(&part->inside[0], x, y) >= 0 &&
           most_of(&part->inside[1], x, y) >= 0 && most_of(&part->inside[2], x, y) >= 0 &&
           most_of(&part->inside[3], x, y) >= 0;
}

/* Should more meet than there is room for, the last ones count. */
static void gather(pixel *here, const size_t *candidates, size_t candidate_count)
{
    here->count = 0;
    for (size_t i = candidate_count; i-- > 0 && here->count < MEETING_MAX;) {
        const thing *part = &here->seen->things[candidates[i]];
        if (here->x >= part->box.left && here->x < part->box.right && reaches(part, here->x, here->y))
            here->things[here->count++] = (meeting){part, candidates[i], false, 0};
    }
    for (int i = 0; i < here->count / 2; i++) {
        const meeting other = here->things[here->count - 1 - i];
        here->things[here->count - 1 - i] = here->things[i];
        here->things[i] = other;
    }
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
        if (!is_shadow(here->seen->view, next->part) && thing_at(next->part, x_px, y_px) &&
            (front == NULL || !hides(front->part, next->part, x_px, y_px)))
            front = next;
    }
    double light = front != NULL ? light_of(here, front, x_px, y_px) : behind;
    if (front != NULL && front->part->kind != THING_PANEL)
        return light;
    for (int i = 0; i < here->count; i++) {
        meeting *next = &here->things[i];
        if (is_shadow(here->seen->view, next->part) && thing_at(next->part, x_px, y_px) &&
            (front == NULL || !hides(front->part, next->part, x_px, y_px)))
            light *= light_of(here, next, x_px, y_px);
    }
    return light;
}

static float mean_light(pixel *here, float behind)
{
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        double dx = (i + 0.5) / POINTS - 0.5, dy = ((i * MULTIPLIER) % POINTS + 0.5) / POINTS - 0.5;
        sum += light_at(here, here->x + dx, here->y + dy, (double)behind);
    }
    return (float)(sum / POINTS);
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
    const uint8_t *marks = seen->marks + (size_t)here->y * (size_t)seen->view->width_px;
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
        pixel here = {.seen = seen, .all = all};
        for (here.y = 0; here.y < seen->view->height_px; here.y++)
            paint_mixed_row(&here, candidates, behind, picture);
    }
    free(candidates);
    return done;
}
