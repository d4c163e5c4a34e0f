#include "render_choices.h"

#include <string.h>

static bool ends_in(const char *text, const char *ending)
{
    size_t length = strlen(text), ending_length = strlen(ending);
    return length >= ending_length && strcmp(text + length - ending_length, ending) == 0;
}

static bool choose_output(render_options *all, int operand_count, char *operands[], error_text *error)
{
    bool given = all->output_path != NULL;
    if (operand_count > 1 || (given && operand_count > 0)) {
        error_text_set(error, "one output is enough: '%.80s' is left over", operands[given ? 0 : 1]);
        return false;
    }
    if (!given)
        all->output_path = operands[0];
    if (all->output_path == NULL) {
        error_text_set(error, "no output was given: -o FILE (--help tells more)");
        return false;
    }
    if (all->truth_path != NULL && strcmp(all->truth_path, all->output_path) == 0) {
        error_text_set(error, "--truth: is the same as the output, %.200s", all->truth_path);
        return false;
    }
    return true;
}

static bool choose_format(render_options *all, error_text *error)
{
    static const char *const endings[][2] = {{".pgm", "PGM"}, {".y4m", "Y4M"}, {".png", "PNG"}};
    for (size_t i = 0; i < sizeof endings / sizeof *endings && all->format == NULL; i++) {
        if (ends_in(all->output_path, endings[i][0]))
            all->format = capture_format_find(endings[i][1]);
    }
    if (all->format == NULL) {
        error_text_set(error, "%.200s: ends neither in .pgm nor in .png nor in .y4m: say --format",
                       all->output_path);
        return false;
    }
    if (!capture_fits(all->format, all->view.width_px, all->view.height_px)) {
        error_text_set(error, "--size: %s comes in groups of pixels: sides must be multiples of 4",
                       all->format->name);
        return false;
    }
    if (all->jpeg_quality > 0 && capture_bits(all->format) > 8) {
        error_text_set(error, "--jpeg: %s has more than 8 bits, and JPEG has 8", all->format->name);
        return false;
    }
    return true;
}

static bool choose_stride(render_options *all, error_text *error)
{
    double least = (double)capture_least_stride(all->format, all->view.width_px);
    bool may_be_longer = all->format->container == CAPTURE_HEADERLESS;
    if (all->stride_bytes == 0)
        all->stride_bytes = least;
    if (all->stride_bytes == least || (all->stride_bytes > least && may_be_longer))
        return true;
    error_text_set(error, "--stride: a row of %d px of %s is %s%.0f bytes", (int)all->view.width_px,
                   all->format->name, may_be_longer ? "at least " : "", least);
    return false;
}

/* Which kind of scene the options ask for. */
static bool choose_scene(render_options *all, error_text *error)
{
    size_t placed = 0;
    for (size_t i = 0; i < all->thing_count; i++)
        placed += all->things[i].placed;
    bool camera = all->camera_given || all->path_path != NULL;
    bool on_plan = all->map_path != NULL || placed > 0 || camera;
    const char *problem = NULL;
    if (all->kind == RENDER_WALK && (all->thing_count > 0 || on_plan))
        problem = "--scene walk brings tapes and a way of its own: no --ids, --picture, --map, --camera or --path";
    else if (on_plan && placed < all->thing_count)
        problem = "on a plan, each --ids and --picture needs an --at behind it";
    else if (on_plan && !camera)
        problem = "things on a plan need a --camera or a --path to be seen from";
    else if (on_plan && all->map_path == NULL && placed == 0)
        problem = "--camera and --path need things on a plan: --map, or --ids or --picture with --at";
    else if (all->camera_given && all->path_path != NULL)
        problem = "--camera and --path exclude each other";
    else if (on_plan && (all->pose.px_per_module > 0 || all->distance_m > 0))
        problem = "--px-per-module and --distance are for things in a row; on a plan the camera says where they are";
    else if (all->pose.px_per_module > 0 && all->distance_m > 0)
        problem = "--px-per-module and --distance exclude each other";
    else if (on_plan && (all->pose.yaw_deg != 0 || all->pose.pitch_deg != 0 || all->pose.roll_deg != 0 ||
                         all->pose.dx_px != 0 || all->pose.dy_px != 0))
        problem = "--yaw, --pitch, --roll, --x and --y turn and move a row; on a plan see --at and --camera";
    else if (!on_plan && (all->box_count > 0 || all->furnished))
        problem = "--box and --furnished need a plan: --map, or --ids or --picture with --at";
    else if (all->kind == RENDER_WALK && all->covered_share > 0)
        problem = "--covered is for tapes and pictures that are given, not for --scene walk";
    else if (all->path_path == NULL && all->shutter_s > 0)
        problem = "--shutter needs a --path; without one nothing moves (--motion blurs a still view)";
    else if (all->readout_s > 0 && all->shutter_s == 0)
        problem = "--readout needs a --shutter";
    if (problem != NULL)
        error_text_set(error, "%s", problem);
    if (on_plan)
        all->kind = RENDER_ON_PLAN;
    return problem == NULL;
}

static void fill_in_defaults(render_options *all)
{
    const render_thing usual = {.ids = {7, -8, 9}, .id_count = 3};
    if (all->kind == RENDER_HEAD_ON && all->thing_count == 0)
        all->things[all->thing_count++] = usual;
    if (all->focal_px == 0)
        all->focal_px = all->focal_widths * all->view.width_px;
    if (all->distance_m > 0)
        all->pose.px_per_module = all->focal_px * all->module_m / all->distance_m;
    else if (all->pose.px_per_module == 0)
        all->pose.px_per_module = 3;
    all->view.camera.focal_px = all->focal_px;
    all->view.seed = (uint64_t)all->seed;
    all->view.sensor.sensor_seed = all->view.seed;
    all->view.sensor.jpeg_quality = (int)all->jpeg_quality;
    all->view.covers = all->covers;
    all->view.cover_count = all->cover_count;
}

bool render_choose(render_options *all, int operand_count, char *operands[], error_text *error)
{
    if (!choose_output(all, operand_count, operands, error) || !choose_format(all, error) ||
        !choose_stride(all, error) || !choose_scene(all, error))
        return false;
    fill_in_defaults(all);
    const char *problem = scene_problem(&all->view);
    if (problem != NULL)
        error_text_set(error, "%s", problem);
    return problem == NULL;
}
