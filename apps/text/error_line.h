/* The one line on standard error that tells why a program fails, or what it could not do. */
#ifndef TEXT_ERROR_LINE_H
#define TEXT_ERROR_LINE_H

#include "text_buffer.h"

/* PROGRAM: SUBJECT: TEXT, fit for a terminal and one line whatever the last two hold. `subject` is what it is about,
 * a file or an option; NULL where the text says so itself. */
void error_line_add(text_buffer *line, const char *program, const char *subject, const char *text);
void error_line_print(const char *program, const char *subject, const char *text);

#endif
