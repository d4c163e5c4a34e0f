#include "machine.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum { BOOT_MS = 90000, CONNECT_MS = 10000 };

int machine_connect(const char *folder, const char *name)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    const int64_t deadline_ns = host_clock_ns() + CONNECT_MS * INT64_C(1000000);
    const int end = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (snprintf(address.sun_path, sizeof address.sun_path, "%s/%s", folder, name) >= (int)sizeof address.sun_path)
        return -1;
    while (connect(end, (const struct sockaddr *)&address, sizeof address) != 0) {
        if (host_clock_ns() > deadline_ns)
            return -1;
        host_sleep_ms(20);
    }
    fcntl(end, F_SETFL, O_NONBLOCK);
    return end;
}

/* The next line that the machine's shell writes, without its end. */
static bool read_line(machine *board, int64_t deadline_ns, char *line, size_t size)
{
    size_t length = 0;
    while (length + 1 < size) {
        const int64_t left_ms = (deadline_ns - host_clock_ns()) / 1000000;
        struct pollfd waits[] = {{.fd = board->control, .events = POLLIN},
                                 {.fd = board->line.line, .events = POLLIN}};
        if (left_ms <= 0 || poll(waits, 2, (int)left_ms) <= 0)
            return false;
        if (waits[1].revents != 0)
            board->on_line(board->context);
        if (waits[0].revents == 0)
            continue;
        if (read(board->control, line + length, 1) != 1)
            return false;
        if (line[length] == '\n')
            break;
        length += line[length] != '\r';
    }
    line[length] = '\0';
    return true;
}

/* Reads up to the line that ends the answer to the last command; what is still to come from commands before it is
 * passed over. The status there; -1 when it does not come. */
static int read_answer(machine *board, int timeout_ms)
{
    unsigned number;
    int status;
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    size_t used = 0;
    char line[512];
    board->answer[0] = '\0';
    while (read_line(board, deadline_ns, line, sizeof line)) {
        if (sscanf(line, "=== %u %d", &number, &status) == 2) {
            if (number == board->command)
                return status;
            board->answer[used = 0] = '\0';
            continue;
        }
        if (used + strlen(line) + 2 <= sizeof board->answer)
            used += (size_t)snprintf(board->answer + used, sizeof board->answer - used, "%s\n", line);
    }
    return -1;
}

bool machine_open(machine *board, const char *folder, pid_t usb_camera)
{
    board->usb_camera = usb_camera;
    board->control = machine_connect(folder, "control");
    board->line = (stream_host){.line = machine_connect(folder, "line"), .device = -1, .said_pipe = -1};
    return board->control >= 0 && board->line.line >= 0 && read_answer(board, BOOT_MS) == 0;
}

int machine_do(machine *board, int timeout_ms, const char *command, ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, command);
    size_t length = (size_t)snprintf(text, sizeof text, "%u ", ++board->command);
    length += (size_t)vsnprintf(text + length, sizeof text - length, command, arguments);
    va_end(arguments);
    if (length >= sizeof text - 1)
        return -1;
    text[length++] = '\n';
    for (size_t sent = 0; sent < length;) {
        const ssize_t count = write(board->control, text + sent, length - sent);
        if (count < 0 && errno != EAGAIN && errno != EINTR)
            return -1;
        sent += count > 0 ? (size_t)count : 0;
    }
    return read_answer(board, timeout_ms);
}

void machine_plug(const machine *board, bool in)
{
    kill(board->usb_camera, in ? SIGUSR2 : SIGUSR1);
}

void machine_freeze(const machine *board, bool still)
{
    kill(board->usb_camera, still ? SIGSTOP : SIGCONT);
}

void machine_hold_line(machine *board, bool hold)
{
    enum { XON = 0x11, XOFF = 0x13 };
    const uint8_t byte = hold ? XOFF : XON;
    while (write(board->line.line, &byte, 1) < 0 && errno == EAGAIN)
        host_sleep_ms(1);
}

void machine_close(machine *board)
{
    close(board->control);
    host_close(&board->line);
}
