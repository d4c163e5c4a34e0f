#include "picture_paint.h"

#include <math.h>
#include <stdlib.h>

/*
 * A pixel is a quadrangle on the picture. By Green's theorem, the integral over it is one along its sides: of light
 * summed up from the picture's left edge, over the way down. Light summed up is linear within a texel, so the
 * integral of each piece of a side within one texel is exact; and the work grows with the sides, not with the area.
 */

/* In texels, y down. */
typedef struct spot {
    double x, y;
    double near;  /* 1 / depth; only spots where it is positive are before the camera */
} spot;

/* What lies to the left of a side, down along it. */
typedef struct side_sums {
    double light;    /* of the picture */
    double picture;  /* area of the picture, */
    double paper;    /* of picture and border, */
    double all;      /* of anything */
} side_sums;

typedef struct rectangle {
    double left, top, right, bottom;
} rectangle;

typedef struct texture {
    const picture_print *print;
    matrix to_texels;
    rectangle picture, paper;
} texture;

/* ---- Along a side -------------------------------------------------------------------------------------- */

/* The part of a side that goes down from `top` to `bottom`. False when nothing is left. */
static bool limit_down(spot *a, spot *b, double top, double bottom)
{
    if (b->y <= top || a->y >= bottom)
        return false;
    const double slope = (b->x - a->x) / (b->y - a->y);
    const spot from = *a;
    if (a->y < top)
        *a = (spot){from.x + slope * (top - from.y), top, 0};
    if (b->y > bottom)
        *b = (spot){from.x + slope * (bottom - from.y), bottom, 0};
    return true;
}

/* Integral of x, limited to least .. most and counted from least, over the way from ya down to yb. */
static double limited_integral(double xa, double ya, double xb, double yb, double least, double most)
{
    if (xa > xb) {
        double x = xa;
        xa = xb;
        xb = x;
    }
    if (xb <= least)
        return 0;
    if (xa >= most)
        return (most - least) * (yb - ya);
    if (xa >= least && xb <= most)
        return (0.5 * (xa + xb) - least) * (yb - ya);
    const double down_a_texel = (yb - ya) / (xb - xa), from = fmax(xa, least), to = fmin(xb, most);
    return down_a_texel * ((0.5 * (from + to) - least) * (to - from) + (most - least) * (xb - to));
}

static double area_beside(const rectangle *of, spot a, spot b)
{
    if (!limit_down(&a, &b, of->top, of->bottom))
        return 0;
    return limited_integral(a.x, a.y, b.x, b.y, of->left, of->right);
}

static double light_before(const uint32_t *sums, int32_t columns, double x)
{
    int32_t column = (int32_t)x;
    if (column >= columns)
        return sums[columns];
    return sums[column] + (x - column) * (double)(sums[column + 1] - sums[column]);
}

/* Within a row of texels, from (xa, ya) down to (xb, yb). */
static double light_in_row(const uint32_t *sums, int32_t columns, double xa, double ya, double xb, double yb)
{
    if (xa > xb) {
        double x = xa;
        xa = xb;
        xb = x;
    }
    if (xb <= 0)
        return 0;
    if (xa >= columns)
        return sums[columns] * (yb - ya);
    const double from = fmax(xa, 0), to = fmin(xb, columns);
    if (from == to)
        return light_before(sums, columns, from) * (yb - ya);
    double sum = 0, x = from, before = light_before(sums, columns, from);
    while (x < to) {
        const double next = fmin(floor(x) + 1, to), after = light_before(sums, columns, next);
        sum += 0.5 * (before + after) * (next - x);
        x = next;
        before = after;
    }
    sum += sums[columns] * (xb - to);
    return sum * ((yb - ya) / (xb - xa));
}

