#include "tape_paint.h"

#include <math.h>
#include <stdlib.h>

enum { CELL_NONE = 2 };

/* A cell of the print, or of the endless plane around it: that begins one cell further out on all sides and is
 * not told apart there. */
typedef struct place {
    double along, across;  /* in cells */
    int32_t column, row;
} place;

static int32_t cell_index(double coordinate, int32_t count)
{
    return (int32_t)floor(fmin(fmax(coordinate, -1), count));
}

static place place_of(const matrix *to_tape, const tape_print *print, double x_px, double y_px)
{
    scene_vector p = matrix_times(to_tape, (scene_vector){x_px, y_px, 1});
    place here = {-1, -1, -1, -1};
    if (p.z > 0) {
        here.along = p.x / p.z + print->quiet_columns;
        here.across = p.y / p.z + print->quiet_rows;
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

/* Points spread evenly over a pixel, all different in x and in y: an edge that lies along the pixels shifts by
 * 1 / count px at a time. Fibonacci numbers make the lattice (n, m) with the points (i / n, frac(i m / n)). */
static void count_samples(const matrix *to_tape, const tape_print *print, double x_px, double y_px, bool small_cells,
                          int counts[3])
{
    const int count = small_cells ? 89 : 34, multiplier = small_cells ? 55 : 21;
    for (int i = 0; i < count; i++) {
        double dx = (i + 0.5) / count - 0.5, dy = ((i * multiplier) % count + 0.5) / count - 0.5;
        place here = place_of(to_tape, print, x_px + dx, y_px + dy);
        counts[cell_at(print, &here)]++;
    }
}

/* The two lines of pixel corners above and below a row of pixels. */
typedef struct corner_lines {
    place *above, *below;
} corner_lines;

static void fill_line(const matrix *to_tape, const tape_print *print, const pixel_box *box, double y_px, place *line)
{
    for (int32_t x = box->left; x <= box->right; x++)
        line[x - box->left] = place_of(to_tape, print, x - 0.5, y_px);
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
    count_samples(&with->tape->to_plane, with->print, x, y, small_cells, counts);
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
    const matrix *to_tape = &with->tape->to_plane;
    fill_line(to_tape, with->print, box, box->top - 0.5, lines.below);
    for (int32_t y = box->top; y < box->bottom; y++) {
        place *line = lines.above;
        lines.above = lines.below;
        lines.below = line;
        fill_line(to_tape, with->print, box, y + 0.5, lines.below);
        for (int32_t x = box->left; x < box->right; x++) {
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
    const brush with = {seen, tape, (int32_t)thing_index, print};
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
