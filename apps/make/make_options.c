#include "make_options.h"

#include "id_ranges.h"
#include "option_mistake.h"
#include "option_values.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_HEIGHT_MM 60.0
#define RULER_MM 100.0

enum { QUICK_CMS_MAX = 100000, DPI_MAX = 4800 };

const char make_help[] =
    "usage: tapemark-make PLAN.json -o DIRECTORY [OPTION...]\n"
    "       tapemark-make --line LENGTH -o DIRECTORY [OPTION...]\n"
    "       tapemark-make --cms N -o DIRECTORY [OPTION...]\n"
    "Makes a tape of fiducial markers: tape.pdf to print, map.json of what hangs where, plan.png to look at.\n"
    "\n"
    "  PLAN.json              the room and the lines along which the tape goes; apps/make/README.md tells its keys\n"
    "  --line LENGTH          without a plan: a straight tape, not longer than this\n"
    "  --cms N                without a plan: a straight tape of so many code markers (CM)\n"
    "  -o, --output DIRECTORY where the files go; made if need be. All of them appear at once or none does\n"
    "\n"
    "Without a plan (a plan says these itself):\n"
    "  --height LENGTH        of the ink (60mm), or\n"
    "  --module LENGTH        a seventh of it\n"
    "  --first-id N           the first CM's id (0)\n"
    "  --tm-cms N             CMs of a tape marker (TM), 3 to 32 (6)\n"
    "  --tm-cms-max N         how long TMs may become when the codes of a length run out (32); when told, tape for\n"
    "                         which there is no code is an error\n"
    "  --camera-upright       cameras know which way is up: a code and its mirror image may both be used\n"
    "\n"
    "Print:\n"
    "  --paper NAME           a4 (default), a3, letter, or roll\n"
    "  --measured LENGTH      what the 100 mm ruler of an earlier print measures: this one corrects it\n"
    "  --scale PERCENT        the same as a factor such as 100.3%; --scale-x, --scale-y: one direction\n"
    "  --only IDS             writes just repair.pdf (and pictures) of some CMs: 17..20 or 5,17..20, without signs\n"
    "  --svg                  also an SVG for each piece of tape\n"
    "  --png DPI, --pgm DPI   also a picture of each at so many pixels an inch\n"
    "  --no-labels            SVG and pictures show just ink and quiet zone\n"
    "\n"
    "  --paper-map            also paper-map.json, the map in the format of the marker's inventors\n"
    "  --quiet                no summary\n"
    "  --help, --version      print this text or the version\n"
    "\n"
    "Lengths have a unit: m, cm, mm or in.\n"
    "Exit status: 0 all was written; 1 the plan is wrong or something could not be written, nothing was changed;\n"
    "2 wrong usage.\n";

enum option_code {
    OPTION_LINE = 256,
    OPTION_CMS,
    OPTION_HEIGHT,
    OPTION_MODULE,
    OPTION_FIRST_ID,
    OPTION_TM_CMS,
    OPTION_TM_CMS_MAX,
    OPTION_CAMERA_UPRIGHT,
    OPTION_PAPER,
    OPTION_MEASURED,
    OPTION_SCALE,
    OPTION_SCALE_X,
    OPTION_SCALE_Y,
    OPTION_ONLY,
    OPTION_SVG,
    OPTION_PNG,
    OPTION_PGM,
    OPTION_NO_LABELS,
    OPTION_PAPER_MAP,
    OPTION_QUIET,
    OPTION_HELP,
    OPTION_VERSION,
    OPTION_END
};

static const struct option long_options[] = {
    {"line", required_argument, NULL, OPTION_LINE},
    {"cms", required_argument, NULL, OPTION_CMS},
    {"output", required_argument, NULL, 'o'},
    {"height", required_argument, NULL, OPTION_HEIGHT},
    {"module", required_argument, NULL, OPTION_MODULE},
    {"first-id", required_argument, NULL, OPTION_FIRST_ID},
    {"tm-cms", required_argument, NULL, OPTION_TM_CMS},
    {"tm-cms-max", required_argument, NULL, OPTION_TM_CMS_MAX},
    {"camera-upright", no_argument, NULL, OPTION_CAMERA_UPRIGHT},
    {"paper", required_argument, NULL, OPTION_PAPER},
    {"measured", required_argument, NULL, OPTION_MEASURED},
    {"scale", required_argument, NULL, OPTION_SCALE},
    {"scale-x", required_argument, NULL, OPTION_SCALE_X},
    {"scale-y", required_argument, NULL, OPTION_SCALE_Y},
    {"only", required_argument, NULL, OPTION_ONLY},
    {"svg", no_argument, NULL, OPTION_SVG},
    {"png", required_argument, NULL, OPTION_PNG},
    {"pgm", required_argument, NULL, OPTION_PGM},
    {"no-labels", no_argument, NULL, OPTION_NO_LABELS},
    {"paper-map", no_argument, NULL, OPTION_PAPER_MAP},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, OPTION_HELP},
    {"version", no_argument, NULL, OPTION_VERSION},
    {NULL, 0, NULL, 0},
};

