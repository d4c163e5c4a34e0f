#include "world.h"

#include <math.h>
#include <stdlib.h>

#include "prints.h"

typedef struct rectangle {
    double left, top, right, bottom;
} rectangle;

/* ---- Things in sight ----------------------------------------------------------------------------------- */

static linear row_of(const matrix *m, int i)
{
    return (linear){m->at[i][0], m->at[i][1], m->at[i][2]};
}

static linear minus(linear a, double times, linear b)
{
    return (linear){a.x - times * b.x, a.y - times * b.y, a.constant - times * b.constant};
}

static linear negative(linear a)
{
    return (linear){-a.x, -a.y, -a.constant};
}

/* What would be seen of a rectangle in a plane; false when there is nothing. */
static bool thing_in_sight(const scene *view, const plane *on, rectangle area, bool from_behind, thing *part)
{
    matrix to_image = plane_to_image(view, on);
    if (!project_box(view, &to_image, area.left, area.top, area.right, area.bottom, &part->box) ||
        !image_to_plane(&to_image, from_behind, &part->to_plane))
        return false;
    linear along = row_of(&part->to_plane, 0), across = row_of(&part->to_plane, 1);
    part->near = row_of(&part->to_plane, 2);
    part->inside[0] = minus(along, area.left, part->near);
    part->inside[1] = negative(minus(along, area.right, part->near));
    part->inside[2] = minus(across, area.top, part->near);
    part->inside[3] = negative(minus(across, area.bottom, part->near));
    part->camera_distance_m = camera_distance_m(view, on);
    return true;
}

/* Only in the rows that are looked at. */
static bool limit_box(pixel_rows rows, thing *part)
{
    part->box.top = part->box.top < rows.top ? rows.top : part->box.top;
    part->box.bottom = part->box.bottom > rows.bottom ? rows.bottom : part->box.bottom;
    return part->box.top < part->box.bottom;
}

static bool see_panel(const scene *view, size_t index, thing *part)
{
    const scene_panel *panel = &view->panels[index];
    const plane on = plane_of_panel(panel);
    *part = (thing){.kind = THING_PANEL, .index = index};
    return thing_in_sight(view, &on, (rectangle){0, 0, panel->width_m, panel->height_m}, true, part);
}

static bool see_tape(const scene *view, size_t index, thing *part)
{
    const scene_tape *tape = &view->tapes[index];
    const plane on = plane_of_tape(tape);
    double width = (double)tapemark_segment_width_modules(tape->cm_count, tape->bars);
    int32_t quiet = tape_quiet_columns(tape);
    *part = (thing){.kind = THING_TAPE, .index = index};
    const rectangle paper = {-quiet, -TAPE_QUIET_ROWS, width + quiet, TAPEMARK_HEIGHT_MODULES + TAPE_QUIET_ROWS};
    return thing_in_sight(view, &on, paper, false, part);
}

static bool see_picture(const scene *view, size_t index, thing *part)
{
    const scene_picture *picture = &view->pictures[index];
    const plane on = plane_of_picture(picture);
    const double border_m = picture->border_m;
    const rectangle paper = {-border_m, -border_m, picture->width_m + border_m, picture->height_m + border_m};
    *part = (thing){.kind = THING_PICTURE, .index = index};
    return thing_in_sight(view, &on, paper, false, part);
}

bool world_see(const scene *view, pixel_rows rows, world *seen)
{
    *seen = (world){.view = view, .rows = rows};
    size_t most = view->panel_count + view->tape_count + view->picture_count;
    seen->things = malloc((most + 1) * sizeof *seen->things);
    if (seen->things == NULL)
        return false;
    for (size_t i = 0; i < view->panel_count; i++) {
        thing *next = &seen->things[seen->count];
        seen->count += see_panel(view, i, next) && limit_box(rows, next);
    }
    for (size_t i = 0; i < view->tape_count; i++) {
        thing *next = &seen->things[seen->count];
        seen->count += see_tape(view, i, next) && limit_box(rows, next);
    }
    for (size_t i = 0; i < view->picture_count; i++) {
        thing *next = &seen->things[seen->count];
        seen->count += see_picture(view, i, next) && limit_box(rows, next);
    }
    return true;
}

void world_release(world *seen)
{
    free(seen->things);
    free(seen->front);
    free(seen->marks);
}

