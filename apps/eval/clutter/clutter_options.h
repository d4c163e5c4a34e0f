/* The command line of tapemark-clutter. */
#ifndef CLUTTER_OPTIONS_H
#define CLUTTER_OPTIONS_H

#include <stdbool.h>

#include "error_text.h"

typedef struct clutter_options {
    const char *sheets_path;  /* NULL: painted kinds alone */
    const char *kinds;        /* NULL: all, else their names with commas between them */
    const char *keep_path;    /* NULL: pictures are not kept */
    const char *frames_path;  /* NULL: frames are not written */
    const char *output_path;
    double frames, first, seed;
    bool strict;
} clutter_options;

typedef enum options_answer { OPTIONS_RUN, OPTIONS_HELP, OPTIONS_WRONG } options_answer;

options_answer clutter_options_parse(int argc, char *argv[], clutter_options *all, error_text *error);

/* Whether a kind's name is among those asked for. */
bool kind_is_wanted(const clutter_options *all, const char *name);

extern const char *const clutter_usage;

#endif
