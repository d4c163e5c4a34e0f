#include "degrade.h"

#include <math.h>

#include "elementary.h"
#include "random.h"

static const double full_well = 255;

double light_of_shade(double shade, double gamma)
{
    return full_well * power(fmin(fmax(shade / full_well, 0), 1), gamma);
}

double shade_of_light(double light, double gamma)
{
    return light_of_shade(light, 1 / gamma);
}

/* ---- Light --------------------------------------------------------------------------------------------- */

void apply_light(const scene_light *light, canvas *picture)
{
    if (light->gradient == 0 && light->shadow_depth == 0)
        return;

    const direction brighter = direction_of(light->gradient_deg), into_shadow = direction_of(light->shadow_deg);
    double centre_x = (picture->width_px - 1) / 2.0, centre_y = (picture->height_px - 1) / 2.0;
    double slope = light->gradient / length_2d(picture->width_px, picture->height_px);
    double soft_px = fmax(light->shadow_soft_px, 1);
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            double dx = x - centre_x, dy = y - centre_y;
            double gain = fmax(1 + slope * (brighter.x * dx + brighter.y * dy), 0);
            double inside_px = into_shadow.x * dx + into_shadow.y * dy - light->shadow_offset_px;
            double shadow = fmin(fmax(inside_px / soft_px + 0.5, 0), 1);
            row[x] *= (float)(gain * (1 - light->shadow_depth * shadow));
        }
    }
}

/* ---- Optics -------------------------------------------------------------------------------------------- */

enum { MOTION_MAX_PX = 128, MOTION_STEPS_A_PX = 4 };

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
    return canvas_blur(picture, optics->defocus_px) &&
           apply_motion(optics->motion_px, optics->motion_deg, picture);
}

/* ---- Sensor -------------------------------------------------------------------------------------------- */

void apply_sensor(const scene_sensor *sensor, uint64_t seed, unsigned bits, const canvas *picture,
                  uint16_t *samples)
{
    random_source noise = {seed};
    double most = (double)((1u << bits) - 1);
    float read_variance = (float)(sensor->read_noise * sensor->read_noise);
    float shot_variance = (float)(sensor->shot_noise * sensor->shot_noise / full_well);
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++) {
        float light = picture->at[i] * (float)sensor->exposure;
        light += random_normal(&noise) * sqrtf(read_variance + shot_variance * light);
        double shade = fmin(fmax((double)light, 0), full_well);
        if (sensor->gamma != 1)
            shade = shade_of_light(shade, sensor->gamma);
        samples[i] = (uint16_t)floor(shade * (most / full_well) + 0.5);
    }
}
