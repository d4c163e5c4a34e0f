#include "canvas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elementary.h"

bool canvas_create(canvas *picture, int32_t width_px, int32_t height_px)
{
    picture->width_px = width_px;
    picture->height_px = height_px;
    picture->at = calloc((size_t)width_px * (size_t)height_px, sizeof *picture->at);
    return picture->at != NULL;
}

void canvas_release(canvas *picture)
{
    free(picture->at);
    picture->at = NULL;
}

static int32_t limited(int32_t value, int32_t least, int32_t most)
{
    return value < least ? least : value > most ? most : value;
}

/* The picture with its border's pixels going on to both sides, and a little more to the right for whole blocks. */
enum { BLOCK_PX = 16 };

static bool canvas_widen(const canvas *picture, int32_t by_px, canvas *wide)
{
    if (!canvas_create(wide, picture->width_px + 2 * by_px + BLOCK_PX, picture->height_px))
        return false;
    for (int32_t y = 0; y < picture->height_px; y++) {
        const float *from = canvas_row(picture, y);
        float *to = canvas_row(wide, y);
        for (int32_t x = 0; x < by_px; x++)
            to[x] = from[0];
        memcpy(to + by_px, from, (size_t)picture->width_px * sizeof *to);
        for (int32_t x = by_px + picture->width_px; x < wide->width_px; x++)
            to[x] = from[picture->width_px - 1];
    }
    return true;
}

static void sum_block(const float *const *rows, const canvas_tap *taps, size_t tap_count, int32_t left,
                      float sums[BLOCK_PX])
{
    for (int k = 0; k < BLOCK_PX; k++)
        sums[k] = 0;
    for (size_t i = 0; i < tap_count; i++) {
        const float *from = rows[i] + left;
        const float weight = taps[i].weight;
        for (int k = 0; k < BLOCK_PX; k++)
            sums[k] += weight * from[k];
    }
}

static void convolve_rows(const canvas *wide, int32_t reach_px, const canvas_tap *taps, size_t tap_count,
                          const float **rows, canvas *picture)
{
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *to = canvas_row(picture, y);
        for (size_t i = 0; i < tap_count; i++)
            rows[i] = canvas_row(wide, limited(y + taps[i].dy_px, 0, picture->height_px - 1)) + reach_px +
                      taps[i].dx_px;
        for (int32_t x = 0; x < picture->width_px; x += BLOCK_PX) {
            float sums[BLOCK_PX];
            sum_block(rows, taps, tap_count, x, sums);
            memcpy(to + x, sums, (size_t)limited(picture->width_px - x, 0, BLOCK_PX) * sizeof *sums);
        }
    }
}

bool canvas_convolve(canvas *picture, const canvas_tap *taps, size_t tap_count)
{
    int32_t reach_px = 0;
    for (size_t i = 0; i < tap_count; i++)
        reach_px = limited(abs(taps[i].dx_px), reach_px, INT32_MAX);
    canvas wide;
    const float **rows = malloc((tap_count + 1) * sizeof *rows);
    bool done = canvas_widen(picture, reach_px, &wide) && rows != NULL;
    if (done)
        convolve_rows(&wide, reach_px, taps, tap_count, rows, picture);
    canvas_release(&wide);
    free(rows);
    return done;
}

/* Share of a Gaussian that falls on the pixel `distance` away. */
static double gaussian_share(double distance_px, double sigma_px)
{
    return normal_share_below((distance_px + 0.5) / sigma_px) - normal_share_below((distance_px - 0.5) / sigma_px);
}

bool canvas_blur(canvas *picture, double sigma_px)
{
    enum { REACH_MAX_PX = 255 };
    if (sigma_px <= 0)
        return true;

    canvas_tap row[2 * REACH_MAX_PX + 1], column[2 * REACH_MAX_PX + 1];
    int32_t reach_px = limited((int32_t)ceil(fmin(3.5 * sigma_px, REACH_MAX_PX)), 1, REACH_MAX_PX);
    double sum = 0;
    for (int32_t d = -reach_px; d <= reach_px; d++)
        sum += gaussian_share(d, sigma_px);
    size_t count = 0;
    for (int32_t d = -reach_px; d <= reach_px; d++, count++) {
        float weight = (float)(gaussian_share(d, sigma_px) / sum);
        row[count] = (canvas_tap){d, 0, weight};
        column[count] = (canvas_tap){0, d, weight};
    }
    return canvas_convolve(picture, row, count) && canvas_convolve(picture, column, count);
}
