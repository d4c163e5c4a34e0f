/* What keeps a scene from being rendered. Numbers that are not numbers are out of every range. */
#include <math.h>
#include <stddef.h>

#include "optics.h"
#include "patterns.h"
#include "scene.h"

static bool within(double value, double least, double most)
{
    return value >= least && value <= most;
}

static bool is_angle(double angle_deg)
{
    return within(angle_deg, -1e6, 1e6);
}

static bool is_shade(double shade)
{
    return within(shade, 0, 255);
}

static bool is_place(scene_vector place_m)
{
    return within(place_m.x, -1e5, 1e5) && within(place_m.y, -1e5, 1e5) && within(place_m.z, -1e5, 1e5);
}

static double product(scene_vector a, scene_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static bool are_directions(scene_vector along, scene_vector down)
{
    const double slack = 1e-3;
    return within(product(along, along), 1 - slack, 1 + slack) && within(product(down, down), 1 - slack, 1 + slack) &&
           within(product(along, down), -slack, slack);
}

/* ---- Things -------------------------------------------------------------------------------------------- */

static const char *panel_problem(const scene_panel *panel)
{
    if (!is_place(panel->origin_m) || !are_directions(panel->along, panel->down))
        return "a panel is too far away, or its directions are not at a right angle";
    if (!within(panel->width_m, 1e-4, 1e5) || !within(panel->height_m, 1e-4, 1e5))
        return "a panel's size is out of range, 0.0001 to 100000 m";
    if (!within(panel->look, 0, SCENE_LOOK_COUNT - 1) || !is_shade(panel->light) || !is_shade(panel->dark))
        return "a panel's look is unknown, or its shade is out of range, 0 to 255";
    if (!within(panel->scale_m, 1e-3, 1e3))
        return "the scale of a panel's look is out of range, 0.001 to 1000 m";
    if (panel->look == SCENE_LOOK_PATTERN && module_pattern_of(panel->pattern) == NULL)
        return "a panel's pattern is not made of modules";
    return NULL;
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
    if (!is_shade(tape->light) || !is_shade(tape->dark))
        return "a tape's shade is out of range, 0 to 255";
    if (!within(tape->module_m, 1e-6, 1e3))
        return "a tape's module has no size";
    if (!is_place(tape->origin_m) || !are_directions(tape->along, tape->down))
        return "a tape is too far away, or its directions are not at a right angle";
    return NULL;
}

static const char *picture_problem(const scene_picture *picture)
{
    if (picture->texels == NULL || !within(picture->columns, 1, SCENE_SIDE_MAX_PX) ||
        !within(picture->rows, 1, SCENE_SIDE_MAX_PX))
        return "a side of a picture is out of range, 1 to 8192 texels";
    if (!within(picture->width_m, 1e-6, 1e4) || !within(picture->height_m, 1e-6, 1e4) ||
        !within(picture->module_m, 1e-9, 1e4))
        return "a picture's size, or that of its module, is out of range, up to 10000 m";
    if (!within(picture->border_m, 0, 1e4) || !is_shade(picture->border_shade))
        return "a picture's border is out of range, 0 to 10000 m, or its shade is, 0 to 255";
    if (!is_place(picture->origin_m) || !are_directions(picture->along, picture->down))
        return "a picture is too far away, or its directions are not at a right angle";
    return NULL;
}

static const char *cover_problem(const scene_cover *cover)
{
    if (!within(cover->x_px, -1e6, 1e6) || !within(cover->y_px, -1e6, 1e6) || !within(cover->width_px, 0, 1e6) ||
        !within(cover->height_px, 0, 1e6) || !is_angle(cover->angle_deg))
        return "a cover's place or size is out of range, up to 1000000 px";
    if (!is_shade(cover->shade) || !is_shade(cover->texture))
        return "a cover's shade or texture is out of range, 0 to 255";
    return NULL;
}

static const char *things_problem(const scene *view)
{
    const char *problem = NULL;
    for (size_t i = 0; i < view->panel_count && problem == NULL; i++)
        problem = panel_problem(&view->panels[i]);
    for (size_t i = 0; i < view->tape_count && problem == NULL; i++)
        problem = tape_problem(&view->tapes[i]);
    for (size_t i = 0; i < view->picture_count && problem == NULL; i++)
        problem = picture_problem(&view->pictures[i]);
    for (size_t i = 0; i < view->cover_count && problem == NULL; i++)
        problem = cover_problem(&view->covers[i]);
    return problem;
}

/* ---- How they are seen --------------------------------------------------------------------------------- */

static const char *background_problem(const scene_background *background)
{
    if (!within(background->kind, 0, SCENE_CLUTTER_COUNT - 1) || !within(background->scale_px, 0.1, 1e4))
        return "the background is unknown or its scale is out of range, 0.1 to 10000 px";
    if (!is_shade(background->light) || !is_shade(background->dark) || !is_angle(background->angle_deg))
        return "a shade of the background is out of range, 0 to 255, or its angle is";
    if (!within(background->room.wall_z_m, -1e5, 1e5) || !within(background->room.floor_y_m, -1e5, 1e5))
        return "the wall or the floor of the room is too far away, beyond 100000 m";
    return NULL;
}

static const char *camera_problem(const scene_camera *camera, const scene_move *move)
{
    if (!within(camera->focal_px, 1, 1e6))
        return "the focal length is out of range, 1 to 1000000 px";
    if (!is_place(camera->position_m) || !is_angle(camera->yaw_deg) || !is_angle(camera->pitch_deg) ||
        !is_angle(camera->roll_deg))
        return "the camera is too far away, beyond 100000 m, or an angle of it is out of range";
    if (!is_place(move->by_m) || !within(move->yaw_deg, -90, 90) || !within(move->pitch_deg, -90, 90) ||
        !within(move->roll_deg, -90, 90))
        return "the camera turns by more than 90 degrees during the exposure, or moves too far";
    return within(move->readout, 0, 1e3) ? NULL : "the readout is out of range, 0 to 1000 exposures";
}

static const char *light_problem(const scene_light *light)
{
    if (!within(light->gradient, -10, 10) || !is_angle(light->gradient_deg))
        return "the gradient is out of range, -10 to 10, or its angle is";
    if (!within(light->shadow_depth, 0, 1) || !is_angle(light->shadow_deg) ||
        !within(light->shadow_offset_px, -1e6, 1e6) || !within(light->shadow_soft_px, 0, 1e6))
        return "the shadow's depth is out of range, 0 to 1, or its edge is, up to 1000000 px";
    if (!within(light->vignetting, 0, 0.99) || !within(light->vignetting_px, 0, 1e6))
        return "the vignetting is out of range, 0 to 0.99, or its distance is, 0 to 1000000 px";
    return NULL;
}

static const char *optics_problem(const scene_optics *optics)
{
    if (!within(optics->defocus_px, 0, 70))
        return "the defocus is out of range, 0 to 70 px";
    if (!within(optics->motion_px, 0, 120) || !is_angle(optics->motion_deg))
        return "the motion is out of range, 0 to 120 px, or its angle is";
    return within(optics->disc_px, 0, DISC_MAX_PX) ? NULL : "the disc is out of range, 0 to 32 px";
}

static const char *sensor_problem(const scene_sensor *sensor)
{
    if (!within(sensor->exposure, 0, 1e3) || !within(sensor->gamma, 0.1, 10))
        return "the exposure is out of range, 0 to 1000, or gamma is, 0.1 to 10";
    if (!within(sensor->read_noise, 0, 255) || !within(sensor->shot_noise, 0, 255) ||
        !within(sensor->pixel_noise, 0, 255) || !within(sensor->column_noise, 0, 255))
        return "the noise is out of range, 0 to 255";
    if (!within(sensor->bloom, 0, 1) || !within(sensor->bloom_px, 0, 70))
        return "the bloom is out of range, 0 to 1, or its width is, 0 to 70 px";
    if (!within(sensor->jpeg_quality, 0, 100))
        return "the JPEG quality is out of range, 1 to 100, or 0 for none";
    return NULL;
}

const char *scene_problem(const scene *view)
{
    if (!within(view->width_px, 1, SCENE_SIDE_MAX_PX) || !within(view->height_px, 1, SCENE_SIDE_MAX_PX))
        return "a side of the image is out of range, 1 to 8192 px";
    const char *problem = background_problem(&view->background);
    problem = problem != NULL ? problem : camera_problem(&view->camera, &view->move);
    problem = problem != NULL ? problem : light_problem(&view->light);
    problem = problem != NULL ? problem : optics_problem(&view->optics);
    problem = problem != NULL ? problem : sensor_problem(&view->sensor);
    return problem != NULL ? problem : things_problem(view);
}