static double light_beside(const picture_print *print, spot a, spot b)
{
    if (!limit_down(&a, &b, 0, print->rows))
        return 0;
    const double slope = (b.x - a.x) / (b.y - a.y);
    double sum = 0, y = a.y, x = a.x;
    while (y < b.y) {
        const int32_t row = (int32_t)fmin(floor(y), print->rows - 1);
        const double next_y = fmin(row + 1, b.y), next_x = next_y < b.y ? a.x + slope * (next_y - a.y) : b.x;
        sum += light_in_row(print->sums + (size_t)row * ((size_t)print->columns + 1), print->columns, x, y, next_x,
                            next_y);
        y = next_y;
        x = next_x;
    }
    return sum / PICTURE_SUM_UNITS;
}

static side_sums sums_along(const texture *from, spot a, spot b)
{
    const double sign = a.y <= b.y ? 1 : -1;
    const spot high = sign > 0 ? a : b, low = sign > 0 ? b : a;
    return (side_sums){sign * light_beside(from->print, high, low), sign * area_beside(&from->picture, high, low),
                       sign * area_beside(&from->paper, high, low), 0.5 * (a.x + b.x) * (b.y - a.y)};
}

static void add(side_sums *to, double times, const side_sums *sums)
{
    to->light += times * sums->light;
    to->picture += times * sums->picture;
    to->paper += times * sums->paper;
    to->all += times * sums->all;
}

/* ---- Pixels -------------------------------------------------------------------------------------------- */

/* What of a pixel shows the paper, and the light of that part times the share. */
typedef struct shown {
    double share, light;
} shown;

static shown shown_by(const picture_print *print, const side_sums *sums)
{
    if (!(sums->all > 0))
        return (shown){0, 0};
    double share = fmin(fmax(sums->paper / sums->all, 0), 1);
    double light = (sums->light + print->border * (sums->paper - sums->picture)) / sums->all;
    /* Of a pixel beside the picture, the sums cancel out but for rounding. */
    return share < 1e-9 ? (shown){0, 0} : (shown){share > 1 - 1e-9 ? 1 : share, fmax(light, 0)};
}

static spot spot_at(const texture *from, double x_px, double y_px)
{
    scene_vector p = matrix_times(&from->to_texels, (scene_vector){x_px, y_px, 1});
    return (spot){p.x / p.z, p.y / p.z, p.z};
}

/* Within a pixel, light is evenly spread over the image, not over the picture. Where depth changes much within it,
 * it is taken apart. */
static shown shown_in_parts(const texture *from, double x_px, double y_px)
{
    enum { PARTS = 8 };
    shown mean = {0, 0};
    for (int i = 0; i < PARTS * PARTS; i++) {
        double left = x_px - 0.5 + (double)(i % PARTS) / PARTS, top = y_px - 0.5 + (double)(i / PARTS) / PARTS;
        const double right = left + 1.0 / PARTS, bottom = top + 1.0 / PARTS;
        const spot corners[4] = {spot_at(from, left, top), spot_at(from, right, top), spot_at(from, right, bottom),
                                 spot_at(from, left, bottom)};
        if (corners[0].near <= 0 || corners[1].near <= 0 || corners[2].near <= 0 || corners[3].near <= 0)
            continue;
        side_sums sums = {0, 0, 0, 0};
        for (int k = 0; k < 4; k++) {
            const side_sums side = sums_along(from, corners[k], corners[(k + 1) % 4]);
            add(&sums, 1, &side);
        }
        const shown part = shown_by(from->print, &sums);
        mean.share += part.share / (PARTS * PARTS);
        mean.light += part.light / (PARTS * PARTS);
    }
    return mean;
}

static bool is_even(double a, double b, double c, double d)
{
    const double least = fmin(fmin(a, b), fmin(c, d)), most = fmax(fmax(a, b), fmax(c, d));
    return least > 0 && most < 1.004 * least;
}

/* ---- Rows of pixels ------------------------------------------------------------------------------------ */

/* The line above or below a row of pixels: its corners, and the sums from one to the next. */
typedef struct corner_line {
    spot *corners;
    side_sums *sides;
} corner_line;

