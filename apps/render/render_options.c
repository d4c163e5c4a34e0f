#include "render_options.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char render_usage[] =
    "usage: tapemark-render [OPTION VALUE]... OUTPUT\n"
    "Renders a camera's view of a tape, or of a whole walk past some, into OUTPUT.\n"
    "\n"
    "  --scene frame|walk   one picture of one tape (default), or a cart's way along a wall\n"
    "  --size WxH           of the picture, in px (640x480)\n"
    "  --frames N           pictures of a walk (24)\n"
    "  --format NAME        PGM Y4M GREY Y10 Y10P YUYV UYVY NV12 YU12 SRGGB8 SRGGB10 SRGGB10P;\n"
    "                       by default PGM or Y4M as OUTPUT ends in .pgm or .y4m\n"
    "  --stride BYTES       of a row in headerless formats (as short as can be)\n"
    "  --truth FILE         ids, corners and scales of what is in view, as JSON\n"
    "  --seed N             of noise and random backgrounds (1)\n"
    "\n"
    "The tape of a frame:\n"
    "  --ids LIST           such as 0,-1,2 (7,-8,9)      --bars yes|no        (yes)\n"
    "  --px-per-module PX   head on (3)                  --x PX, --y PX       from the centre (0)\n"
    "  --yaw DEG, --pitch DEG, --roll DEG                right end away, top nearer, clockwise (0)\n"
    "\n"
    "Background of a frame:\n"
    "  --background NAME    plain noise popcorn blinds checkerboard stripes text squares grid-codes finder-rows\n"
    "  --light SHADE, --dark SHADE (160, 60)             --scale PX, --angle DEG (8, 0)\n"
    "\n"
    "Light and camera:\n"
    "  --gradient SHARE, --gradient-angle DEG            over the diagonal (0)\n"
    "  --shadow DEPTH, --shadow-angle DEG, --shadow-offset PX, --shadow-soft PX (0)\n"
    "  --focal PX (width)   --defocus PX (0.5)           --motion PX, --motion-angle DEG (0)\n"
    "  --exposure TIMES (1) --gamma EXPONENT (1)         --noise GRAY, --shot-noise GRAY (1, 2)\n"
    "  --jpeg QUALITY       only for 8-bit formats (none)\n";

static void complain(const char *option, const char *value, const char *right)
{
    fprintf(stderr, "tapemark-render: %s: \"%s\": expected %s\n", option, value, right);
}

static bool parse_number(const char *option, const char *value, double *number)
{
    char *end;
    *number = strtod(value, &end);
    if (end == value || *end != '\0' || *number != *number) {
        complain(option, value, "a number");
        return false;
    }
    return true;
}

static bool parse_size(render_options *all, const char *value)
{
    char *end;
    long width = strtol(value, &end, 10), height = *end == 'x' ? strtol(end + 1, &end, 10) : 0;
    if (*end != '\0' || width < 1 || width > SCENE_SIDE_MAX_PX || height < 1 || height > SCENE_SIDE_MAX_PX) {
        complain("--size", value, "WIDTHxHEIGHT, both 1 to 8192");
        return false;
    }
    all->view.width_px = (int32_t)width;
    all->view.height_px = (int32_t)height;
    return true;
}

static bool parse_ids(render_options *all, const char *value)
{
    const char *at = value;
    for (all->id_count = 0; all->id_count < RENDER_IDS_MAX; at++) {
        char *end;
        errno = 0;
        long id = strtol(at, &end, 10);
        if (end == at || errno != 0 || id < -TAPEMARK_MAX_ID || id > TAPEMARK_MAX_ID)
            break;
        all->ids[all->id_count++] = (int32_t)id;
        at = end;
        if (*at == '\0')
            return true;
        if (*at != ',')
            break;
    }
    complain("--ids", value, "up to 64 numbers from -1505582 to 1505582 with commas between them");
    return false;
}

