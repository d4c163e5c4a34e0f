#include "stream_host.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

int64_t host_clock_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void host_sleep_ms(int time_ms)
{
    nanosleep(&(struct timespec){time_ms / 1000, time_ms % 1000 * 1000000L}, NULL);
}

/* ---- The terminal -------------------------------------------------------------------------------------------- */

bool host_open(stream_host *host)
{
    struct termios settings;
    *host = (stream_host){.line = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), .device = -1,
                          .said_pipe = -1};
    if (host->line < 0 || grantpt(host->line) != 0 || unlockpt(host->line) != 0)
        return false;
    snprintf(host->device_path, sizeof host->device_path, "%s", ptsname(host->line));
    host->device = open(host->device_path, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (host->device < 0 || tcgetattr(host->device, &settings) != 0)
        return false;
    cfmakeraw(&settings);
    return tcsetattr(host->device, TCSANOW, &settings) == 0;
}

void host_unplug(stream_host *host)
{
    close(host->device);
    close(host->line);
    host->device = host->line = -1;
}

/* ---- The program --------------------------------------------------------------------------------------------- */

/* In memory that is never freed: it belongs to the program that takes the place of this one. */
static char *with_line(const stream_host *host, const char *argument)
{
    const char *at = strstr(argument, "LINE");
    char *text = NULL;
    if (at == NULL)
        return strdup(argument);
    if (asprintf(&text, "%.*s%s%s", (int)(at - argument), argument, host->device_path, at + 4) < 0)
        return NULL;
    return text;
}

static void become(const stream_host *host, const char *program, const char *const *arguments, int said)
{
    char *words[HOST_ARGUMENTS_MAX + 2] = {strdup(program)};
    for (int i = 0; i < HOST_ARGUMENTS_MAX && arguments[i] != NULL; i++)
        words[i + 1] = with_line(host, arguments[i]);
    /* A program that outlives a test would find another test's terminal under the name of its own. */
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(said, STDERR_FILENO);
    if (host->output > 0)
        dup2(host->output, STDOUT_FILENO);
    execv(program, words);
    _exit(127);
}

bool host_start(stream_host *host, const char *program, const char *const *arguments)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return false;
    host->program = fork();
    if (host->program == 0)
        become(host, program, arguments, ends[1]);
    close(ends[1]);
    host->said_pipe = ends[0];
    fcntl(host->said_pipe, F_SETFL, O_NONBLOCK);
    return host->program > 0;
}

static void listen_to_program(stream_host *host)
{
    size_t room = sizeof host->said - 1 - host->said_size;
    ssize_t count = host->said_pipe >= 0 && room > 0 ? read(host->said_pipe, host->said + host->said_size, room) : 0;
    if (count > 0)
        host->said_size += (size_t)count;
    host->said[host->said_size] = '\0';
}

bool host_says(stream_host *host, const char *text, int timeout_ms)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    listen_to_program(host);
    while (strstr(host->said, text) == NULL && host_clock_ns() < deadline_ns) {
        host_sleep_ms(10);
        listen_to_program(host);
    }
    return strstr(host->said, text) != NULL;
}

unsigned host_count_said(stream_host *host, const char *text)
{
    unsigned count = 0;
    listen_to_program(host);
    for (const char *at = strstr(host->said, text); at != NULL; at = strstr(at + 1, text))
        count++;
    return count;
}

bool host_has_ended(const stream_host *host)
{
    siginfo_t ended = {.si_pid = 0};
    return waitid(P_PID, (id_t)host->program, &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0;
}

int host_wait(stream_host *host, int timeout_ms)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    int status = 0;
    pid_t ended = waitpid(host->program, &status, WNOHANG);
    while (ended == 0 && host_clock_ns() < deadline_ns) {
        host_sleep_ms(2);
        listen_to_program(host);
        ended = waitpid(host->program, &status, WNOHANG);
    }
    if (ended <= 0)
        return -1;
    host->program = 0;
    listen_to_program(host);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void host_close(stream_host *host)
{
    if (host->program > 0) {
        kill(host->program, SIGKILL);
        waitpid(host->program, NULL, 0);
    }
    if (host->said_pipe >= 0)
        close(host->said_pipe);
    if (host->device >= 0)
        close(host->device);
    if (host->line >= 0)
        close(host->line);
}

/* ---- Records ------------------------------------------------------------------------------------------------- */

static bool next_in_hand(stream_host *host, tapemark_record *record)
{
    while (host->taken < host->size) {
        host->taken_bytes++;
        if (tapemark_receiver_push(&host->receiver, host->bytes[host->taken++]) != TAPEMARK_RECORD_NONE) {
            *record = host->receiver.record;
            return true;
        }
    }
    return false;
}

bool host_record(stream_host *host, int timeout_ms, tapemark_record *record)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    while (!next_in_hand(host, record)) {
        const int64_t left_ms = (deadline_ns - host_clock_ns() + 999999) / 1000000;
        struct pollfd wait = {.fd = host->line, .events = POLLIN};
        if (left_ms <= 0 || poll(&wait, 1, (int)left_ms) < 0)
            return false;
        const ssize_t count = read(host->line, host->bytes, HOST_READ_BYTES);
        host->taken = 0;
        host->size = count > 0 ? (size_t)count : 0;
        if (host->on_bytes != NULL)
            host->size = host->on_bytes(host->context, host->bytes, host->size);
        host->record_ns = host_clock_ns();
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR))
            host_sleep_ms(2);
    }
    return true;
}

bool host_record_of(stream_host *host, tapemark_record_type type, int timeout_ms, tapemark_record *record)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    while (host_record(host, (int)((deadline_ns - host_clock_ns()) / 1000000), record))
        if (record->type == type)
            return true;
    return false;
}

void host_forget(stream_host *host)
{
    while (read(host->line, host->bytes, sizeof host->bytes) > 0)
        continue;
    host->size = host->taken = 0;
}

void host_command(stream_host *host, uint16_t number, const char *verb, const char *name, const char *value)
{
    char sentence[TAPEMARK_SENTENCE_MAX_BYTES];
    const size_t size = tapemark_command_write(sentence, sizeof sentence, number, verb, name, value);
    size_t sent = 0;
    while (size > 0 && sent < size) {
        const ssize_t count = write(host->line, sentence + sent, size - sent);
        if (count > 0)
            sent += (size_t)count;
        else
            host_sleep_ms(1);
    }
}
