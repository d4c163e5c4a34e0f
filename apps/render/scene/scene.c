#include "scene.h"

#include <math.h>
#include <stdlib.h>

#include "background.h"
#include "block_coding.h"
#include "cover.h"
#include "degrade.h"
#include "geometry.h"
#include "tape_paint.h"
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

/* ---- Checking them ------------------------------------------------------------------------------------- */

static bool within(double value, double least, double most)
{
    return value >= least && value <= most;
}

static const char *tape_problem(const scene_tape *tape)
{
    tapemark_word word;
    if (tape->ids == NULL || tape->cm_count == 0)
        return "a tape has no ids";
    if (tape->cm_count > SCENE_CMS_MAX)
        return "a tape has more than 1024 ids";
    for (size_t i = 0; i < tape->cm_count; i++) {
        if (tapemark_word_from_id(tape->ids[i], &word) != TAPEMARK_OK)
            return "an id is out of range, -1505582 to 1505582";
    }
    if (!within(tape->light, 0, 255) || !within(tape->dark, 0, 255))
        return "a tape's shade is out of range, 0 to 255";
    return within(tape->module_m, 1e-6, 1e3) ? NULL : "a tape's module has no size";
}

static const char *tapes_problem(const scene *view)
{
    for (size_t i = 0; i < view->tape_count; i++) {
        const char *problem = tape_problem(&view->tapes[i]);
        if (problem != NULL)
            return problem;
    }
    return NULL;
}

const char *scene_problem(const scene *view)
{
    if (!within(view->width_px, 1, SCENE_SIDE_MAX_PX) || !within(view->height_px, 1, SCENE_SIDE_MAX_PX))
        return "a side of the image is out of range, 1 to 8192 px";
    if (!within(view->camera.focal_px, 1, 1e6))
        return "the focal length is out of range, 1 to 1000000 px";
    if (!within(view->background.kind, 0, SCENE_CLUTTER_COUNT - 1) || !within(view->background.scale_px, 0.1, 1e4))
        return "the background is unknown or its scale is out of range, 0.1 to 10000 px";
    if (!within(view->optics.defocus_px, 0, 70))
        return "the defocus is out of range, 0 to 70 px";
    if (!within(view->optics.motion_px, 0, 120))
        return "the motion is out of range, 0 to 120 px";
    if (!within(view->sensor.exposure, 0, 1e3) || !within(view->sensor.gamma, 0.1, 10))
        return "the exposure is out of range, 0 to 1000, or gamma is, 0.1 to 10";
    if (!within(view->sensor.read_noise, 0, 255) || !within(view->sensor.shot_noise, 0, 255))
        return "the noise is out of range, 0 to 255";
    if (!within(view->sensor.jpeg_quality, 0, 100))
        return "the JPEG quality is out of range, 1 to 100, or 0 for none";
    return tapes_problem(view);
}

/* ---- Rendering ----------------------------------------------------------------------------------------- */

static void shades_to_light(double gamma, canvas *picture)
{
    if (gamma == 1)
        return;
    for (size_t i = 0; i < (size_t)picture->width_px * (size_t)picture->height_px; i++)
        picture->at[i] = (float)light_of_shade((double)picture->at[i], gamma);
}

static bool paint_scene(const scene *view, canvas *picture)
{
    double gamma = view->sensor.gamma;
    if (!paint_background(view, picture))
        return false;
    shades_to_light(gamma, picture);
    for (size_t i = 0; i < view->tape_count; i++) {
        const scene_tape *tape = &view->tapes[i];
        float light = (float)light_of_shade(tape->light, gamma), dark = (float)light_of_shade(tape->dark, gamma);
        if (!paint_tape(view, tape, light, dark, picture))
            return false;
    }
    paint_covers(view, picture);
    apply_light(&view->light, picture);
    return apply_optics(&view->optics, picture);
}

bool scene_render_samples(const scene *view, unsigned bits, uint16_t *samples, scene_truth *truth)
{
    canvas picture;
    if (scene_problem(view) != NULL || bits < 8 || bits > 16)
        return false;
    bool done = canvas_create(&picture, view->width_px, view->height_px) && paint_scene(view, &picture);
    if (done) {
        apply_sensor(&view->sensor, view->seed, bits, &picture, samples);
        if (truth != NULL)
            find_truth(view, truth);
    }
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