static bool parse_choice(const char *option, const char *value, const char *const *names, size_t count,
                         size_t *choice)
{
    for (*choice = 0; *choice < count; ++*choice) {
        if (strcmp(names[*choice], value) == 0)
            return true;
    }
    fprintf(stderr, "tapemark-render: %s: \"%s\": expected one of", option, value);
    for (size_t i = 0; i < count; i++)
        fprintf(stderr, " %s", names[i]);
    fputc('\n', stderr);
    return false;
}

static bool parse_named(render_options *all, const char *option, const char *value)
{
    static const char *const backgrounds[SCENE_CLUTTER_COUNT] = {
        "plain", "noise", "popcorn", "blinds", "checkerboard", "stripes", "text", "squares", "grid-codes",
        "finder-rows", "room"};
    static const char *const scenes[] = {"frame", "walk"}, *const answers[] = {"no", "yes"};
    size_t choice;
    if (strcmp(option, "--background") == 0) {
        if (!parse_choice(option, value, backgrounds, SCENE_CLUTTER_COUNT, &choice))
            return false;
        all->view.background.kind = (scene_clutter)choice;
    } else if (strcmp(option, "--scene") == 0) {
        if (!parse_choice(option, value, scenes, 2, &choice))
            return false;
        all->walk = choice == 1;
    } else {
        if (!parse_choice(option, value, answers, 2, &choice))
            return false;
        all->bars = choice == 1;
    }
    return true;
}

static bool parse_format(render_options *all, const char *value)
{
    all->format = capture_format_find(value);
    if (all->format == NULL)
        fprintf(stderr, "tapemark-render: --format: \"%s\": expected one of %s\n", value, capture_format_names());
    return all->format != NULL;
}

/* A place for the number of an option; NULL when there is no such option. */
static double *number_of(render_options *all, const char *option)
{
    const struct {
        const char *name;
        double *number;
    } numbers[] = {
        {"--angle", &all->view.background.angle_deg},
        {"--dark", &all->view.background.dark},
        {"--defocus", &all->view.optics.defocus_px},
        {"--exposure", &all->view.sensor.exposure},
        {"--focal", &all->focal_px},
        {"--frames", &all->frame_count},
        {"--gamma", &all->view.sensor.gamma},
        {"--gradient", &all->view.light.gradient},
        {"--gradient-angle", &all->view.light.gradient_deg},
        {"--jpeg", &all->jpeg_quality},
        {"--light", &all->view.background.light},
        {"--motion", &all->view.optics.motion_px},
        {"--motion-angle", &all->view.optics.motion_deg},
        {"--noise", &all->view.sensor.read_noise},
        {"--pitch", &all->pose.pitch_deg},
        {"--px-per-module", &all->pose.px_per_module},
        {"--roll", &all->pose.roll_deg},
        {"--scale", &all->view.background.scale_px},
        {"--seed", &all->seed},
        {"--shadow", &all->view.light.shadow_depth},
        {"--shadow-angle", &all->view.light.shadow_deg},
        {"--shadow-offset", &all->view.light.shadow_offset_px},
        {"--shadow-soft", &all->view.light.shadow_soft_px},
        {"--shot-noise", &all->view.sensor.shot_noise},
        {"--stride", &all->stride_bytes},
        {"--x", &all->pose.dx_px},
        {"--y", &all->pose.dy_px},
        {"--yaw", &all->pose.yaw_deg},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (strcmp(numbers[i].name, option) == 0)
            return numbers[i].number;
    }
    return NULL;
}

static bool parse_option(render_options *all, const char *option, const char *value)
{
    double *number = number_of(all, option);
    if (number != NULL)
        return parse_number(option, value, number);
    if (strcmp(option, "--size") == 0)
        return parse_size(all, value);
    if (strcmp(option, "--ids") == 0)
        return parse_ids(all, value);
    if (strcmp(option, "--format") == 0)
        return parse_format(all, value);
    if (strcmp(option, "--scene") == 0 || strcmp(option, "--background") == 0 || strcmp(option, "--bars") == 0)
        return parse_named(all, option, value);
    if (strcmp(option, "--truth") == 0) {
        all->truth_path = value;
        return true;
    }
    fprintf(stderr, "tapemark-render: %s: no such option; see tapemark-render --help\n", option);
    return false;
}