/* Which options were given. */
typedef bool option_set[OPTION_END - OPTION_LINE];

static bool given(const option_set set, int code)
{
    return set[code - OPTION_LINE];
}

static const char *option_name(int code)
{
    const struct option *option = long_options;
    while (option->val != code)
        option++;
    return option->name;
}

/* ---- Single options ------------------------------------------------------------------------------------------ */

static bool apply_whole(const char *argument, unsigned least, unsigned most, unsigned *number, error_text *error)
{
    double value;
    if (!parse_value(argument, (value_range){VALUE_WHOLE, least, most}, &value, error))
        return false;
    *number = (unsigned)value;
    return true;
}

static bool apply_module(const char *argument, double modules, plan *quick, error_text *error)
{
    const double least_m = PLAN_MODULE_MIN_MM * modules / 1000, most_m = PLAN_MODULE_MAX_MM * modules / 1000;
    double length_m;
    if (!parse_value(argument, (value_range){VALUE_LENGTH, least_m, most_m}, &length_m, error))
        return false;
    quick->module_mm = length_m * 1000 / modules;
    return true;
}

static bool apply_first_id(const char *argument, plan *quick, error_text *error)
{
    unsigned id;
    if (!apply_whole(argument, 0, TAPEMARK_MAX_ID, &id, error))
        return false;
    quick->first_id = (int32_t)id;
    return true;
}

/* What a tape without a plan is like. */
static bool apply_quick(int code, const char *argument, make_options *options, error_text *error)
{
    const value_range line = {VALUE_LENGTH, PLAN_MODULE_MIN_MM / 1000, PLAN_SIDE_MAX_M};
    plan *quick = &options->quick;
    switch (code) {
    case OPTION_LINE:
        return parse_value(argument, line, &options->quick_length_m, error);
    case OPTION_CMS:
        return apply_whole(argument, 1, QUICK_CMS_MAX, &quick->cms_wanted, error);
    case OPTION_HEIGHT:
        return apply_module(argument, TAPEMARK_HEIGHT_MODULES, quick, error);
    case OPTION_MODULE:
        return apply_module(argument, 1, quick, error);
    case OPTION_FIRST_ID:
        return apply_first_id(argument, quick, error);
    case OPTION_TM_CMS:
        return apply_whole(argument, TAPEMARK_TM_MIN_CMS, TAPEMARK_TM_MAX_CMS, &quick->tm_cms, error);
    case OPTION_TM_CMS_MAX:
        quick->tm_required = true;
        return apply_whole(argument, TAPEMARK_TM_MIN_CMS, TAPEMARK_TM_MAX_CMS, &quick->tm_cms_max, error);
    default:
        quick->camera_upright = true;
        return true;
    }
}

static bool apply_measured(const char *argument, print_settings *print, error_text *error)
{
    const value_range range = {VALUE_LENGTH, 0.9 * RULER_MM / 1000, 1.1 * RULER_MM / 1000};
    double measured_m;
    if (!parse_value(argument, range, &measured_m, error))
        return false;
    print->scale_x = print->scale_y = RULER_MM / 1000 / measured_m;
    return true;
}

static bool apply_scale(int code, const char *argument, print_settings *print, error_text *error)
{
    double factor;
    if (!parse_value(argument, (value_range){VALUE_PERCENT, 0.9, 1.1}, &factor, error))
        return false;
    print->scale_x = code != OPTION_SCALE_Y ? factor : print->scale_x;
    print->scale_y = code != OPTION_SCALE_X ? factor : print->scale_y;
    return true;
}

static bool apply_paper(const char *argument, print_settings *print, error_text *error)
{
    if (print_paper_parse(argument, &print->paper))
        return true;
    error_text_set(error, "expected a4, a3, letter or roll, not \"%.40s\"", argument);
    return false;
}

