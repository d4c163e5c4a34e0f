#include "view.h"

#include <math.h>
#include <stdlib.h>

#include "block_coding.h"
#include "canvas.h"
#include "elementary.h"
#include "light.h"
#include "optics.h"
#include "random.h"
#include "sensor.h"

/* ---- By the seed --------------------------------------------------------------------------------------- */

static double between(random_source *source, double least, double most)
{
    return least + (most - least) * random_unit(source);
}

/* As often from 1 to 2 as from 2 to 4. */
static double by_factors(random_source *source, double least, double most)
{
    return least * power(most / least, random_unit(source));
}

static bool one_in(random_source *source, unsigned count)
{
    return random_bits(source) % count == 0;
}

static void choose_look(random_source *source, scene *look)
{
    if (one_in(source, 3))
        look->light = (scene_light){.gradient = between(source, 0, 1), .gradient_deg = between(source, 0, 360)};
    if (one_in(source, 6)) {
        look->light.shadow_depth = between(source, 0.2, 0.9);
        look->light.shadow_deg = between(source, 0, 360);
        look->light.shadow_offset_px = between(source, -250, 250);
        look->light.shadow_soft_px = by_factors(source, 1, 100);
    }
    look->optics = (scene_optics){.defocus_px = between(source, 0.3, one_in(source, 4) ? 2.5 : 0.9)};
    if (one_in(source, 4)) {
        look->optics.motion_px = between(source, 0.5, 8);
        look->optics.motion_deg = between(source, 0, 180);
    }
    look->sensor.exposure = by_factors(source, 0.25, 2.5);
    look->sensor.read_noise = by_factors(source, 0.2, 4);
    look->sensor.shot_noise = by_factors(source, 0.2, 5);
    look->sensor.gamma = one_in(source, 3) ? 2.2 : 1;
    look->sensor.jpeg_quality = one_in(source, 20) ? (int)between(source, 20, 95) : 0;
}

sheet_view view_at_random(uint64_t seed, int32_t width_px, int32_t height_px)
{
    random_source source = {seed};
    const double steepest_deg = one_in(&source, 4) ? 72 : 40;
    sheet_view view = {
        .look = scene_default(width_px, height_px),
        .px_per_texel = by_factors(&source, 0.12, 1.4),
        .yaw_deg = between(&source, -steepest_deg, steepest_deg),
        .pitch_deg = between(&source, -steepest_deg, steepest_deg),
        .roll_deg = one_in(&source, 2) ? between(&source, -6, 6) : between(&source, 0, 360),
        .at_x = between(&source, 0, SHEET_SIDE),
        .at_y = between(&source, 0, SHEET_SIDE),
        .paper = between(&source, 110, 240),
        .ink = between(&source, 5, 70),
        .sky = between(&source, 40, 230),
    };
    view.look.seed = random_bits(&source);
    choose_look(&source, &view.look);
    return view;
}

/* ---- The plane ----------------------------------------------------------------------------------------- */

/* Texel (x, y) seen by a pixel: (x / w, y / w); nothing where w is not above 0. */
typedef struct projection {
    double x[3], y[3], w[3];  /* times pixel x, times pixel y, plus */
} projection;

/* A plane at distance 1 from a camera with the focal length of the picture's width: turned by roll, pitch and yaw. */
static projection project(const sheet_view *view)
{
    const direction yaw = direction_of(view->yaw_deg), pitch = direction_of(view->pitch_deg),
                    roll = direction_of(view->roll_deg);
    const double along[3] = {yaw.x * roll.x + yaw.y * pitch.y * roll.y, pitch.x * roll.y,
                             -yaw.y * roll.x + yaw.x * pitch.y * roll.y};
    const double down[3] = {-yaw.x * roll.y + yaw.y * pitch.y * roll.x, pitch.x * roll.x,
                            yaw.y * roll.y + yaw.x * pitch.y * roll.x};
    const double normal[3] = {yaw.y * pitch.x, -pitch.y, yaw.x * pitch.x};
    const double focal_px = view->look.width_px, texels = focal_px / view->px_per_texel;
    const double middle_x = (view->look.width_px - 1) / 2.0, middle_y = (view->look.height_px - 1) / 2.0;
    projection made;
    for (int i = 0; i < 3; i++) {
        const double scale = i < 2 ? 1 / focal_px : 1;
        made.w[i] = scale * normal[i];
        made.x[i] = scale * normal[2] * texels * along[i] + (view->at_x - texels * along[2]) * made.w[i];
        made.y[i] = scale * normal[2] * texels * down[i] + (view->at_y - texels * down[2]) * made.w[i];
    }
    double *const rows[] = {made.x, made.y, made.w};
    for (int i = 0; i < 3; i++)
        rows[i][2] -= rows[i][0] * middle_x + rows[i][1] * middle_y;
    return made;
}

static double value_at(const double row[3], double x_px, double y_px)
{
    return row[0] * x_px + row[1] * y_px + row[2];
}

/* The size of the sheet at which neighbouring pixels are about a texel apart where they are furthest apart. */
static int level_for(double texels_apart)
{
    int level = 0;
    while (level < SHEET_LEVELS - 1 && texels_apart > 1.2) {
        texels_apart /= 2;
        level++;
    }
    return level;
}

/* Places on a sheet in fractions of a texel. */
enum { FRACTION_BITS = 16, WEIGHT_BITS = 8, WEIGHT = 1 << WEIGHT_BITS };