/* Between two rows, for the pixels that the picture reaches in either. */
static void fill_line(const texture *from, const thing *part, int32_t upper_row, corner_line *line)
{
    const pixel_span span = span_in_rows(part, upper_row);
    for (int32_t x = span.left; x <= span.right; x++) {
        const int32_t i = x - part->box.left;
        line->corners[i] = spot_at(from, x - 0.5, upper_row + 0.5);
        if (x > span.left)
            line->sides[i - 1] = sums_along(from, line->corners[i - 1], line->corners[i]);
    }
}

static shown shown_in_pixel(const texture *from, const corner_line *above, const corner_line *below, int32_t i,
                            double x_px, double y_px, const side_sums *left, const side_sums *right)
{
    if (!is_even(above->corners[i].near, above->corners[i + 1].near, below->corners[i].near,
                 below->corners[i + 1].near))
        return shown_in_parts(from, x_px, y_px);
    side_sums sums = above->sides[i];
    add(&sums, 1, right);
    add(&sums, -1, &below->sides[i]);
    add(&sums, -1, left);
    return shown_by(from->print, &sums);
}

static void paint_row(world *seen, int32_t thing_index, const texture *from, const corner_line *above,
                      const corner_line *below, int32_t y, float *row)
{
    const thing *part = &seen->things[thing_index];
    const pixel_span span = span_in_row(part, y);
    if (span.left == span.right)
        return;
    const int32_t first = span.left - part->box.left;
    side_sums left = sums_along(from, above->corners[first], below->corners[first]);
    for (int32_t x = span.left; x < span.right; x++) {
        const int32_t i = x - part->box.left;
        const side_sums right = sums_along(from, above->corners[i + 1], below->corners[i + 1]);
        if (!is_hidden(seen, part, x, y)) {
            const shown here = shown_in_pixel(from, above, below, i, x, y, &left, &right);
            if (here.share > 0 && may_paint(seen, thing_index, here.share < 1, x, y))
                row[x] = (float)(here.light + (1 - here.share) * (double)row[x]);
        }
        left = right;
    }
}

static texture texture_of(const scene_picture *picture, const thing *part, const picture_print *print)
{
    const double along = print->columns / picture->width_m, across = print->rows / picture->height_m;
    const double border_x = along * picture->border_m, border_y = across * picture->border_m;
    texture made = {print, part->to_plane, {0, 0, print->columns, print->rows},
                    {-border_x, -border_y, print->columns + border_x, print->rows + border_y}};
    for (int j = 0; j < 3; j++) {
        made.to_texels.at[0][j] *= along;
        made.to_texels.at[1][j] *= across;
    }
    return made;
}

bool paint_picture(world *seen, size_t thing_index, const picture_print *print, canvas *picture)
{
    const thing *part = &seen->things[thing_index];
    const texture from = texture_of(&seen->view->pictures[part->index], part, print);
    size_t length = (size_t)(part->box.right - part->box.left) + 1;
    spot *corners = malloc(2 * length * sizeof *corners);
    side_sums *sides = malloc(2 * length * sizeof *sides);
    bool done = corners != NULL && sides != NULL;
    if (done) {
        corner_line above = {corners, sides}, below = {corners + length, sides + length};
        fill_line(&from, part, part->box.top - 1, &below);
        for (int32_t y = part->box.top; y < part->box.bottom; y++) {
            const corner_line line = above;
            above = below;
            below = line;
            fill_line(&from, part, y, &below);
            paint_row(seen, (int32_t)thing_index, &from, &above, &below, y, canvas_row(picture, y));
        }
    }
    free(corners);
    free(sides);
    return done;
}

float picture_light_at(const world *seen, size_t thing_index, const picture_print *print, int32_t x, int32_t y)
{
    const thing *part = &seen->things[thing_index];
    const texture from = texture_of(&seen->view->pictures[part->index], part, print);
    const shown here = shown_in_parts(&from, x, y);
    return here.share > 0 ? (float)(here.light / here.share) : print->border;
}
