#include "clutter_options.h"

#include <getopt.h>
#include <string.h>

#include "option_mistake.h"
#include "option_values.h"

const char *const clutter_usage =
    "usage: tapemark-clutter [OPTION...]\n"
    "Decodes frames of 640 x 480 px in which there is no tape, and tells what was read in them all the same.\n"
    "\n"
    "  --frames N        of each kind (100)\n"
    "  --first N         number of the first (0): a frame is made by its kind, its number and the seed alone\n"
    "  --seed N          of all that is random (1)\n"
    "  --kinds LIST      names with commas between them (all)\n"
    "  --sheets DIR      more kinds: pictures of up to 1024 x 1024 px, those of a kind alike up to the last hyphen\n"
    "  --keep DIR        writes each frame in which something was read to DIR/KIND-NUMBER.pgm\n"
    "  --raw FILE        writes all frames, headerless, 8 bits a pixel; \"-\" is standard output\n"
    "  -o, --output FILE where the report goes, in JSON (-)\n"
    "  --strict          fails when any code marker was read\n"
    "  --help            prints this\n"
    "\n"
    "Exit status: 0 all was done; 1 a file could not be read or written, or --strict found something; 2 wrong\n"
    "usage.\n";

enum {
    CODE_FRAMES = 256, CODE_FIRST, CODE_SEED, CODE_KINDS, CODE_SHEETS, CODE_KEEP, CODE_RAW, CODE_STRICT, CODE_HELP
};

static const struct option known_options[] = {
    {"frames", required_argument, NULL, CODE_FRAMES}, {"first", required_argument, NULL, CODE_FIRST},
    {"seed", required_argument, NULL, CODE_SEED},     {"kinds", required_argument, NULL, CODE_KINDS},
    {"sheets", required_argument, NULL, CODE_SHEETS}, {"keep", required_argument, NULL, CODE_KEEP},
    {"raw", required_argument, NULL, CODE_RAW},       {"output", required_argument, NULL, 'o'},
    {"strict", no_argument, NULL, CODE_STRICT},       {"help", no_argument, NULL, CODE_HELP},
    {0},
};

static bool take_number(const char *name, const char *text, double least, double most, double *number,
                        error_text *error)
{
    error_text reason;
    if (parse_value(text, (value_range){VALUE_WHOLE, least, most}, number, &reason))
        return true;
    error_text_set(error, "--%s: %s", name, reason.text);
    return false;
}

static bool take(clutter_options *all, int code, const char *text, error_text *error)
{
    switch (code) {
    case CODE_FRAMES:
        return take_number("frames", text, 1, 1e7, &all->frames, error);
    case CODE_FIRST:
        return take_number("first", text, 0, 1e7, &all->first, error);
    case CODE_SEED:
        return take_number("seed", text, 0, 1e15, &all->seed, error);
    case CODE_KINDS:
        all->kinds = text;
        return true;
    case CODE_SHEETS:
        all->sheets_path = text;
        return true;
    case CODE_KEEP:
        all->keep_path = text;
        return true;
    case CODE_RAW:
        all->frames_path = text;
        return true;
    case 'o':
        all->output_path = text;
        return true;
    default:
        all->strict = true;
        return true;
    }
}

options_answer clutter_options_parse(int argc, char *argv[], clutter_options *all, error_text *error)
{
    *all = (clutter_options){.frames = 100, .seed = 1, .output_path = "-"};
    opterr = 0;
    optind = 1;
    for (int code; (code = getopt_long(argc, argv, ":o:", known_options, NULL)) != -1;) {
        if (code == CODE_HELP)
            return OPTIONS_HELP;
        if (option_is_mistake(code, argv, error) || !take(all, code, optarg, error))
            return OPTIONS_WRONG;
    }
    if (optind < argc) {
        error_text_set(error, "unexpected argument '%.80s' (--help lists all options)", argv[optind]);
        return OPTIONS_WRONG;
    }
    if (all->frames_path != NULL && strcmp(all->frames_path, all->output_path) == 0) {
        error_text_set(error, "--raw and --output both go to '%.80s'; give them different files", all->output_path);
        return OPTIONS_WRONG;
    }
    return OPTIONS_RUN;
}

bool kind_is_wanted(const clutter_options *all, const char *name)
{
    if (all->kinds == NULL)
        return true;
    const size_t length = strlen(name);
    for (const char *at = all->kinds; at != NULL; at = strchr(at, ',')) {
        at += *at == ',';
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0'))
            return true;
    }
    return false;
}
