/* What is wrong with an option itself: it is unknown, or its value is missing. */
#ifndef OPTIONS_OPTION_MISTAKE_H
#define OPTIONS_OPTION_MISTAKE_H

#include <stdbool.h>

#include "error_text.h"

/* Whether getopt_long() gave ':' or '?' as `code`, with the reason. To be asked before its next call; the list of
 * short options begins with a colon, and codes of long options are greater than those of all characters. */
bool option_is_mistake(int code, char *const argv[], error_text *error);

#endif
