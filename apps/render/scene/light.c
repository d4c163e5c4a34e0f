#include "light.h"

#include <math.h>

#include "elementary.h"

static void apply_gradient_and_shadow(const scene_light *light, canvas *picture)
{
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

/* The cosine's square is 1 / (1 + tan^2), and the tangent grows with the distance from the centre. */
static void apply_vignetting(const scene_light *light, canvas *picture)
{
    double centre_x = (picture->width_px - 1) / 2.0, centre_y = (picture->height_px - 1) / 2.0;
    double reach_px = light->vignetting_px > 0 ? light->vignetting_px : length_2d(centre_x, centre_y);
    double steepness = (1 / sqrt(1 - light->vignetting) - 1) / fmax(reach_px * reach_px, 1e-9);
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        double dy = y - centre_y;
        for (int32_t x = 0; x < picture->width_px; x++) {
            double dx = x - centre_x, root = 1 + steepness * (dx * dx + dy * dy);
            row[x] *= (float)(1 / (root * root));
        }
    }
}

void apply_light(const scene_light *light, canvas *picture)
{
    if (light->gradient != 0 || light->shadow_depth != 0)
        apply_gradient_and_shadow(light, picture);
    if (light->vignetting != 0)
        apply_vignetting(light, picture);
}
