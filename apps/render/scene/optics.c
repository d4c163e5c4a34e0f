#include "optics.h"

#include <math.h>
#include <stdlib.h>

#include "elementary.h"

/* ---- Circle of confusion ------------------------------------------------------------------------------- */

static double half_chord(double y_px, double radius_px)
{
    return sqrt(fmax(radius_px * radius_px - y_px * y_px, 0));
}

/* Share of a pixel within a disc, by thin rows of exact length. */
static double share_in_disc(int32_t dx_px, int32_t dy_px, double radius_px)
{
    enum { ROWS = 64 };
    double sum = 0;
    for (int i = 0; i < ROWS; i++) {
        double half = half_chord(dy_px - 0.5 + (i + 0.5) / ROWS, radius_px);
        sum += fmax(fmin(dx_px + 0.5, half) - fmax(dx_px - 0.5, -half), 0);
    }
    return sum / ROWS;
}

static bool apply_disc(double radius_px, canvas *picture)
{
    enum { SIDE = 2 * (DISC_MAX_PX + 1) + 1 };
    if (radius_px <= 0)
        return true;
    canvas_tap *taps = malloc(SIDE * SIDE * sizeof *taps);
    if (taps == NULL)
        return false;
    int32_t reach_px = (int32_t)ceil(fmin(radius_px, DISC_MAX_PX));
    size_t count = 0;
    double sum = 0;
    for (int32_t dy = -reach_px; dy <= reach_px; dy++) {
        for (int32_t dx = -reach_px; dx <= reach_px; dx++) {
            double share = share_in_disc(dx, dy, radius_px);
            sum += share;
            if (share > 0)
                taps[count++] = (canvas_tap){dx, dy, (float)share};
        }
    }
    for (size_t i = 0; i < count; i++)
        taps[i].weight = (float)((double)taps[i].weight / sum);
    bool done = canvas_convolve(picture, taps, count);
    free(taps);
    return done;
}

/* ---- Motion -------------------------------------------------------------------------------------------- */

enum { MOTION_STEPS_A_PX = 4 };

/* Spreads a share over the four pixels around a point. */
static void add_tap(canvas_tap *taps, size_t *count, double x_px, double y_px, double share)
{
    double left = floor(x_px), top = floor(y_px);
    double right_share = x_px - left, bottom_share = y_px - top;
    for (int i = 0; i < 4; i++) {
        double weight = (i & 1 ? right_share : 1 - right_share) * (i & 2 ? bottom_share : 1 - bottom_share);
        canvas_tap tap = {(int32_t)left + (i & 1), (int32_t)top + (i >> 1), (float)(share * weight)};
        size_t at = 0;
        while (at < *count && (taps[at].dx_px != tap.dx_px || taps[at].dy_px != tap.dy_px))
            at++;
        if (at < *count)
            taps[at].weight += tap.weight;
        else if (tap.weight > 0)
            taps[(*count)++] = tap;
    }
}

static bool apply_motion(double length_px, double angle_deg, canvas *picture)
{
    if (length_px <= 0)
        return true;

    canvas_tap taps[4 * MOTION_MAX_PX];
    size_t count = 0;
    const direction motion = direction_of(angle_deg);
    int steps = (int)ceil(fmin(length_px, MOTION_MAX_PX) * MOTION_STEPS_A_PX);
    for (int i = 0; i < steps; i++) {
        double along_px = length_px * ((i + 0.5) / steps - 0.5);
        add_tap(taps, &count, along_px * motion.x, along_px * motion.y, 1.0 / steps);
    }
    return canvas_convolve(picture, taps, count);
}

bool apply_optics(const scene_optics *optics, canvas *picture)
{
    return canvas_blur(picture, optics->defocus_px) && apply_disc(optics->disc_px, picture) &&
           apply_motion(optics->motion_px, optics->motion_deg, picture);
}