static bool apply_print(int code, const char *argument, make_options *options, error_text *error)
{
    const value_range dpi = {VALUE_NUMBER, 1, DPI_MAX};
    switch (code) {
    case OPTION_PAPER:
        return apply_paper(argument, &options->print, error);
    case OPTION_MEASURED:
        return apply_measured(argument, &options->print, error);
    case OPTION_SCALE:
    case OPTION_SCALE_X:
    case OPTION_SCALE_Y:
        return apply_scale(code, argument, &options->print, error);
    case OPTION_ONLY:
        return parse_id_ranges(argument, &options->only, &options->print.only_count, error);
    case OPTION_PNG:
        return parse_value(argument, dpi, &options->png_dpi, error);
    case OPTION_PGM:
        return parse_value(argument, dpi, &options->pgm_dpi, error);
    case OPTION_SVG:
        options->svg = true;
        return true;
    case OPTION_NO_LABELS:
        options->print.without_labels = true;
        return true;
    case OPTION_PAPER_MAP:
        options->paper_map = true;
        return true;
    default:
        options->quiet = true;
        return true;
    }
}

static bool apply_option(int code, char *argument, option_set set, make_options *options, error_text *error)
{
    error_text reason;
    if (code == 'o' ? options->output_path != NULL : given(set, code)) {
        error_text_set(error, "--%s is given twice", option_name(code));
        return false;
    }
    if (code == 'o') {
        options->output_path = argument;
        return true;
    }
    set[code - OPTION_LINE] = true;
    if (code < OPTION_PAPER ? apply_quick(code, argument, options, &reason)
                            : apply_print(code, argument, options, &reason))
        return true;
    error_text_set(error, "--%s: %s", option_name(code), reason.text);
    return false;
}

/* ---- All options together ------------------------------------------------------------------------------------ */

static bool refuse_both(const option_set set, int a, int b, error_text *error)
{
    if (given(set, a) && given(set, b))
        error_text_set(error, "--%s and --%s say the same: give one of them", option_name(a), option_name(b));
    return given(set, a) && given(set, b);
}

static bool check_source(const option_set set, int plan_count, error_text *error)
{
    int sources = plan_count + given(set, OPTION_LINE) + given(set, OPTION_CMS);
    if (sources != 1) {
        error_text_set(error, "expected one of PLAN.json, --line and --cms, not %s (--help tells more)",
                       sources == 0 ? "none" : "several");
        return false;
    }
    for (int code = OPTION_HEIGHT; plan_count == 1 && code <= OPTION_CAMERA_UPRIGHT; code++) {
        if (given(set, code)) {
            error_text_set(error, "--%s is for --line and --cms: a plan says it itself", option_name(code));
            return false;
        }
    }
    return true;
}

static bool complete(const option_set set, int plan_count, make_options *options, error_text *error)
{
    plan *quick = &options->quick;
    if (!check_source(set, plan_count, error) || refuse_both(set, OPTION_HEIGHT, OPTION_MODULE, error) ||
        refuse_both(set, OPTION_MEASURED, OPTION_SCALE, error) ||
        refuse_both(set, OPTION_MEASURED, OPTION_SCALE_X, error) ||
        refuse_both(set, OPTION_MEASURED, OPTION_SCALE_Y, error) ||
        refuse_both(set, OPTION_SCALE, OPTION_SCALE_X, error) ||
        refuse_both(set, OPTION_SCALE, OPTION_SCALE_Y, error))
        return false;
    if (options->output_path == NULL || options->output_path[0] == '\0') {
        error_text_set(error, "where to? -o DIRECTORY is missing");
        return false;
    }
    if (quick->tm_cms_max < quick->tm_cms) {
        error_text_set(error, "--tm-cms-max %u is less than the %u CMs of --tm-cms", quick->tm_cms_max,
                       quick->tm_cms);
        return false;
    }
    options->print.only = options->only;
    return true;
}

make_answer make_options_parse(int argc, char *argv[], make_options *options, error_text *error)
{
    *options = (make_options){.quick = {.module_mm = DEFAULT_HEIGHT_MM / TAPEMARK_HEIGHT_MODULES,
                                        .tm_cms = PLAN_TM_CMS, .tm_cms_max = TAPEMARK_TM_MAX_CMS}};
    option_set set = {false};
    opterr = 0;
    optind = 0;  /* anew, also when it was called before */
    int code;
    while ((code = getopt_long(argc, argv, ":o:", long_options, NULL)) != -1) {
        if (code == OPTION_HELP || code == OPTION_VERSION)
            return code == OPTION_HELP ? MAKE_HELP : MAKE_VERSION;
        if (option_is_mistake(code, argv, error) || !apply_option(code, optarg, set, options, error))
            return MAKE_WRONG;
    }
    options->plan_path = optind < argc ? argv[optind] : NULL;
    return complete(set, argc - optind, options, error) ? MAKE_RUN : MAKE_WRONG;
}

void make_options_release(make_options *options)
{
    free(options->only);
    options->only = NULL;
}
