/* tapemark-stream: ids of a tape from a camera to a microcontroller. */
#include "listing.h"
#include "messages.h"
#include "stream.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_BAD_INPUT = 1, EXIT_BAD_USAGE = 2 };

/* A file opened later must not end up where standard output or standard error should be. */
static bool fill_descriptors(bool *output_is_open)
{
    *output_is_open = fcntl(STDOUT_FILENO, F_GETFD) >= 0;
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
        if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor)
            return false;
    return true;
}

static int written(void)
{
    if (fflush(stdout) == 0 && ferror(stdout) == 0)
        return EXIT_SUCCESS;
    message_tell("standard output", "could not be written");
    return EXIT_BAD_INPUT;
}

/* It is larger than a stack should have to hold. */
static stream program;

static int run(command_line command, const stream_settings *settings, bool output_is_open)
{
    if (!output_is_open && strcmp(settings->output, "-") == 0) {
        message_tell("standard output", "is closed; --serial and --output name other ways");
        return EXIT_BAD_INPUT;
    }
    int status = stream_open(&program, command, settings) ? stream_run(&program) : EXIT_BAD_INPUT;
    if (!stream_close(&program))
        _exit(status);
    return status;
}

int main(int argc, char *argv[])
{
    stream_settings settings;
    error_text error;
    command_line command = {argc, argv};
    signal(SIGPIPE, SIG_IGN);
    /* A disk quota ends a recording, not the program. */
    signal(SIGXFSZ, SIG_IGN);
    bool output_is_open;
    if (!fill_descriptors(&output_is_open))
        return EXIT_BAD_INPUT;
    messages_begin();
    switch (stream_options_read(command, &settings, &error)) {
    case OPTIONS_RUN:
        return run(command, &settings, output_is_open);
    case OPTIONS_LIST:
        listing_write(stdout);
        return written();
    case OPTIONS_HELP:
        fputs(stream_options_help, stdout);
        return written();
    case OPTIONS_VERSION:
        printf("tapemark-stream %s\n", tapemark_version());
        return written();
    case OPTIONS_WRONG:
        message_tell(NULL, error.text);
        return EXIT_BAD_USAGE;
    case OPTIONS_BAD_CONFIG:
        message_tell(NULL, error.text);
        break;
    }
    return EXIT_BAD_INPUT;
}