bool is_shadow(const scene *view, const thing *part)
{
    return part->kind == THING_PANEL && view->panels[part->index].look == SCENE_LOOK_SHADOW;
}

/* Moves the ends of a span to where a function, given this much of its sway within a pixel, is not negative. */
static void limit_span(const linear *function, double sway_share, int32_t y, double ends[2])
{
    double rest = function->y * y + function->constant + sway_share * (fabs(function->x) + fabs(function->y));
    if (function->x > 0)
        ends[0] = fmax(ends[0], -rest / function->x);
    else if (function->x < 0)
        ends[1] = fmin(ends[1], -rest / function->x);
    else if (rest < 0)
        ends[1] = ends[0] - 1;
}

static pixel_span limited_span(const thing *part, double sway_share, int32_t y)
{
    double ends[2] = {part->box.left, part->box.right - 1};
    limit_span(&part->near, sway_share, y, ends);
    for (int i = 0; i < 4; i++)
        limit_span(&part->inside[i], sway_share, y, ends);
    pixel_span span = {(int32_t)floor(fmin(ends[0], part->box.right)),
                       (int32_t)ceil(fmax(ends[1], part->box.left - 1)) + 1};
    span.left = span.left < part->box.left ? part->box.left : span.left;
    span.right = span.right > part->box.right ? part->box.right : span.right;
    span.right = span.right < span.left ? span.left : span.right;
    return span;
}

pixel_span span_in_row(const thing *part, int32_t y)
{
    const double slack = 1e-3;
    return limited_span(part, 0.5 + slack, y);
}

pixel_span centres_in_row(const thing *part, int32_t y)
{
    pixel_span span = limited_span(part, 0, y);
    while (span.left < span.right && !thing_at(part, span.left, y))
        span.left++;
    while (span.left < span.right && !thing_at(part, span.right - 1, y))
        span.right--;
    return span;
}

pixel_span span_in_rows(const thing *part, int32_t upper_y)
{
    const pixel_span above = span_in_row(part, upper_y), below = span_in_row(part, upper_y + 1);
    if (above.left == above.right)
        return below;
    if (below.left == below.right)
        return above;
    return (pixel_span){above.left < below.left ? above.left : below.left,
                        above.right > below.right ? above.right : below.right};
}

/* ---- What is in front ---------------------------------------------------------------------------------- */

static void put_panel_in_front(world *seen, int32_t index)
{
    const thing *part = &seen->things[index];
    for (int32_t y = part->box.top; y < part->box.bottom; y++) {
        int32_t *front = seen->front + pixel_index(seen, 0, y);
        const pixel_span span = centres_in_row(part, y);
        for (int32_t x = span.left; x < span.right; x++) {
            if (front[x] == NOTHING || !hides(&seen->things[front[x]], part, x, y))
                front[x] = index;
        }
    }
}

static void mark_mixed(world *seen, const thing *part, int32_t x, int32_t y)
{
    bool inside = x >= 0 && y >= seen->rows.top && x < seen->view->width_px && y < seen->rows.bottom;
    if (inside && !is_hidden(seen, part, x, y))
        seen->marks[pixel_index(seen, x, y)] |= MARK_MIXED;
}

/* A place in the image, for lines that leave it far. */
typedef struct spot {
    double x, y;
} spot;