static bool ends_in(const char *text, const char *ending)
{
    size_t length = strlen(text), ending_length = strlen(ending);
    return length >= ending_length && strcmp(text + length - ending_length, ending) == 0;
}

static bool whole_within(const char *option, double value, double least, double most)
{
    if (value >= least && value <= most && value == (double)(int64_t)value)
        return true;
    fprintf(stderr, "tapemark-render: %s: expected a whole number from %.0f to %.0f\n", option, least, most);
    return false;
}

static bool choose_format(render_options *all)
{
    if (all->format == NULL && ends_in(all->output_path, ".pgm"))
        all->format = capture_format_find("PGM");
    if (all->format == NULL && ends_in(all->output_path, ".y4m"))
        all->format = capture_format_find("Y4M");
    if (all->format == NULL)
        fprintf(stderr, "tapemark-render: %s: ends neither in .pgm nor in .y4m: say --format\n", all->output_path);
    return all->format != NULL;
}

static bool choose_stride(render_options *all)
{
    double least = (double)capture_least_stride(all->format, all->view.width_px);
    bool may_be_longer = all->format->container == CAPTURE_HEADERLESS;
    if (all->stride_bytes == 0)
        all->stride_bytes = least;
    if (all->stride_bytes == least || (all->stride_bytes > least && may_be_longer))
        return true;
    fprintf(stderr, "tapemark-render: --stride: a row of %d px of %s is %s%.0f bytes\n", (int)all->view.width_px,
            all->format->name, may_be_longer ? "at least " : "", least);
    return false;
}

/* What can only be said when all options are known. */
static bool complete(render_options *all)
{
    if (!choose_format(all) || !whole_within("--frames", all->frame_count, 1, 100000) ||
        !whole_within("--seed", all->seed, 0, 1e15) || !whole_within("--jpeg", all->jpeg_quality, 0, 100) ||
        !whole_within("--stride", all->stride_bytes, 0, 1e6) || !choose_stride(all))
        return false;
    if (!capture_fits(all->format, all->view.width_px, all->view.height_px)) {
        fprintf(stderr, "tapemark-render: --size: %s comes in groups of pixels: sides must be multiples of 4\n",
                all->format->name);
        return false;
    }
    if (!all->walk && !(all->pose.px_per_module > 0.01 && all->pose.px_per_module < 1e4)) {
        fputs("tapemark-render: --px-per-module: expected 0.01 to 10000\n", stderr);
        return false;
    }
    all->view.seed = (uint64_t)all->seed;
    all->view.sensor.jpeg_quality = (int)all->jpeg_quality;
    all->view.camera.focal_px = all->focal_px == 0 ? all->view.width_px : all->focal_px;
    const char *problem = scene_problem(&all->view);
    if (problem != NULL)
        fprintf(stderr, "tapemark-render: %s\n", problem);
    return problem == NULL;
}

bool render_options_parse(render_options *all, int argc, char **argv)
{
    *all = (render_options){.view = scene_default(640, 480), .pose = {.px_per_module = 3}, .ids = {7, -8, 9},
                            .id_count = 3, .bars = true, .frame_count = 24, .seed = 1};
    int at = 1;
    for (; at + 1 < argc && argv[at][0] == '-'; at += 2) {
        if (!parse_option(all, argv[at], argv[at + 1]))
            return false;
    }
    if (at != argc - 1 || argv[at][0] == '-') {
        fputs("tapemark-render: expected options, each with a value, and one OUTPUT; see tapemark-render --help\n", stderr);
        return false;
    }
    all->output_path = argv[at];
    return complete(all);
}
