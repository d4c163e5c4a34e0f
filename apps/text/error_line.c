#include "error_line.h"

#include <stdio.h>

void error_line_add(text_buffer *line, const char *program, const char *subject, const char *text)
{
    text_buffer_add(line, "%s: ", program);
    if (subject != NULL) {
        text_buffer_add_printable(line, subject);
        text_buffer_add(line, ": ");
    }
    text_buffer_add_printable(line, text);
    text_buffer_add(line, "\n");
}

void error_line_print(const char *program, const char *subject, const char *text)
{
    text_buffer line = {0};
    error_line_add(&line, program, subject, text);
    if (line.failed)
        fprintf(stderr, "%s: not enough memory\n", program);
    else
        fputs(line.text, stderr);
    text_buffer_release(&line);
}
