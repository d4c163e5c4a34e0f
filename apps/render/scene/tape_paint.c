#include "tape_paint.h"

#include <math.h>
#include <stdlib.h>

#include "lattice.h"

enum { CELL_NONE = 2 };

/* A cell of the print, or of the endless plane around it: that begins one cell further out on all sides and is
 * not told apart there. */
typedef struct place {
    double along, across;  /* in cells */
    int32_t column, row;
} place;

static int32_t cell_index(double coordinate, int32_t count)
{
    return coordinate < count ? coordinate > -1 ? (int32_t)floor(coordinate) : -1 : count;
}

static place place_of(const matrix *to_tape, const tape_print *print, double x_px, double y_px)
{
    scene_vector p = matrix_times(to_tape, (scene_vector){x_px, y_px, 1});
    place here = {-1, -1, -1, -1};
    if (p.z > 0) {
        double depth_m = 1 / p.z;
        here.along = p.x * depth_m + print->quiet_columns;
        here.across = p.y * depth_m + print->quiet_rows;
        here.column = cell_index(here.along, print->columns);
        here.row = cell_index(here.across, print->rows);
    }
    return here;
}

static int cell_at(const tape_print *print, const place *here)
{
    if (here->column < 0 || here->column >= print->columns || here->row < 0 || here->row >= print->rows)
        return CELL_NONE;
    return print->cells[here->row * print->columns + here->column];
}

static void count_samples(const matrix *to_tape, const tape_print *print, const lattice *points, double x_px,
                          double y_px, int counts[3])
{
    for (int i = 0; i < points->count; i++) {
        place here = place_of(to_tape, print, x_px + points->dx_px[i], y_px + points->dy_px[i]);
        counts[cell_at(print, &here)]++;
    }
}

/* The two lines of pixel corners above and below a row of pixels; the first corner is that of the box. */
typedef struct corner_lines {
    place *above, *below;
} corner_lines;

/* The line between two rows, for the pixels that the tape reaches in either. */
static void fill_line(const thing *tape, const tape_print *print, int32_t upper_row, place *line)
{
    const pixel_span span = span_in_rows(tape, upper_row);
    for (int32_t x = span.left; x <= span.right; x++)
        line[x - tape->box.left] = place_of(&tape->to_plane, print, x - 0.5, upper_row + 0.5);
}

static bool same_cell(const place *a, const place *b)
{
    return a->column == b->column && a->row == b->row;
}

/* Whether all four corners lie beyond the same side of the print; the whole pixel does so then. */
static bool all_beside(const place *const corners[4], const tape_print *print)
{
    int beyond[4] = {0};
    for (int i = 0; i < 4; i++) {
        beyond[0] += corners[i]->column < 0;
        beyond[1] += corners[i]->column >= print->columns;
        beyond[2] += corners[i]->row < 0;
        beyond[3] += corners[i]->row >= print->rows;
    }
    return beyond[0] == 4 || beyond[1] == 4 || beyond[2] == 4 || beyond[3] == 4;
}

static double extent(double a, double b, double c, double d)
{
    return fmax(fmax(a, b), fmax(c, d)) - fmin(fmin(a, b), fmin(c, d));
}

typedef struct brush {
    world *seen;
    const thing *tape;
    int32_t tape_index;
    const tape_print *print;
    lattice coarse, fine;
} brush;

/* Of a pixel that the tape reaches: how many points of it show which cells. */
static void count_cells(const brush *with, const place *const corners[4], int32_t x, int32_t y, int counts[3])
{
    counts[0] = counts[1] = counts[CELL_NONE] = 0;
    if (same_cell(corners[0], corners[1]) && same_cell(corners[0], corners[2]) && same_cell(corners[0], corners[3])) {
        counts[cell_at(with->print, corners[0])] = 1;
        return;
    }
    bool small_cells =
        extent(corners[0]->along, corners[1]->along, corners[2]->along, corners[3]->along) > 0.8 ||
        extent(corners[0]->across, corners[1]->across, corners[2]->across, corners[3]->across) > 0.8;
    count_samples(&with->tape->to_plane, with->print, small_cells ? &with->fine : &with->coarse, x, y, counts);
}

static void paint_pixel(const brush *with, const place *const corners[4], int32_t x, int32_t y, float *pixel)
{
    if (all_beside(corners, with->print) || is_hidden(with->seen, with->tape, x, y))
        return;
    int counts[3];
    count_cells(with, corners, x, y, counts);
    if (counts[0] + counts[1] == 0 || !may_paint(with->seen, with->tape_index, counts[CELL_NONE] > 0, x, y))
        return;
    if (counts[0] + counts[1] + counts[CELL_NONE] == 1) {
        *pixel = with->print->shades[counts[1]];
        return;
    }
    *pixel = ((float)counts[0] * with->print->shades[0] + (float)counts[1] * with->print->shades[1] +
              (float)counts[CELL_NONE] * *pixel) / (float)(counts[0] + counts[1] + counts[CELL_NONE]);
}

static void paint_box(const brush *with, corner_lines lines, canvas *picture)
{
    const pixel_box *box = &with->tape->box;
    fill_line(with->tape, with->print, box->top - 1, lines.below);
    for (int32_t y = box->top; y < box->bottom; y++) {
        place *line = lines.above;
        lines.above = lines.below;
        lines.below = line;
        fill_line(with->tape, with->print, y, lines.below);
        const pixel_span span = span_in_row(with->tape, y);
        for (int32_t x = span.left; x < span.right; x++) {
            int32_t i = x - box->left;
            const place *const corners[4] = {&lines.above[i], &lines.above[i + 1], &lines.below[i + 1],
                                             &lines.below[i]};
            paint_pixel(with, corners, x, y, canvas_row(picture, y) + x);
        }
    }
}

bool paint_tape(world *seen, size_t thing_index, const tape_print *print, canvas *picture)
{
    const thing *tape = &seen->things[thing_index];
    size_t line_length = (size_t)(tape->box.right - tape->box.left) + 1;
    place *lines = malloc(2 * line_length * sizeof *lines);
    if (lines == NULL)
        return false;
    const brush with = {seen, tape, (int32_t)thing_index, print, lattice_of(34, 21), lattice_of(89, 55)};
    paint_box(&with, (corner_lines){lines, lines + line_length}, picture);
    free(lines);
    return true;
}

float tape_light_at(const thing *tape, const tape_print *print, double x_px, double y_px)
{
    place here = place_of(&tape->to_plane, print, x_px, y_px);
    int cell = cell_at(print, &here);
    return print->shades[cell == CELL_NONE ? 0 : cell];
}
