#include "render_options.h"

#include <getopt.h>
#include <stdlib.h>

#include "option_mistake.h"
#include "option_values.h"
#include "render_choices.h"
#include "thing_options.h"

/* ---- How it is seen ------------------------------------------------------------------------------------ */

static bool take_scene(render_options *all, const char *text, error_text *error)
{
    static const char *const names[] = {"frame", "walk"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    all->kind = choice == 1 ? RENDER_WALK : RENDER_HEAD_ON;
    return true;
}

static bool take_camera(render_options *all, const char *text, error_text *error)
{
    double place[6] = {0};
    if (!parse_numbers(text, 4, 6, place, "X,Y,HEIGHT,HEADING[,PITCH[,ROLL]] in metres and degrees", error))
        return false;
    all->camera_given = true;
    all->camera = (camera_waypoint){.x_m = place[0], .y_m = place[1], .height_m = place[2], .heading_deg = place[3],
                                    .pitch_deg = place[4], .roll_deg = place[5]};
    const char *problem = camera_waypoint_problem(&all->camera);
    if (problem != NULL)
        error_text_set(error, "%s", problem);
    return problem == NULL;
}

static bool take_path(render_options *all, const char *text, error_text *error)
{
    (void)error;
    all->path_path = text;
    return true;
}

/* What was measured on the video of the marker's inventors, see tests/render/test_condition_a.cpp. */
static bool take_like(render_options *all, const char *text, error_text *error)
{
    static const char *const names[] = {"condition-a"};
    size_t choice;
    if (!parse_choice(text, names, 1, &choice, error))
        return false;
    all->paper = 203;
    all->ink = 22;
    all->focal_widths = 1.37;
    all->view.optics.defocus_px = 0.56;
    all->view.sensor.read_noise = 0.25;
    all->view.sensor.shot_noise = 0;
    return true;
}

/* ---- Output -------------------------------------------------------------------------------------------- */

static bool take_size(render_options *all, const char *text, error_text *error)
{
    return parse_size(text, SCENE_SIDE_MAX_PX, &all->view.width_px, &all->view.height_px, error);
}

static bool take_format(render_options *all, const char *text, error_text *error)
{
    all->format = capture_format_find(text);
    if (all->format == NULL)
        error_text_set(error, "expected one of %s, not \"%.40s\"", capture_format_names(), text);
    return all->format != NULL;
}

static bool take_truth(render_options *all, const char *text, error_text *error)
{
    (void)error;
    all->truth_path = text;
    return true;
}

static bool take_output(render_options *all, const char *text, error_text *error)
{
    (void)error;
    all->output_path = text;
    return true;
}

/* ---- All options --------------------------------------------------------------------------------------- */

/* An option has a number of its own, or its value is taken by a function. */
typedef struct known_option {
    const char *name;
    bool (*take)(render_options *all, const char *text, error_text *error);
    size_t offset;
    value_range range;
} known_option;

#define TAKEN(name, take) {name, take, 0, {VALUE_NUMBER, 0, 0}}
#define NUMBER(name, member, kind, least, most) {name, NULL, offsetof(render_options, member), {kind, least, most}}

static const known_option known_options[] = {
    TAKEN("ids", take_ids),
    TAKEN("picture", take_picture),
    TAKEN("at", take_place),
    TAKEN("map", take_map),
    TAKEN("bars", take_bars),
    TAKEN("cover", take_cover),
    TAKEN("box", take_box),
    TAKEN("furnished", take_furnished),
    TAKEN("background", take_background),
    TAKEN("wall", take_wall),
    TAKEN("floor", take_floor),
    TAKEN("scene", take_scene),
    TAKEN("camera", take_camera),
    TAKEN("path", take_path),
    TAKEN("like", take_like),
    TAKEN("size", take_size),
    TAKEN("format", take_format),
    TAKEN("truth", take_truth),
    TAKEN("output", take_output),
    NUMBER("module", module_m, VALUE_LENGTH, 1e-5, 10),
    NUMBER("paper", paper, VALUE_NUMBER, 0, 255),
    NUMBER("ink", ink, VALUE_NUMBER, 0, 255),
    NUMBER("gap", gap_m, VALUE_LENGTH, 0, 1000),
    NUMBER("border", border_m, VALUE_LENGTH, 0, 10),
    NUMBER("wall-height", wall_height_m, VALUE_LENGTH, 0.01, 100),
    NUMBER("covered", covered_share, VALUE_NUMBER, 0, 1),
    NUMBER("px-per-module", pose.px_per_module, VALUE_NUMBER, 0.01, 1e4),
    NUMBER("distance", distance_m, VALUE_LENGTH, 0.001, 10000),
    NUMBER("yaw", pose.yaw_deg, VALUE_NUMBER, -360, 360),
    NUMBER("pitch", pose.pitch_deg, VALUE_NUMBER, -360, 360),
    NUMBER("roll", pose.roll_deg, VALUE_NUMBER, -360, 360),
    NUMBER("x", pose.dx_px, VALUE_NUMBER, -1e5, 1e5),
    NUMBER("y", pose.dy_px, VALUE_NUMBER, -1e5, 1e5),
    NUMBER("focal", focal_px, VALUE_NUMBER, 1, 1e6),
    NUMBER("fps", fps, VALUE_NUMBER, 0.001, 10000),
    NUMBER("shutter", shutter_s, VALUE_TIME, 0, 10),
    NUMBER("readout", readout_s, VALUE_TIME, 0, 10),
    NUMBER("frames", frame_count, VALUE_WHOLE, 1, 100000),
    NUMBER("light", view.background.light, VALUE_NUMBER, 0, 255),
    NUMBER("dark", view.background.dark, VALUE_NUMBER, 0, 255),
    NUMBER("scale", view.background.scale_px, VALUE_NUMBER, 0.1, 1e4),
    NUMBER("angle", view.background.angle_deg, VALUE_NUMBER, -360, 360),
    NUMBER("gradient", view.light.gradient, VALUE_NUMBER, 0, 2),
    NUMBER("gradient-angle", view.light.gradient_deg, VALUE_NUMBER, -360, 360),
    NUMBER("shadow", view.light.shadow_depth, VALUE_NUMBER, 0, 1),
    NUMBER("shadow-angle", view.light.shadow_deg, VALUE_NUMBER, -360, 360),
    NUMBER("shadow-offset", view.light.shadow_offset_px, VALUE_NUMBER, -1e5, 1e5),
    NUMBER("shadow-soft", view.light.shadow_soft_px, VALUE_NUMBER, 0, 1e5),
    NUMBER("vignetting", view.light.vignetting, VALUE_NUMBER, 0, 0.99),
    NUMBER("defocus", view.optics.defocus_px, VALUE_NUMBER, 0, 70),
    NUMBER("disc", view.optics.disc_px, VALUE_NUMBER, 0, 70),
    NUMBER("motion", view.optics.motion_px, VALUE_NUMBER, 0, 120),
    NUMBER("motion-angle", view.optics.motion_deg, VALUE_NUMBER, -360, 360),
    NUMBER("exposure", view.sensor.exposure, VALUE_NUMBER, 0, 1000),
    NUMBER("gamma", view.sensor.gamma, VALUE_NUMBER, 0.1, 10),
    NUMBER("bloom", view.sensor.bloom, VALUE_NUMBER, 0, 1),
    NUMBER("bloom-size", view.sensor.bloom_px, VALUE_NUMBER, 0, 70),
    NUMBER("noise", view.sensor.read_noise, VALUE_NUMBER, 0, 255),
    NUMBER("shot-noise", view.sensor.shot_noise, VALUE_NUMBER, 0, 255),
    NUMBER("pixel-noise", view.sensor.pixel_noise, VALUE_NUMBER, 0, 255),
    NUMBER("column-noise", view.sensor.column_noise, VALUE_NUMBER, 0, 255),
    NUMBER("jpeg", jpeg_quality, VALUE_WHOLE, 1, 100),
    NUMBER("seed", seed, VALUE_WHOLE, 0, 1e15),
    NUMBER("stride", stride_bytes, VALUE_WHOLE, 1, 1e6),
};

enum { KNOWN_OPTIONS = sizeof known_options / sizeof *known_options, FIRST_CODE = 256,
       CODE_HELP = FIRST_CODE + KNOWN_OPTIONS, CODE_VERSION };

static bool apply_option(render_options *all, const known_option *option, const char *text, error_text *error)
{
    error_text reason;
    bool done = option->take != NULL
                    ? option->take(all, text, &reason)
                    : parse_value(text, option->range, (double *)(void *)((char *)all + option->offset), &reason);
    if (!done)
        error_text_set(error, "--%s: %s", option->name, reason.text);
    return done;
}

static void list_options(struct option *list)
{
    for (int i = 0; i < KNOWN_OPTIONS; i++)
        list[i] = (struct option){known_options[i].name, required_argument, NULL, FIRST_CODE + i};
    list[KNOWN_OPTIONS] = (struct option){"help", no_argument, NULL, CODE_HELP};
    list[KNOWN_OPTIONS + 1] = (struct option){"version", no_argument, NULL, CODE_VERSION};
    list[KNOWN_OPTIONS + 2] = (struct option){0};
}

static options_answer take_options(render_options *all, int argc, char *argv[], error_text *error)
{
    struct option list[KNOWN_OPTIONS + 3];
    list_options(list);
    opterr = 0;
    optind = 0;  /* anew, also in the middle of a word that an earlier call stopped at */
    for (int code; (code = getopt_long(argc, argv, ":o:", list, NULL)) != -1;) {
        if (code == CODE_HELP)
            return OPTIONS_HELP;
        if (code == CODE_VERSION)
            return OPTIONS_VERSION;
        if (option_is_mistake(code, argv, error))
            return OPTIONS_WRONG;
        if (code == 'o')
            all->output_path = optarg;
        else if (!apply_option(all, &known_options[code - FIRST_CODE], optarg, error))
            return OPTIONS_WRONG;
    }
    return OPTIONS_RUN;
}

/* ---- The command line ---------------------------------------------------------------------------------- */

options_answer render_options_parse(int argc, char *argv[], render_options *all, error_text *error)
{
    *all = (render_options){
        .view = scene_default(640, 480),
        .bars = RENDER_BARS_OF_TMS,
        .module_m = 0.06 / TAPEMARK_HEIGHT_MODULES,
        .paper = 190,
        .ink = 32,
        .gap_m = 0.06,
        .wall_height_m = 2.5,
        .wall = {.look = SCENE_LOOK_PAINT},
        .floor = {.look = SCENE_LOOK_WOOD},
        .focal_widths = 1,
        .fps = 12,
        .seed = 1,
    };
    options_answer answer = take_options(all, argc, argv, error);
    if (answer != OPTIONS_RUN)
        return answer;
    return render_choose(all, argc - optind, argv + optind, error) ? OPTIONS_RUN : OPTIONS_WRONG;
}

void render_options_release(render_options *all)
{
    for (size_t i = 0; i < all->thing_count; i++)
        free(all->things[i].picture_name);
}
