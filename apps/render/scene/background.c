#include "background.h"

#include <math.h>
#include <stdlib.h>

#include "elementary.h"
#include "geometry.h"
#include "patterns.h"
#include "random.h"

/* ---- Patterns ------------------------------------------------------------------------------------------ */

static void paint_pattern(const scene *view, canvas *picture)
{
    module_pattern *dark_at = module_pattern_of(view->background.kind);
    const scene_background *background = &view->background;
    const direction axis = direction_of(background->angle_deg);
    double cosine = axis.x / background->scale_px, sine = axis.y / background->scale_px;
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            double u = cosine * x + sine * y, v = cosine * y - sine * x;
            bool dark = dark_at(view->seed, (int32_t)floor(u), (int32_t)floor(v));
            row[x] = (float)(dark ? background->dark : background->light);
        }
    }
}

/* ---- Noise and blobs ----------------------------------------------------------------------------------- */

/* Noise with a mean of 0 and a standard deviation of 1, smooth over scale_px. */
static bool fill_noise(const scene *view, canvas *picture)
{
    random_source source = {view->seed ^ UINT64_C(0x6e6f697365)};
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++)
        picture->at[i] = random_normal(&source);

    double sigma_px = view->background.scale_px / 2;
    if (!canvas_blur(picture, sigma_px))
        return false;
    double power = 0;
    for (size_t i = 0; i < count; i++)
        power += (double)picture->at[i] * (double)picture->at[i];
    float gain = (float)(1 / sqrt(power / (double)count + 1e-12));
    for (size_t i = 0; i < count; i++)
        picture->at[i] *= gain;
    return true;
}

static bool paint_noise(const scene *view, canvas *picture)
{
    if (!fill_noise(view, picture))
        return false;
    float mean = (float)((view->background.light + view->background.dark) / 2);
    float deviation = (float)((view->background.light - view->background.dark) / 4);
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++)
        picture->at[i] = fmaxf(mean + deviation * picture->at[i], 0);
    return true;
}

/* Blobs stand out on one side and lie in shadow on the other, between the two shades. */
static bool paint_popcorn(const scene *view, canvas *picture)
{
    if (!fill_noise(view, picture))
        return false;
    float light = (float)view->background.light, dark = (float)view->background.dark;
    size_t count = (size_t)picture->width_px * (size_t)picture->height_px;
    for (size_t i = 0; i < count; i++) {
        float height = picture->at[i];
        picture->at[i] = height > 0.7f ? light : height < -0.9f ? dark : (3 * light + dark) / 4;
    }
    return true;
}

/* ---- A room -------------------------------------------------------------------------------------------- */

/* Shade of a wall or floor at a place on it: never quite even. */
static double uneven(double shade, double a_m, double b_m)
{
    const double degrees = 180 / 3.14159265358979323846;
    const direction a = direction_of(degrees * (1.7 * a_m + 0.6)), b = direction_of(degrees * 2.3 * b_m);
    return shade * (1 + 0.03 * a.y + 0.02 * b.x);
}

static double room_shade(const scene_background *background, scene_vector from, scene_vector ray)
{
    const double seam_m = 0.012, seam_depth = 0.35;
    double wall = ray.z > 0 ? (background->room.wall_z_m - from.z) / ray.z : HUGE_VAL;
    double floor_at = ray.y > 0 ? (background->room.floor_y_m - from.y) / ray.y : HUGE_VAL;
    if (floor_at < wall) {
        double x = from.x + floor_at * ray.x, z = from.z + floor_at * ray.z;
        double seam = fmax(0, 1 - (background->room.wall_z_m - z) / seam_m);
        return uneven(background->dark, x, z) * (1 - seam_depth * seam);
    }
    if (wall == HUGE_VAL)
        return background->light;
    return uneven(background->light, from.x + wall * ray.x, from.y + wall * ray.y);
}

void paint_room(const scene *view, int32_t top, int32_t bottom, canvas *picture)
{
    matrix axes = camera_axes(&view->camera);
    double centre_x = (view->width_px - 1) / 2.0, centre_y = (view->height_px - 1) / 2.0;
    for (int32_t y = top; y < bottom; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            scene_vector seen = {(x - centre_x) / view->camera.focal_px, (y - centre_y) / view->camera.focal_px, 1};
            scene_vector ray = transposed_times(&axes, seen);
            row[x] = (float)room_shade(&view->background, view->camera.position_m, ray);
        }
    }
}

bool paint_background(const scene *view, canvas *picture)
{
    switch (view->background.kind) {
    case SCENE_NOISE:
        return paint_noise(view, picture);
    case SCENE_POPCORN:
        return paint_popcorn(view, picture);
    case SCENE_PLAIN:
        for (size_t i = 0; i < (size_t)picture->width_px * (size_t)picture->height_px; i++)
            picture->at[i] = (float)view->background.light;
        return true;
    default:
        paint_pattern(view, picture);
        return true;
    }
}