/* From 0 to 255 times WEIGHT squared. */
static uint32_t between_texels(const uint8_t *texels, uint32_t side, uint32_t x, uint32_t y)
{
    const uint32_t mask = side - 1, x0 = x >> FRACTION_BITS & mask, x1 = (x0 + 1) & mask;
    const uint32_t y0 = y >> FRACTION_BITS & mask, y1 = (y0 + 1) & mask;
    const uint32_t u = x >> (FRACTION_BITS - WEIGHT_BITS) & (WEIGHT - 1);
    const uint32_t v = y >> (FRACTION_BITS - WEIGHT_BITS) & (WEIGHT - 1);
    const uint8_t *above = texels + y0 * side, *below = texels + y1 * side;
    return (WEIGHT - v) * ((WEIGHT - u) * above[x0] + u * above[x1]) +
           v * ((WEIGHT - u) * below[x0] + u * below[x1]);
}

/* Pixels in one go: straight and even on the sheet, as good as exactly. */
enum { RUN_PX = 16 };

typedef struct texel_run {
    double x, y, step_x, step_y;
    double texels_apart;
} texel_run;

/* False where the plane's horizon is near. */
static bool find_run(const projection *plane, double x_px, double y_px, texel_run *run)
{
    const double horizon = 1e-3;
    const double near = value_at(plane->w, x_px, y_px), far = value_at(plane->w, x_px + RUN_PX, y_px);
    const double below = value_at(plane->w, x_px, y_px + 1);
    if (near < horizon || far < horizon || below < horizon)
        return false;
    run->x = value_at(plane->x, x_px, y_px) / near;
    run->y = value_at(plane->y, x_px, y_px) / near;
    run->step_x = (value_at(plane->x, x_px + RUN_PX, y_px) / far - run->x) / RUN_PX;
    run->step_y = (value_at(plane->y, x_px + RUN_PX, y_px) / far - run->y) / RUN_PX;
    const double down_x = value_at(plane->x, x_px, y_px + 1) / below - run->x;
    const double down_y = value_at(plane->y, x_px, y_px + 1) / below - run->y;
    run->texels_apart = fmax(length_2d(run->step_x, run->step_y), length_2d(down_x, down_y));
    return run->texels_apart < SHEET_SIDE;
}

/* The light of ink and paper, and of what is beyond the horizon. */
typedef struct plane_light {
    float ink, paper, sky;
} plane_light;

static void paint_run(const sheet *seen, const texel_run *run, const plane_light *light, float *pixels, int count)
{
    const int level = level_for(run->texels_apart);
    const double fractions = (double)(1 << FRACTION_BITS) / (1 << level), turn = SHEET_SIDE;
    const double half = (double)(1 << FRACTION_BITS) / 2;
    uint32_t x = (uint32_t)(int64_t)((run->x - turn * floor(run->x / turn)) * fractions - half);
    uint32_t y = (uint32_t)(int64_t)((run->y - turn * floor(run->y / turn)) * fractions - half);
    const uint32_t step_x = (uint32_t)(int64_t)(run->step_x * fractions);
    const uint32_t step_y = (uint32_t)(int64_t)(run->step_y * fractions);
    const float gain = (light->paper - light->ink) / (255.0f * WEIGHT * WEIGHT);
    for (int i = 0; i < count; i++, x += step_x, y += step_y)
        pixels[i] = light->ink + gain * (float)between_texels(seen->levels[level], SHEET_SIDE >> level, x, y);
}

static void paint_plane(const sheet_view *view, const sheet *seen, canvas *picture)
{
    const projection plane = project(view);
    const double gamma = view->look.sensor.gamma;
    const plane_light light = {(float)light_of_shade(view->ink, gamma), (float)light_of_shade(view->paper, gamma),
                               (float)light_of_shade(view->sky, gamma)};
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x += RUN_PX) {
            const int count = picture->width_px - x < RUN_PX ? picture->width_px - x : RUN_PX;
            texel_run run;
            if (find_run(&plane, x, y, &run))
                paint_run(seen, &run, &light, row + x, count);
            else
                for (int i = 0; i < count; i++)
                    row[x + i] = light.sky;
        }
    }
}

/* ---- The picture --------------------------------------------------------------------------------------- */

static void round_samples(const uint16_t *samples, const scene *look, uint8_t *pixels)
{
    const size_t count = (size_t)look->width_px * (size_t)look->height_px;
    for (size_t i = 0; i < count; i++)
        pixels[i] = (uint8_t)samples[i];
    if (look->sensor.jpeg_quality > 0)
        lose_as_jpeg(pixels, look->width_px, look->height_px, look->sensor.jpeg_quality);
}

bool view_render(const sheet_view *view, const sheet *seen, uint8_t *pixels)
{
    const scene *look = &view->look;
    canvas picture;
    uint16_t *samples = malloc((size_t)look->width_px * (size_t)look->height_px * sizeof *samples);
    bool done = canvas_create(&picture, look->width_px, look->height_px) && samples != NULL;
    if (done) {
        paint_plane(view, seen, &picture);
        apply_light(&look->light, &picture);
        done = apply_optics(&look->optics, &picture) &&
               apply_sensor(&look->sensor, look->seed, 8, &picture, samples);
    }
    if (done)
        round_samples(samples, look, pixels);
    canvas_release(&picture);
    free(samples);
    return done;
}
