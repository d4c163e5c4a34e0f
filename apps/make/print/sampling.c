#include "sampling.h"

#include "tapemark.h"

#include <math.h>
#include <stdlib.h>

/* Dark modules of a row to the left of a place, counted in modules from the first column drawn. */
static double ink_before(const double *sums, size_t count, double at_modules)
{
    if (at_modules <= 0)
        return 0;
    if (at_modules >= (double)count)
        return sums[count];
    size_t whole = (size_t)at_modules;
    return sums[whole] + (at_modules - (double)whole) * (sums[whole + 1] - sums[whole]);
}

/* How much of each pixel's width ink covers in a row of modules; `sums` has room for the row and one more. */
static void sample_row(const tape_piece *piece, const tape_columns *drawn, unsigned row, double module_px,
                       double *sums, double *coverage, size_t width_px)
{
    double start_modules = (double)piece->start_halves / 2 - (double)drawn->first_module;
    double end_modules = (double)piece->end_halves / 2 - (double)drawn->first_module;
    sums[0] = 0;
    for (size_t x = 0; x < drawn->count; x++)
        sums[x + 1] = sums[x] + (drawn->columns[x] >> row & 1);
    double before = ink_before(sums, drawn->count, start_modules);
    for (size_t x = 0; x < width_px; x++) {
        double right = start_modules + (double)(x + 1) / module_px;
        double after = ink_before(sums, drawn->count, right < end_modules ? right : end_modules);
        coverage[x] = (after - before) * module_px;
        before = after;
    }
}

/* Takes from a row of pixels the light that `share` of its height would lose to a row of modules. */
static void darken(double *light, const double *coverage, double share, size_t width_px)
{
    for (size_t x = 0; x < width_px; x++)
        light[x] -= share * coverage[x];
}

static void sample_pixel_row(size_t y, const double *coverage, double module_px, double *light, uint8_t *pixels,
                             size_t width_px)
{
    double top = (double)y, bottom = top + 1;
    for (size_t x = 0; x < width_px; x++)
        light[x] = 1;
    for (unsigned row = 0; row < TAPEMARK_HEIGHT_MODULES; row++) {
        double from = fmax(top, (row + 1) * module_px), to = fmin(bottom, (row + 2) * module_px);
        if (to > from)
            darken(light, coverage + row * width_px, to - from, width_px);
    }
    for (size_t x = 0; x < width_px; x++)
        pixels[x] = (uint8_t)lround(255 * fmin(fmax(light[x], 0), 1));
}

bool sample_piece(const tape_piece *piece, const tape_columns *drawn, double module_px, uint8_t *pixels,
                  size_t width_px, size_t height_px)
{
    double *sums = malloc((drawn->count + 1) * sizeof *sums);
    double *coverage = malloc((TAPEMARK_HEIGHT_MODULES + 1) * width_px * sizeof *coverage);
    bool enough = sums != NULL && coverage != NULL;
    if (enough) {
        double *light = coverage + TAPEMARK_HEIGHT_MODULES * width_px;
        for (unsigned row = 0; row < TAPEMARK_HEIGHT_MODULES; row++)
            sample_row(piece, drawn, row, module_px, sums, coverage + row * width_px, width_px);
        for (size_t y = 0; y < height_px; y++)
            sample_pixel_row(y, coverage, module_px, light, pixels + y * width_px, width_px);
    }
    free(sums);
    free(coverage);
    return enough;
}
