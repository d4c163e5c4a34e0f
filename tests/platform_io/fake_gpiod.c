#include "fake_gpiod.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

static const char *const soc_lines[] = {"", "LED", "BUTTON", ""};
static const char *const expander_lines[] = {"", ""};

fake_chip fake_chips[2] = {
    {.name = "gpiochip0", .label = "soc", .line_names = soc_lines, .line_count = 4,
     .lines[3] = {.use = FAKE_INPUT}},
    {.name = "gpiochip2", .label = "expander", .line_names = expander_lines, .line_count = 2},
};
bool fake_chips_fail;
int fake_open_handles;

fake_chip *fake_open(const char *path)
{
    fake_chip *found = NULL;
    if (strcmp(path, "/dev/gpiochip0") == 0)
        found = &fake_chips[0];
    else if (strcmp(path, "/dev/gpiochip2") == 0 || strcmp(path, "/dev/gpiochip7") == 0)
        found = &fake_chips[1];
    errno = strcmp(path, "/dev/gpiochip5") == 0 ? EACCES : ENOENT;
    fake_open_handles += found != NULL;
    return found;
}

bool fake_take(fake_line *line, fake_use use, bool active_low, int pull)
{
    if (line->use != FAKE_FREE) {
        errno = EBUSY;
        return false;
    }
    if (use == FAKE_INPUT && pipe(line->events) != 0)
        return false;
    line->use = use;
    line->active_low = active_low;
    line->pull = pull;
    line->set_calls = 0;
    if (use == FAKE_OUTPUT)
        line->level = active_low;
    fake_open_handles++;
    return true;
}

void fake_free(fake_line *line)
{
    if (line->use == FAKE_INPUT) {
        close(line->events[0]);
        close(line->events[1]);
    }
    line->use = FAKE_FREE;
    fake_open_handles--;
}

int fake_set(fake_line *line, bool on)
{
    line->set_calls++;
    if (fake_chips_fail || line->use != FAKE_OUTPUT) {
        errno = ENODEV;
        return -1;
    }
    line->level = line->active_low ? !on : on;
    return 0;
}

int fake_read_events(const fake_line *line, int64_t *times_ns, int most)
{
    if (fake_chips_fail) {
        errno = ENODEV;
        return -1;
    }
    ssize_t size = read(line->events[0], times_ns, (size_t)most * sizeof *times_ns);
    return size < 0 ? -1 : (int)((size_t)size / sizeof *times_ns);
}

void fake_drive(fake_line *line, bool level, int64_t time_ns)
{
    bool becomes_on = level != line->level && (line->active_low ? !level : level);
    line->level = level;
    if (becomes_on && write(line->events[1], &time_ns, sizeof time_ns) != sizeof time_ns)
        line->level = !level;
}
