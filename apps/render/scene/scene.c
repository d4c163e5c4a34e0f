#include "scene.h"

#include <stdlib.h>

#include "block_coding.h"
#include "cover.h"
#include "exposure.h"
#include "light.h"
#include "optics.h"
#include "sensor.h"
#include "truth.h"

/* ---- Making scenes ------------------------------------------------------------------------------------- */

scene scene_ideal(int32_t width_px, int32_t height_px)
{
    return (scene){
        .width_px = width_px,
        .height_px = height_px,
        .seed = 1,
        .background = {.kind = SCENE_PLAIN, .light = 160, .dark = 60, .scale_px = 8},
        .camera = {.focal_px = width_px},
        .sensor = {.exposure = 1, .gamma = 1},
    };
}

scene scene_default(int32_t width_px, int32_t height_px)
{
    scene view = scene_ideal(width_px, height_px);
    view.optics.defocus_px = 0.5;
    view.sensor.read_noise = 1;
    view.sensor.shot_noise = 2;
    return view;
}

scene_tape scene_tape_of(const int32_t *ids, size_t cm_count, bool bars)
{
    return (scene_tape){
        .ids = ids,
        .cm_count = cm_count,
        .bars = bars,
        .light = 190,
        .dark = 32,
        .module_m = 0.06 / TAPEMARK_HEIGHT_MODULES,
        .origin_m = {0, 0, 1},
        .along = {1, 0, 0},
        .down = {0, 1, 0},
    };
}

/* ---- Rendering ----------------------------------------------------------------------------------------- */

static bool paint_scene(const scene *view, canvas *picture)
{
    if (!paint_exposure(view, picture))
        return false;
    paint_covers(view, picture);
    apply_light(&view->light, picture);
    return apply_optics(&view->optics, picture);
}

bool scene_render_samples(const scene *view, unsigned bits, uint16_t *samples, scene_truth *truth)
{
    canvas picture;
    if (scene_problem(view) != NULL || bits < 8 || bits > 16)
        return false;
    bool done = canvas_create(&picture, view->width_px, view->height_px) && paint_scene(view, &picture) &&
                (truth == NULL || find_truth(view, truth)) &&
                apply_sensor(&view->sensor, view->seed, bits, &picture, samples);
    canvas_release(&picture);
    return done;
}

bool scene_render(const scene *view, uint8_t *pixels, scene_truth *truth)
{
    size_t count = (size_t)view->width_px * (size_t)view->height_px;
    uint16_t *samples = scene_problem(view) == NULL ? malloc(count * sizeof *samples) : NULL;
    bool done = samples != NULL && scene_render_samples(view, 8, samples, truth);
    for (size_t i = 0; done && i < count; i++)
        pixels[i] = (uint8_t)samples[i];
    free(samples);
    if (done && view->sensor.jpeg_quality > 0)
        lose_as_jpeg(pixels, view->width_px, view->height_px, view->sensor.jpeg_quality);
    return done;
}
