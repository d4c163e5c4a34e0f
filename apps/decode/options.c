#include "options.h"

#include "option_mistake.h"
#include "option_values.h"

#include <getopt.h>

const char options_help[] =
    "usage: tapemark-decode [OPTION...] INPUT...\n"
    "Reads tape-shaped fiducial markers in pictures, videos and raw captures.\n"
    "\n"
    "INPUT is a picture (PGM, PNG, JPEG and others), a video (Y4M, MP4 and others), a headerless capture (with\n"
    "--raw), a directory, whose pictures and videos are read in the order of their names, or - for standard\n"
    "input (pictures, Y4M, Motion JPEG, raw).\n"
    "\n"
    "  --format FORMAT      jsonl (default): a JSON object a frame; csv: a row a marker; text: a line a marker\n"
    "  --raw LAYOUT         INPUTs are frames without headers; LAYOUT is FORMAT:WIDTHxHEIGHT[:STRIDE], with the\n"
    "                       stride of the first plane in bytes. FORMAT is GREY, Y10, Y12, Y16, Y10P, YUYV, UYVY,\n"
    "                       NV12, YU12 or Bayer, SRGGB8, SRGGB10, SRGGB10P (also SGRBG.., SGBRG.., SBGGR..). In a\n"
    "                       directory, names that end in .raw, .bin, .yuv or the format are read so\n"
    "  --map FILE           the map of the tape: reads only ids that are on it, adds each marker's place on the\n"
    "                       plan in metres and its direction, says whether tape and code markers agree\n"
    "  --annotate DIR       writes each frame as PNG into DIR, with what was seen drawn in: finder patterns in\n"
    "                       blue, code markers in green with their ids, tape markers in orange with their codes\n"
    "\n"
    "  --roll DEG           upright tapes read in this direction, clockwise from the x axis of the image; helps\n"
    "                       where markers are too small to show which way is up\n"
    "  --inverted           the tape is printed light on dark\n"
    "  --vote-min SHARE     of scan lines that must agree on a tape marker, above 0.5 to 1 (default 0.7)\n"
    "  --confidence-min C   leaves out code markers read with less confidence, 0 to 1\n"
    "  --max-id N           the largest id in use, without its sign: surer readings than with all 1505582\n"
    "  --budget N           pixel reads allowed for a frame after the first pass; bounds the slowest frame\n"
    "\n"
    "  --help, --version    print this text or the version\n"
    "\n"
    "Output goes to standard output, a line at a time; errors and a summary go to standard error. \"source\" is the\n"
    "last component of the INPUT's path, or the whole path where several INPUTs share that component.\n"
    "Exit status: 0 all frames of all inputs were decoded (with markers in them or not); 1 an input or the map\n"
    "could not be read wholly, or output could not be written; 2 wrong usage.\n";

static bool parse_real(const char *text, double least, double most, float *value, error_text *error)
{
    double number;
    if (!parse_value(text, (value_range){VALUE_NUMBER, least, most}, &number, error))
        return false;
    *value = (float)number;
    return true;
}

static bool parse_whole(const char *text, uint32_t most, uint32_t *value, error_text *error)
{
    double number;
    if (!parse_value(text, (value_range){VALUE_WHOLE, 1, most}, &number, error))
        return false;
    *value = (uint32_t)number;
    return true;
}

static bool parse_format(const char *text, report_format *format, error_text *error)
{
    static const char *const names[] = {[REPORT_JSONL] = "jsonl", [REPORT_CSV] = "csv", [REPORT_TEXT] = "text"};
    size_t choice;
    if (!parse_choice(text, names, sizeof names / sizeof *names, &choice, error))
        return false;
    *format = (report_format)choice;
    return true;
}

static bool parse_raw(const char *text, decode_options *options, error_text *error)
{
    options->raw_given = true;
    return frame_layout_parse(text, &options->raw, error);
}

enum option_code {
    OPTION_MAP = 256,
    OPTION_RAW,
    OPTION_ANNOTATE,
    OPTION_FORMAT,
    OPTION_ROLL,
    OPTION_INVERTED,
    OPTION_VOTE_MIN,
    OPTION_CONFIDENCE_MIN,
    OPTION_MAX_ID,
    OPTION_BUDGET,
    OPTION_HELP,
    OPTION_VERSION
};

static const struct option long_options[] = {
    {"map", required_argument, NULL, OPTION_MAP},
    {"raw", required_argument, NULL, OPTION_RAW},
    {"annotate", required_argument, NULL, OPTION_ANNOTATE},
    {"format", required_argument, NULL, OPTION_FORMAT},
    {"roll", required_argument, NULL, OPTION_ROLL},
    {"inverted", no_argument, NULL, OPTION_INVERTED},
    {"vote-min", required_argument, NULL, OPTION_VOTE_MIN},
    {"confidence-min", required_argument, NULL, OPTION_CONFIDENCE_MIN},
    {"max-id", required_argument, NULL, OPTION_MAX_ID},
    {"budget", required_argument, NULL, OPTION_BUDGET},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {NULL, 0, NULL, 0},
};

/* The settings of the decoder. */
static bool apply_setting(int code, const char *argument, tapemark_config *config, error_text *error)
{
    uint32_t number;
    switch (code) {
    case OPTION_ROLL:
        config->roll_known = true;
        return parse_real(argument, -360, 360, &config->roll_deg, error);
    case OPTION_INVERTED:
        config->polarity = TAPEMARK_LIGHT_ON_DARK;
        return true;
    case OPTION_VOTE_MIN:
        return parse_real(argument, 0.501, 1, &config->vote_min, error);
    case OPTION_CONFIDENCE_MIN:
        return parse_real(argument, 0, 1, &config->confidence_min, error);
    case OPTION_MAX_ID:
        if (!parse_whole(argument, TAPEMARK_MAX_ID, &number, error))
            return false;
        config->id_max = (int32_t)number;
        return true;
    default:
        return parse_whole(argument, UINT32_MAX, &config->work_budget, error);
    }
}

static const char *option_name(int code)
{
    const struct option *option = long_options;
    while (option->val != code)
        option++;
    return option->name;
}

static bool take_option(int code, char *argument, decode_options *options, error_text *error)
{
    switch (code) {
    case OPTION_MAP:
        options->map_path = argument;
        return true;
    case OPTION_RAW:
        return parse_raw(argument, options, error);
    case OPTION_ANNOTATE:
        options->annotate_path = argument;
        return true;
    case OPTION_FORMAT:
        return parse_format(argument, &options->format, error);
    default:
        return apply_setting(code, argument, &options->config, error);
    }
}

static bool apply_option(int code, char *argument, decode_options *options, error_text *error)
{
    error_text reason;
    if (take_option(code, argument, options, &reason))
        return true;
    error_text_set(error, "--%s: %s", option_name(code), reason.text);
    return false;
}

options_answer options_parse(int argc, char *argv[], decode_options *options, error_text *error)
{
    *options = (decode_options){0};
    opterr = 0;
    int code;
    while ((code = getopt_long(argc, argv, ":", long_options, NULL)) != -1) {
        if (code == OPTION_HELP)
            return OPTIONS_HELP;
        if (code == OPTION_VERSION)
            return OPTIONS_VERSION;
        if (option_is_mistake(code, argv, error) || !apply_option(code, optarg, options, error))
            return OPTIONS_WRONG;
    }
    options->inputs = argv + optind;
    options->input_count = argc - optind;
    if (options->input_count == 0) {
        error_text_set(error, "no INPUT was given (--help tells more)");
        return OPTIONS_WRONG;
    }
    return OPTIONS_RUN;
}
