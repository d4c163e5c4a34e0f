#include "service.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

struct service {
    int signals;
    sigset_t former_mask;
    int notes;                    /* -1: nobody expects any */
    struct sockaddr_un listener;
    socklen_t listener_bytes;
    int64_t alive_interval_ns;
};

/* The address of systemd's socket, "@" in front for one without a file, is in NOTIFY_SOCKET. */
static void open_notes(service *self)
{
    const char *address = getenv("NOTIFY_SOCKET");
    self->notes = -1;
    if (address == NULL || (address[0] != '/' && address[0] != '@'))
        return;
    size_t length = strlen(address);
    if (length >= sizeof self->listener.sun_path)
        return;
    self->listener.sun_family = AF_UNIX;
    memcpy(self->listener.sun_path, address, length);
    if (address[0] == '@')
        self->listener.sun_path[0] = '\0';
    self->listener_bytes = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    self->notes = socket(AF_UNIX, SOCK_DGRAM, 0);
    if (self->notes >= 0)
        fcntl(self->notes, F_SETFD, FD_CLOEXEC);
}

static bool parse_positive(const char *text, int64_t *value)
{
    char *end;
    errno = 0;
    long long parsed = text != NULL ? strtoll(text, &end, 10) : 0;
    *value = parsed;
    return parsed > 0 && errno == 0 && *end == '\0';
}

/* Another process's watchdog may stand in the environment that it left us. */
static int64_t alive_interval_ns(void)
{
    int64_t microseconds, process;
    const char *process_text = getenv("WATCHDOG_PID");
    if (!parse_positive(getenv("WATCHDOG_USEC"), &microseconds) || microseconds > INT64_MAX / 1000)
        return 0;
    if (process_text != NULL && (!parse_positive(process_text, &process) || process != getpid()))
        return 0;
    return microseconds * 1000 / 2;
}

service *service_open(error_text *error)
{
    sigset_t wanted;
    service *self = calloc(1, sizeof *self);
    if (self == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    sigemptyset(&wanted);
    sigaddset(&wanted, SIGHUP);
    sigaddset(&wanted, SIGINT);
    sigaddset(&wanted, SIGTERM);
    sigprocmask(SIG_BLOCK, &wanted, &self->former_mask);
    self->signals = signalfd(-1, &wanted, SFD_NONBLOCK | SFD_CLOEXEC);
    if (self->signals < 0) {
        error_text_set(error, "signals cannot be received: %s", strerror(errno));
        sigprocmask(SIG_SETMASK, &self->former_mask, NULL);
        free(self);
        return NULL;
    }
    open_notes(self);
    self->alive_interval_ns = alive_interval_ns();
    return self;
}

int service_descriptor(const service *self)
{
    return self->signals;
}

service_request service_next_request(service *self)
{
    service_request request = SERVICE_GO_ON;
    struct signalfd_siginfo info;
    while (read(self->signals, &info, sizeof info) == (ssize_t)sizeof info) {
        service_request this_one = info.ssi_signo == SIGHUP ? SERVICE_RELOAD : SERVICE_STOP;
        if (this_one > request)
            request = this_one;
    }
    return request;
}

int64_t service_alive_interval_ns(const service *self)
{
    return self->alive_interval_ns;
}

static void tell(const service *self, const char *note)
{
    if (self->notes >= 0)
        sendto(self->notes, note, strlen(note), MSG_DONTWAIT | MSG_NOSIGNAL,
               (const struct sockaddr *)&self->listener, self->listener_bytes);
}

void service_tell_ready(service *self)
{
    tell(self, "READY=1");
}

void service_tell_reloading(service *self)
{
    char note[64];
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    snprintf(note, sizeof note, "RELOADING=1\nMONOTONIC_USEC=%lld",
             (long long)now.tv_sec * 1000000 + now.tv_nsec / 1000);
    tell(self, note);
}

void service_tell_stopping(service *self)
{
    tell(self, "STOPPING=1");
}

void service_tell_alive(service *self)
{
    tell(self, "WATCHDOG=1");
}

/* A line break in it would begin another note. */
void service_tell_status(service *self, const char *status)
{
    char note[256];
    snprintf(note, sizeof note, "STATUS=%s", status);
    for (char *character = note; *character != '\0'; character++) {
        if (*character == '\n')
            *character = ' ';
    }
    tell(self, note);
}

void service_close(service *self)
{
    if (self == NULL)
        return;
    if (self->notes >= 0)
        close(self->notes);
    close(self->signals);
    sigprocmask(SIG_SETMASK, &self->former_mask, NULL);
    free(self);
}
