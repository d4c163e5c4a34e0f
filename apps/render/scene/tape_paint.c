#include "tape_paint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"

enum { QUIET_ROWS = 1, CELL_NONE = 2 };

/* The printed tape as cells: 1 dark, 0 light, quiet zone included. */
typedef struct texture {
    uint8_t *cells;
    int32_t columns, rows;
    int32_t quiet_columns;
} texture;

static bool texture_of(const scene_tape *tape, texture *print)
{
    size_t width = tapemark_segment_width_modules(tape->cm_count, tape->bars);
    int32_t quiet = tape->bars ? 2 : 1;
    *print = (texture){NULL, (int32_t)width + 2 * quiet, TAPEMARK_HEIGHT_MODULES + 2 * QUIET_ROWS, quiet};

    size_t columns = (size_t)print->columns;
    uint8_t *modules = malloc(width * TAPEMARK_HEIGHT_MODULES);
    print->cells = calloc(columns * (size_t)print->rows, 1);
    bool done = modules != NULL && print->cells != NULL &&
                tapemark_segment_draw(tape->ids, tape->cm_count, tape->bars, modules,
                                      width * TAPEMARK_HEIGHT_MODULES) == TAPEMARK_OK;
    for (size_t y = 0; done && y < TAPEMARK_HEIGHT_MODULES; y++)
        memcpy(print->cells + (y + QUIET_ROWS) * columns + quiet, modules + y * width, width);
    free(modules);
    return done;
}

/* A cell of the texture, or of the endless plane around it: that begins one cell further out on all sides and is
 * not told apart there. */
typedef struct place {
    double along, across;  /* in cells */
    int32_t column, row;
} place;

static int32_t cell_index(double coordinate, int32_t count)
{
    return (int32_t)floor(fmin(fmax(coordinate, -1), count));
}

static place place_of(const matrix *to_tape, const texture *print, double x_px, double y_px)
{
    scene_vector p = matrix_times(to_tape, (scene_vector){x_px, y_px, 1});
    place here = {-1, -1, -1, -1};
    if (p.z > 0) {
        here.along = p.x / p.z + print->quiet_columns;
        here.across = p.y / p.z + QUIET_ROWS;
        here.column = cell_index(here.along, print->columns);
        here.row = cell_index(here.across, print->rows);
    }
    return here;
}

static int cell_at(const texture *print, const place *here)
{
    if (here->column < 0 || here->column >= print->columns || here->row < 0 || here->row >= print->rows)
        return CELL_NONE;
    return print->cells[here->row * print->columns + here->column];
}

/* Points spread evenly over a pixel, all different in x and in y: an edge that lies along the pixels shifts by
 * 1 / count px at a time. Fibonacci numbers make the lattice (n, m) with the points (i / n, frac(i m / n)). */
static void count_samples(const matrix *to_tape, const texture *print, double x_px, double y_px, bool small_cells,
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

static void fill_line(const matrix *to_tape, const texture *print, const pixel_box *box, double y_px, place *line)
{
    for (int32_t x = box->left; x <= box->right; x++)
        line[x - box->left] = place_of(to_tape, print, x - 0.5, y_px);
}

static bool same_cell(const place *a, const place *b)
{
    return a->column == b->column && a->row == b->row;
}

/* Whether all four corners lie beyond the same side of the texture; the whole pixel does so then. */
static bool all_beside(const place *const corners[4], const texture *print)
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
    const matrix *to_tape;
    const texture *print;
    float shades[2];
} brush;

static void paint_pixel(const brush *with, const place *const corners[4], int32_t x, int32_t y, float *pixel)
{
    if (all_beside(corners, with->print))
        return;
    if (same_cell(corners[0], corners[1]) && same_cell(corners[0], corners[2]) && same_cell(corners[0], corners[3])) {
        *pixel = with->shades[cell_at(with->print, corners[0])];
        return;
    }
    bool small_cells =
        extent(corners[0]->along, corners[1]->along, corners[2]->along, corners[3]->along) > 0.8 ||
        extent(corners[0]->across, corners[1]->across, corners[2]->across, corners[3]->across) > 0.8;
    int counts[3] = {0};
    count_samples(with->to_tape, with->print, x, y, small_cells, counts);
    *pixel = ((float)counts[0] * with->shades[0] + (float)counts[1] * with->shades[1] +
              (float)counts[CELL_NONE] * *pixel) / (float)(counts[0] + counts[1] + counts[CELL_NONE]);
}

static void paint_box(const brush *with, const pixel_box *box, corner_lines lines, canvas *picture)
{
    fill_line(with->to_tape, with->print, box, box->top - 0.5, lines.below);
    for (int32_t y = box->top; y < box->bottom; y++) {
        place *line = lines.above;
        lines.above = lines.below;
        lines.below = line;
        fill_line(with->to_tape, with->print, box, y + 0.5, lines.below);
        for (int32_t x = box->left; x < box->right; x++) {
            int32_t i = x - box->left;
            const place *const corners[4] = {&lines.above[i], &lines.above[i + 1], &lines.below[i + 1],
                                             &lines.below[i]};
            paint_pixel(with, corners, x, y, canvas_row(picture, y) + x);
        }
    }
}

bool paint_tape(const scene *view, const scene_tape *tape, float light, float dark, canvas *picture)
{
    matrix to_image = tape_to_image(view, tape), to_tape;
    texture print;
    if (!image_to_tape(&to_image, &to_tape))
        return true;
    if (!texture_of(tape, &print)) {
        free(print.cells);
        return false;
    }

    bool done = true;
    pixel_box box;
    double left = -print.quiet_columns, top = -QUIET_ROWS;
    if (project_box(view, &to_image, left, top, left + print.columns, top + print.rows, &box)) {
        size_t line_length = (size_t)(box.right - box.left) + 1;
        place *lines = malloc(2 * line_length * sizeof *lines);
        done = lines != NULL;
        if (done) {
            brush with = {&to_tape, &print, {light, dark}};
            paint_box(&with, &box, (corner_lines){lines, lines + line_length}, picture);
        }
        free(lines);
    }
    free(print.cells);
    return done;
}
