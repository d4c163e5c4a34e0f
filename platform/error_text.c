#include "error_text.h"

#include <stdarg.h>
#include <stdio.h>

void error_text_set(error_text *error, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->text, sizeof error->text, format, arguments);
    va_end(arguments);
}
