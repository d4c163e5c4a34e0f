/* Files, and standard output whatever it is. */
#include "record_channel.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct file_channel {
    record_channel base;
    int descriptor;
    bool is_socket;
    int restored_flags;  /* of a descriptor that others use as well, for the end; -1: untouched */
} file_channel;

static file_channel *self_of(const record_channel *channel)
{
    return (file_channel *)(uintptr_t)channel;
}

static ptrdiff_t file_write(record_channel *channel, const uint8_t *bytes, size_t size, error_text *error)
{
    const file_channel *self = self_of(channel);
    return record_channel_moved(self->is_socket
                                    ? send(self->descriptor, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL)
                                    : write(self->descriptor, bytes, size), error);
}

static int file_descriptor(const record_channel *channel)
{
    return self_of(channel)->descriptor;
}

static void file_close(record_channel *channel)
{
    const file_channel *self = self_of(channel);
    if (self->restored_flags >= 0)
        fcntl(self->descriptor, F_SETFL, self->restored_flags);
    if (self->descriptor != STDOUT_FILENO)
        close(self->descriptor);
    free(channel);
}

static const record_channel_methods file_methods = {file_write, NULL, NULL, NULL, file_descriptor, file_close};

static record_channel *new_channel(int descriptor, error_text *error)
{
    struct stat status;
    file_channel *self = calloc(1, sizeof *self);
    if (self == NULL) {
        error_text_set(error, "cannot be opened: not enough memory");
        return NULL;
    }
    bool known = fstat(descriptor, &status) == 0;
    /* Only of what has another end; poll() finds no fault with files and devices. */
    bool has_reader = known && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode) || isatty(descriptor));
    self->base = (record_channel){&file_methods, has_reader ? POLLHUP | POLLERR | POLLNVAL : 0, 0};
    self->descriptor = descriptor;
    self->is_socket = known && S_ISSOCK(status.st_mode);
    self->restored_flags = -1;
    return &self->base;
}

static bool file_check(const char *target, error_text *error)
{
    if (*target != '\0')
        return true;
    error_text_set(error, "names no file");
    return false;
}

static record_channel *file_open(const char *target, error_text *error)
{
    int descriptor = open(target, O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_NOCTTY | O_CLOEXEC, 0644);
    if (descriptor < 0) {
        if (errno == ENXIO)
            error_text_set(error, "is a pipe that nobody reads");
        else
            error_text_set(error, "cannot be written to: %s", strerror(errno));
        return NULL;
    }
    record_channel *channel = new_channel(descriptor, error);
    if (channel == NULL)
        close(descriptor);
    return channel;
}

static bool stdout_check(const char *target, error_text *error)
{
    if (*target == '\0')
        return true;
    error_text_set(error, "is no output: standard output is - alone");
    return false;
}

/* A pipe or terminal that others write to as well must not become non-blocking for them: it is opened once more.
 * Where that is not allowed it is changed for everybody until the end. A socket is told with each write, and files
 * are written to at the place where they are. */
static record_channel *stdout_open(const char *target, error_text *error)
{
    struct stat status;
    (void)target;
    if (fstat(STDOUT_FILENO, &status) != 0) {
        error_text_set(error, "is closed");
        return NULL;
    }
    bool can_block = S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode);
    int own = can_block ? open("/proc/self/fd/1", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC) : -1;
    record_channel *channel = new_channel(own >= 0 ? own : STDOUT_FILENO, error);
    if (channel == NULL && own >= 0)
        close(own);
    if (channel != NULL && can_block && own < 0) {
        file_channel *self = self_of(channel);
        self->restored_flags = fcntl(STDOUT_FILENO, F_GETFL);
        fcntl(STDOUT_FILENO, F_SETFL, self->restored_flags | O_NONBLOCK);
    }
    return channel;
}

const record_channel_kind record_channel_stdout = {"-", true, stdout_check, stdout_open};
const record_channel_kind record_channel_file = {"file:", false, file_check, file_open};
