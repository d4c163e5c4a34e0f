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

/* sum[x] += weight * row[x + dx] */
static void add_shifted(float *sum, const float *row, int32_t width_px, int32_t dx_px, float weight)
{
    int32_t from = limited(-dx_px, 0, width_px), to = limited(width_px - dx_px, from, width_px);
    for (int32_t x = 0; x < from; x++)
        sum[x] += weight * row[0];
    for (int32_t x = from; x < to; x++)
        sum[x] += weight * row[x + dx_px];
    for (int32_t x = to; x < width_px; x++)
        sum[x] += weight * row[width_px - 1];
}

bool canvas_convolve(canvas *picture, const canvas_tap *taps, size_t tap_count)
{
    canvas sums;
    if (!canvas_create(&sums, picture->width_px, picture->height_px))
        return false;
    for (int32_t y = 0; y < picture->height_px; y++) {
        for (size_t i = 0; i < tap_count; i++) {
            int32_t from_y = limited(y + taps[i].dy_px, 0, picture->height_px - 1);
            add_shifted(canvas_row(&sums, y), canvas_row(picture, from_y), picture->width_px, taps[i].dx_px,
                        taps[i].weight);
        }
    }
    canvas_release(picture);
    *picture = sums;
    return true;
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
