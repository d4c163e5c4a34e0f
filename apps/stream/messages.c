#include "messages.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "text_buffer.h"

static int people = STDERR_FILENO;

void messages_begin(void)
{
    int own = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (own >= 0)
        people = own;
}

void message_tell(const char *subject, const char *text)
{
    text_buffer line = {0};
    text_buffer_add(&line, "tapemark-stream: ");
    if (subject != NULL) {
        text_buffer_add_printable(&line, subject);
        text_buffer_add(&line, ": ");
    }
    text_buffer_add_printable(&line, text);
    dprintf(people, "%s\n", line.failed ? "tapemark-stream: not enough memory" : line.text);
    text_buffer_release(&line);
}
