#include "option_mistake.h"

#include <getopt.h>
#include <limits.h>

bool option_is_mistake(int code, char *const argv[], error_text *error)
{
    if (code == ':')
        error_text_set(error, "%.80s needs a value", argv[optind - 1]);
    else if (code == '?' && optopt > 0 && optopt <= UCHAR_MAX)
        error_text_set(error, "unknown option '-%c' (--help lists all)", optopt);
    else if (code == '?')
        error_text_set(error, "option '%.80s' is unknown, ambiguous or takes no value (--help lists all)",
                       argv[optind - 1]);
    return code == ':' || code == '?';
}
