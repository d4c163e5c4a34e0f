#include "messages.h"

#include <fcntl.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "error_line.h"

#define PROGRAM "tapemark-stream"

static int people = STDERR_FILENO;

/* Lines that found no room since the last one that did. */
static atomic_uint left_out;

/* A pipe or terminal that others write to as well must not become non-blocking for them: it is opened once more. */
void messages_begin(void)
{
    struct stat status;
    bool can_block = fstat(STDERR_FILENO, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode));
    int own = can_block ? open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC) : -1;
    if (own < 0)
        own = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (own >= 0)
        people = own;
}

/* False when nobody makes room for it: to wait for that would hold up the frames. */
static bool write_line(const char *text)
{
    struct pollfd room = {people, POLLOUT, 0};
    bool own = people != STDERR_FILENO && (fcntl(people, F_GETFL) & O_NONBLOCK) != 0;
    if (!own && poll(&room, 1, 0) == 0)
        return false;
    return write(people, text, strlen(text)) >= 0;
}

static void tell_of_those_left_out(unsigned count)
{
    char line[100];
    snprintf(line, sizeof line, PROGRAM ": %u messages were left out here: nobody read them\n", count);
    if (!write_line(line))
        atomic_fetch_add(&left_out, count);
}

void message_tell(const char *subject, const char *text)
{
    text_buffer line = {0};
    error_line_add(&line, PROGRAM, subject, text);
    unsigned before = atomic_exchange(&left_out, 0);
    if (before > 0)
        tell_of_those_left_out(before);
    if (!write_line(line.failed ? PROGRAM ": not enough memory\n" : line.text))
        atomic_fetch_add(&left_out, 1);
    text_buffer_release(&line);
}
