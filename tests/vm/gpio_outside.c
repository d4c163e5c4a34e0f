#include "gpio_outside.h"

#include <errno.h>
#include <inttypes.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "machine.h"

enum { PATIENCE_MS = 20000, CHIP_ADDRESS = 0x09030000, DATA_OF_ALL_LINES = 0x3fc, DIRECTION = 0x400 };

/* ---- Where the chip is ----------------------------------------------------------------------------------------- */

static const char container[] = "/machine/unattached";

/* The monitor lists what the board has, such as "device[7] (child<pl061>)". */
static bool read_device(int monitor, char *device, size_t size)
{
    static const char ask[] = "qom-list /machine/unattached\n", kind[] = " (child<pl061>)";
    char said[16384];
    size_t length = 0;
    const int64_t deadline_ns = host_clock_ns() + PATIENCE_MS * INT64_C(1000000);
    if (write(monitor, ask, sizeof ask - 1) != (ssize_t)sizeof ask - 1)
        return false;
    while (length + 1 < sizeof said && host_clock_ns() < deadline_ns) {
        struct pollfd wait = {.fd = monitor, .events = POLLIN};
        const ssize_t count = poll(&wait, 1, 100) == 1 ? read(monitor, said + length, sizeof said - 1 - length) : 0;
        length += count > 0 ? (size_t)count : 0;
        said[length] = '\0';
        char *end = strstr(said, kind);
        if (end == NULL)
            continue;
        *end = '\0';
        const char *begin = strrchr(said, '\n');
        return begin != NULL && snprintf(device, size, "%s/%s", container, begin + 1) < (int)size;
    }
    return false;
}

static bool find_device(gpio_outside *chip, const char *folder)
{
    const int monitor = machine_connect(folder, "monitor");
    const bool found = monitor >= 0 && read_device(monitor, chip->device, sizeof chip->device);
    if (monitor >= 0)
        close(monitor);
    return found;
}

/* ---- The test socket ------------------------------------------------------------------------------------------- */

static void note_edge(gpio_outside *chip, unsigned line, bool high)
{
    if (chip->edge_count < OUTSIDE_EDGES_MAX)
        chip->edges[chip->edge_count] = (outside_edge){host_clock_ns(), line, high};
    chip->edge_count++;
}

typedef enum line_kind { LINE_NONE, LINE_EDGE, LINE_ANSWER } line_kind;

/* The next whole line, if there is one. */
static line_kind take_line(gpio_outside *chip)
{
    unsigned line;
    char direction[8];
    char *end = memchr(chip->text, '\n', chip->text_size);
    if (end == NULL)
        return LINE_NONE;
    *end = '\0';
    const bool is_edge = sscanf(chip->text, "IRQ %7s %u", direction, &line) == 2;
    if (is_edge)
        note_edge(chip, line, strcmp(direction, "raise") == 0);
    else
        memcpy(chip->answer, chip->text, (size_t)(end + 1 - chip->text));
    chip->text_size -= (size_t)(end + 1 - chip->text);
    memmove(chip->text, end + 1, chip->text_size);
    return is_edge ? LINE_EDGE : LINE_ANSWER;
}

/* False when the emulator is gone. */
static bool read_some(gpio_outside *chip)
{
    const ssize_t count = read(chip->socket, chip->text + chip->text_size, sizeof chip->text - chip->text_size);
    chip->text_size += count > 0 ? (size_t)count : 0;
    return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

bool gpio_outside_watch(gpio_outside *chip)
{
    struct pollfd wait = {.fd = chip->socket, .events = POLLIN};
    while (poll(&wait, 1, 0) == 1) {
        if (!read_some(chip))
            return false;
        while (take_line(chip) != LINE_NONE) {
        }
    }
    return true;
}

static bool read_answer(gpio_outside *chip)
{
    const int64_t deadline_ns = host_clock_ns() + PATIENCE_MS * INT64_C(1000000);
    while (host_clock_ns() < deadline_ns) {
        struct pollfd wait = {.fd = chip->socket, .events = POLLIN};
        line_kind kind;
        while ((kind = take_line(chip)) == LINE_EDGE) {
        }
        if (kind == LINE_ANSWER)
            return strncmp(chip->answer, "OK", 2) == 0;
        if (poll(&wait, 1, 100) == 1 && !read_some(chip))
            return false;
    }
    return false;
}

static bool command(gpio_outside *chip, const char *format, ...) __attribute__((format(printf, 2, 3)));

static bool command(gpio_outside *chip, const char *format, ...)
{
    char text[160];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return length > 0 && (size_t)length < sizeof text &&
           send(chip->socket, text, (size_t)length, MSG_NOSIGNAL) == length && read_answer(chip);
}

static bool read_register(gpio_outside *chip, unsigned offset, uint8_t *value)
{
    uint64_t number = 0;
    if (!command(chip, "readb 0x%x\n", CHIP_ADDRESS + offset) ||
        sscanf(chip->answer, "OK 0x%" SCNx64, &number) != 1)
        return false;
    *value = (uint8_t)number;
    return true;
}

bool gpio_outside_open(gpio_outside *chip, const char *folder)
{
    memset(chip, 0, sizeof *chip);
    chip->socket = -1;
    if (!find_device(chip, folder))
        return false;
    chip->socket = machine_connect(folder, "lines");
    return chip->socket >= 0 && command(chip, "irq_intercept_out %s\n", chip->device) &&
           gpio_outside_forget(chip);
}

bool gpio_outside_forget(gpio_outside *chip)
{
    uint8_t outputs;
    if (!gpio_outside_watch(chip) || !gpio_outside_read(chip, &outputs, &chip->levels))
        return false;
    chip->edge_count = 0;
    return true;
}

bool gpio_outside_drive(gpio_outside *chip, unsigned line, bool high)
{
    return command(chip, "set_irq_in %s unnamed-gpio-in %u %d\n", chip->device, line, high);
}

bool gpio_outside_read(gpio_outside *chip, uint8_t *outputs, uint8_t *levels)
{
    return read_register(chip, DIRECTION, outputs) && read_register(chip, DATA_OF_ALL_LINES, levels);
}

bool gpio_outside_level_at(const gpio_outside *chip, unsigned line, int64_t time_ns)
{
    bool high = (chip->levels >> line & 1) != 0;
    for (size_t i = 0; i < chip->edge_count && i < OUTSIDE_EDGES_MAX; i++) {
        if (chip->edges[i].line == line && chip->edges[i].time_ns <= time_ns)
            high = chip->edges[i].high;
    }
    return high;
}

size_t gpio_outside_count(const gpio_outside *chip, unsigned line)
{
    size_t count = 0;
    for (size_t i = 0; i < chip->edge_count && i < OUTSIDE_EDGES_MAX; i++)
        count += chip->edges[i].line == line;
    return count;
}

void gpio_outside_close(gpio_outside *chip)
{
    if (chip->socket >= 0)
        close(chip->socket);
}
