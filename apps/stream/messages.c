#include "messages.h"

#include <stdio.h>

#include "text_buffer.h"

void message_tell(const char *subject, const char *text)
{
    text_buffer line = {0};
    text_buffer_add(&line, "tapemark-stream: ");
    if (subject != NULL) {
        text_buffer_add_printable(&line, subject);
        text_buffer_add(&line, ": ");
    }
    text_buffer_add_printable(&line, text);
    fprintf(stderr, "%s\n", line.failed ? "tapemark-stream: not enough memory" : line.text);
    text_buffer_release(&line);
}
