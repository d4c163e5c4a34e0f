/* A pseudo terminal of our own: other programs open it as if it were a serial port. */
#define _XOPEN_SOURCE 700
#include "record_channel.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

typedef struct pty_channel {
    record_channel base;
    int master;
    bool had_reader;
    char device[64];  /* /dev/pts/3 */
    char link[];
} pty_channel;

static pty_channel *self_of(const record_channel *channel)
{
    return (pty_channel *)(uintptr_t)channel;
}

static bool has_reader(const pty_channel *self)
{
    struct pollfd poll_master = {self->master, 0, 0};
    return poll(&poll_master, 1, 0) == 0;
}

/* Our own short visit at the other end: sets it up, or throws away what a reader that has left did not read, so that
 * the next one does not take it for fresh. */
static bool visit_other_end(const pty_channel *self)
{
    struct termios raw;
    int slave = open(self->device, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (slave < 0)
        return false;
    bool done = tcgetattr(slave, &raw) == 0;
    raw.c_iflag = 0;
    raw.c_oflag = 0;
    raw.c_lflag = 0;
    raw.c_cflag = CS8 | CREAD | CLOCAL;
    done = done && tcsetattr(slave, TCSAFLUSH, &raw) == 0;
    close(slave);
    return done;
}

/* Without a reader, bytes would only grow old: they go nowhere. */
static ptrdiff_t pty_write(record_channel *channel, const uint8_t *bytes, size_t size, error_text *error)
{
    pty_channel *self = self_of(channel);
    if (has_reader(self)) {
        self->had_reader = true;
        return record_channel_moved(write(self->master, bytes, size), error);
    }
    if (self->had_reader) {
        self->had_reader = false;
        tcflush(self->master, TCOFLUSH);
        visit_other_end(self);
    }
    return (ptrdiff_t)size;
}

static ptrdiff_t pty_read(record_channel *channel, uint8_t *bytes, size_t size, error_text *error)
{
    ssize_t count = read(self_of(channel)->master, bytes, size);
    if (count < 0 && errno == EIO)
        return 0;
    return record_channel_moved(count, error);
}

/* While nobody has it open, poll() would return at once, each time. */
static int pty_descriptor(const record_channel *channel)
{
    return has_reader(self_of(channel)) ? self_of(channel)->master : -1;
}

static bool link_is_ours(const pty_channel *self)
{
    char target[sizeof self->device];
    ssize_t length = readlink(self->link, target, sizeof target);
    return length == (ssize_t)strlen(self->device) && memcmp(target, self->device, (size_t)length) == 0;
}

static void pty_close(record_channel *channel)
{
    pty_channel *self = self_of(channel);
    if (link_is_ours(self))
        unlink(self->link);
    close(self->master);
    free(self);
}

static const record_channel_methods pty_methods = {pty_write, pty_read, NULL, NULL, pty_descriptor, pty_close};

static bool pty_check(const char *target, error_text *error)
{
    if (*target != '\0')
        return true;
    error_text_set(error, "names no path for the pseudo terminal");
    return false;
}

/* A link to a pseudo terminal is what a run before this one left. */
static bool make_link(const pty_channel *self, error_text *error)
{
    char target[16] = "";
    static const char terminals[] = "/dev/pts/";
    if (readlink(self->link, target, sizeof target) > 0 && strncmp(target, terminals, strlen(terminals)) == 0)
        unlink(self->link);
    if (symlink(self->device, self->link) == 0)
        return true;
    error_text_set(error, "cannot be made: %s", strerror(errno));
    return false;
}

static bool set_up(pty_channel *self, error_text *error)
{
    const char *device = NULL;
    if (grantpt(self->master) == 0 && unlockpt(self->master) == 0)
        device = ptsname(self->master);
    if (device != NULL && (size_t)snprintf(self->device, sizeof self->device, "%s", device) < sizeof self->device &&
        fcntl(self->master, F_SETFL, O_NONBLOCK) == 0 && fcntl(self->master, F_SETFD, FD_CLOEXEC) == 0 &&
        visit_other_end(self))
        return make_link(self, error);
    error_text_set(error, "cannot be made: %s", strerror(errno));
    return false;
}

static record_channel *pty_open(const char *target, error_text *error)
{
    size_t link_bytes = strlen(target) + 1;
    pty_channel *self = calloc(1, sizeof *self + link_bytes);
    if (self == NULL) {
        error_text_set(error, "cannot be made: not enough memory");
        return NULL;
    }
    memcpy(self->link, target, link_bytes);
    self->base = (record_channel){&pty_methods, 0, 0};
    self->master = posix_openpt(O_RDWR | O_NOCTTY);
    if (self->master >= 0 && set_up(self, error))
        return &self->base;
    if (self->master >= 0)
        close(self->master);
    else
        error_text_set(error, "cannot be made: %s", strerror(errno));
    free(self);
    return NULL;
}

const record_channel_kind record_channel_pty = {"pty:", false, pty_check, pty_open};