/* Limits a line to a strip of the image along its `axis`, 0 for x. False when it lies outside. */
static bool clip(spot ends[2], bool along_y, double least, double most)
{
    double *from = along_y ? &ends[0].y : &ends[0].x, *to = along_y ? &ends[1].y : &ends[1].x;
    if ((*from < least && *to < least) || (*from > most && *to > most))
        return false;
    const spot a = ends[0], b = ends[1];
    double first = along_y ? a.y : a.x, last = along_y ? b.y : b.x;
    for (int i = 0; i < 2; i++) {
        double at = i == 0 ? first : last, limited = fmin(fmax(at, least), most);
        if (limited != at) {
            double share = (limited - first) / (last - first);
            ends[i] = (spot){a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
        }
    }
    return true;
}

/* Every pixel that a line crosses: column by column, or row by row where it is steep. */
static void mark_line(world *seen, const thing *part, spot a, spot b)
{
    spot ends[2] = {a, b};
    if (!clip(ends, false, -1, seen->view->width_px) || !clip(ends, true, seen->rows.top - 1, seen->rows.bottom))
        return;
    bool steep = fabs(ends[1].y - ends[0].y) > fabs(ends[1].x - ends[0].x);
    double from = steep ? ends[0].y : ends[0].x, to = steep ? ends[1].y : ends[1].x;
    double start = steep ? ends[0].x : ends[0].y, stop = steep ? ends[1].x : ends[1].y;
    double slope = to != from ? (stop - start) / (to - from) : 0;
    int32_t first = (int32_t)floor(fmin(from, to) + 0.5), last = (int32_t)floor(fmax(from, to) + 0.5);
    for (int32_t i = first; i <= last; i++) {
        double here = start + slope * (i - from), reach = 0.5 * fabs(slope) + 1e-6;
        for (int32_t j = (int32_t)floor(here - reach + 0.5); j <= (int32_t)floor(here + reach + 0.5); j++)
            mark_mixed(seen, part, steep ? j : i, steep ? i : j);
    }
}

/* The side of a rectangle between two of its edges, as far as it is before the camera. */
static void mark_side(world *seen, const thing *part, scene_vector a, scene_vector b)
{
    const double least_depth_m = 1e-4;
    if (a.z < least_depth_m && b.z < least_depth_m)
        return;
    if (a.z < least_depth_m)
        a = blend((b.z - least_depth_m) / (b.z - a.z), a, (least_depth_m - a.z) / (b.z - a.z), b);
    else if (b.z < least_depth_m)
        b = blend((b.z - least_depth_m) / (b.z - a.z), a, (least_depth_m - a.z) / (b.z - a.z), b);
    mark_line(seen, part, (spot){a.x / a.z, a.y / a.z}, (spot){b.x / b.z, b.y / b.z});
}

static void mark_outline(world *seen, const thing *part)
{
    const scene_panel *panel = &seen->view->panels[part->index];
    const plane on = plane_of_panel(panel);
    const matrix to_image = plane_to_image(seen->view, &on);
    const double x[4] = {0, panel->width_m, panel->width_m, 0}, y[4] = {0, 0, panel->height_m, panel->height_m};
    scene_vector corners[4];
    for (int i = 0; i < 4; i++)
        corners[i] = matrix_times(&to_image, (scene_vector){x[i], y[i], 1});
    for (int i = 0; i < 4; i++)
        mark_side(seen, part, corners[i], corners[(i + 1) % 4]);
}

/* Where panels cross, no outline tells. */
static void mark_changes(world *seen)
{
    size_t width = (size_t)seen->view->width_px, count = pixel_index(seen, 0, seen->rows.bottom);
    for (size_t i = 0; i < count; i++) {
        bool right = (i + 1) % width != 0 && seen->front[i] != seen->front[i + 1];
        bool below = i + width < count && seen->front[i] != seen->front[i + width];
        if (right || below)
            seen->marks[i] |= MARK_MIXED;
        if (right)
            seen->marks[i + 1] |= MARK_MIXED;
        if (below)
            seen->marks[i + width] |= MARK_MIXED;
    }
}

bool world_find_front(world *seen)
{
    size_t count = pixel_index(seen, 0, seen->rows.bottom);
    seen->front = malloc(count * sizeof *seen->front);
    seen->marks = calloc(count, 1);
    if (seen->front == NULL || seen->marks == NULL)
        return false;
    for (size_t i = 0; i < count; i++)
        seen->front[i] = NOTHING;
    for (size_t i = 0; i < seen->count && seen->things[i].kind == THING_PANEL; i++) {
        if (!is_shadow(seen->view, &seen->things[i]))
            put_panel_in_front(seen, (int32_t)i);
    }
    for (size_t i = 0; i < seen->count && seen->things[i].kind == THING_PANEL; i++)
        mark_outline(seen, &seen->things[i]);
    if (seen->view->panel_count > 0)
        mark_changes(seen);
    return true;
}

bool may_paint(world *seen, int32_t thing_index, bool partial, int32_t x, int32_t y)
{
    size_t at = pixel_index(seen, x, y);
    uint8_t *marks = &seen->marks[at];
    if (*marks & MARK_PARTIAL || (partial && *marks & MARK_TOUCHED))
        *marks |= MARK_MIXED;
    if (*marks & MARK_MIXED)
        return false;
    *marks |= (uint8_t)(MARK_TOUCHED | (partial ? MARK_PARTIAL : 0));
    if (!partial)
        seen->front[at] = thing_index;
    return true;
}
