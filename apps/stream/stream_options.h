/* The command line: settings by name, and the configuration file that they go before. */
#ifndef STREAM_STREAM_OPTIONS_H
#define STREAM_STREAM_OPTIONS_H

#include "settings.h"

typedef enum options_answer {
    OPTIONS_RUN,
    OPTIONS_LIST,
    OPTIONS_HELP,
    OPTIONS_VERSION,
    OPTIONS_WRONG,      /* the error says what is wrong with the command line */
    OPTIONS_BAD_CONFIG  /* or with the configuration file */
} options_answer;

/* What a program was called with. It may be read again, when the configuration file has changed. */
typedef struct command_line {
    int count;
    char *const *words;
} command_line;

options_answer stream_options_read(command_line line, stream_settings *settings, error_text *error);

/* The text of --help. */
extern const char stream_options_help[];

#endif
