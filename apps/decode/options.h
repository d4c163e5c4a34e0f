/* The command line of tapemark-decode. */
#ifndef DECODE_OPTIONS_H
#define DECODE_OPTIONS_H

#include "frame.h"
#include "report.h"
#include "tapemark.h"

typedef struct decode_options {
    const char *map_path;       /* NULL: none */
    const char *annotate_path;  /* NULL: none */
    bool raw_given;
    frame_layout raw;
    report_format format;
    tapemark_config config;
    char *const *inputs;
    int input_count;
} decode_options;

typedef enum options_answer {
    OPTIONS_RUN,
    OPTIONS_HELP,
    OPTIONS_VERSION,
    OPTIONS_WRONG  /* the error says what is wrong */
} options_answer;

options_answer options_parse(int argc, char *argv[], decode_options *options, error_text *error);

/* The text of --help. */
extern const char options_help[];

#endif
