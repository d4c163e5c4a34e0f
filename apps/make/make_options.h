/* The command line of tapemark-make. */
#ifndef MAKE_MAKE_OPTIONS_H
#define MAKE_MAKE_OPTIONS_H

#include "plan.h"
#include "print.h"

typedef struct make_options {
    const char *plan_path;   /* NULL for a quick tape: one straight line */
    const char *output_path;
    plan quick;              /* without lines yet */
    double quick_length_m;   /* of its line; 0 when it is told by quick.cms_wanted */
    print_settings print;
    print_id_range *only;    /* print.only, to be released */
    bool svg;
    double png_dpi, pgm_dpi; /* 0: not wanted */
    bool paper_map;
    bool quiet;
} make_options;

typedef enum make_answer { MAKE_RUN, MAKE_HELP, MAKE_VERSION, MAKE_WRONG } make_answer;

extern const char make_help[];

/* MAKE_WRONG: with what is wrong. Borrows from argv. Release the options in any case. */
make_answer make_options_parse(int argc, char *argv[], make_options *options, error_text *error);

void make_options_release(make_options *options);

#endif
