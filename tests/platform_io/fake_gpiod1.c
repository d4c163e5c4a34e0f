/* As much of libgpiod 1.6 as is used, over the chips that do not exist. */
#include "fake_gpiod.h"

#include <errno.h>
#include <gpiod.h>
#include <limits.h>
#include <string.h>

static fake_chip *chip_of(struct gpiod_chip *chip)
{
    return (fake_chip *)(void *)chip;
}

static fake_line *line_of(struct gpiod_line *line)
{
    return (fake_line *)(void *)line;
}

struct gpiod_chip *gpiod_chip_open(const char *path)
{
    return (struct gpiod_chip *)(void *)fake_open(path);
}

void gpiod_chip_close(struct gpiod_chip *chip)
{
    (void)chip;
    fake_open_handles--;
}

const char *gpiod_chip_name(struct gpiod_chip *chip)
{
    return chip_of(chip)->name;
}

const char *gpiod_chip_label(struct gpiod_chip *chip)
{
    return chip_of(chip)->label;
}

unsigned int gpiod_chip_num_lines(struct gpiod_chip *chip)
{
    return (unsigned)chip_of(chip)->line_count;
}

struct gpiod_line *gpiod_chip_get_line(struct gpiod_chip *chip, unsigned int offset)
{
    return (struct gpiod_line *)(void *)&chip_of(chip)->lines[offset];
}

struct gpiod_line *gpiod_chip_find_line(struct gpiod_chip *chip, const char *name)
{
    for (int i = 0; i < chip_of(chip)->line_count; i++) {
        if (strcmp(chip_of(chip)->line_names[i], name) == 0)
            return gpiod_chip_get_line(chip, (unsigned)i);
    }
    errno = ENOENT;
    return NULL;
}

unsigned int gpiod_line_offset(struct gpiod_line *line)
{
    for (int i = 0; i < 2; i++) {
        const fake_line *lines = fake_chips[i].lines;
        if (line_of(line) >= lines && line_of(line) < lines + FAKE_LINES)
            return (unsigned)(line_of(line) - lines);
    }
    return UINT_MAX;
}

int gpiod_line_request(struct gpiod_line *line, const struct gpiod_line_request_config *config, int default_val)
{
    bool input = config->request_type == GPIOD_LINE_REQUEST_EVENT_RISING_EDGE;
    int pull = (config->flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0 ? 1 : 0;
    pull -= (config->flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN) != 0 ? 1 : 0;
    bool known = input || config->request_type == GPIOD_LINE_REQUEST_DIRECTION_OUTPUT;
    errno = EINVAL;
    return known && default_val == 0 && strcmp(config->consumer, "tapemark") == 0 &&
           fake_take(line_of(line), input ? FAKE_INPUT : FAKE_OUTPUT,
                     (config->flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0, pull) ? 0 : -1;
}

void gpiod_line_release(struct gpiod_line *line)
{
    fake_free(line_of(line));
}

int gpiod_line_set_value(struct gpiod_line *line, int value)
{
    return fake_set(line_of(line), value != 0);
}

int gpiod_line_event_get_fd(struct gpiod_line *line)
{
    return line_of(line)->events[0];
}

int gpiod_line_event_read_multiple(struct gpiod_line *line, struct gpiod_line_event *events, unsigned int num_events)
{
    int64_t times_ns[FAKE_EVENTS_MAX];
    int most = num_events < FAKE_EVENTS_MAX ? (int)num_events : FAKE_EVENTS_MAX;
    int count = fake_read_events(line_of(line), times_ns, most);
    for (int i = 0; i < count; i++) {
        events[i].ts.tv_sec = (time_t)(times_ns[i] / 1000000000);
        events[i].ts.tv_nsec = (long)(times_ns[i] % 1000000000);
        events[i].event_type = GPIOD_LINE_EVENT_RISING_EDGE;
    }
    return count;
}
