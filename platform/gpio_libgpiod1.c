/* libgpiod 1.6 */
#include "gpio_library.h"

#include <errno.h>
#include <gpiod.h>
#include <stdint.h>
#include <stdlib.h>

struct gpio_request {
    struct gpiod_chip *chip;  /* a line lives as long as its chip */
    struct gpiod_line *line;
};

/* The library has no read-only handles, though these calls change nothing. */
static struct gpiod_chip *handle_of(const gpio_chip *chip)
{
    return (struct gpiod_chip *)(uintptr_t)chip;
}

bool gpio_library_is_there(void)
{
    return true;
}

gpio_chip *gpio_chip_open(const char *path)
{
    return (gpio_chip *)gpiod_chip_open(path);
}

const char *gpio_chip_name(const gpio_chip *chip)
{
    return gpiod_chip_name(handle_of(chip));
}

const char *gpio_chip_label(const gpio_chip *chip)
{
    return gpiod_chip_label(handle_of(chip));
}

unsigned gpio_chip_line_count(const gpio_chip *chip)
{
    return gpiod_chip_num_lines(handle_of(chip));
}

int gpio_chip_find_line(const gpio_chip *chip, const char *name)
{
    struct gpiod_line *line = gpiod_chip_find_line(handle_of(chip), name);
    return line != NULL ? (int)gpiod_line_offset(line) : -1;
}

void gpio_chip_close(gpio_chip *chip)
{
    gpiod_chip_close(handle_of(chip));
}

static int flags_of(const gpio_line_wish *wish)
{
    int flags = wish->on_when_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    if (wish->pull == GPIO_PULL_UP)
        flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
    if (wish->pull == GPIO_PULL_DOWN)
        flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
    return flags;
}

gpio_request *gpio_request_line(gpio_chip *chip, unsigned line, const gpio_line_wish *wish)
{
    gpio_request *request = calloc(1, sizeof *request);
    struct gpiod_line *handle = gpiod_chip_get_line(handle_of(chip), line);
    struct gpiod_line_request_config config = {
        "tapemark", wish->input ? GPIOD_LINE_REQUEST_EVENT_RISING_EDGE : GPIOD_LINE_REQUEST_DIRECTION_OUTPUT,
        flags_of(wish),
    };
    if (request == NULL || handle == NULL || gpiod_line_request(handle, &config, 0) != 0) {
        int reason = errno;
        gpio_chip_close(chip);
        free(request);
        errno = reason;
        return NULL;
    }
    request->chip = handle_of(chip);
    request->line = handle;
    return request;
}

bool gpio_request_set(gpio_request *request, bool on)
{
    return gpiod_line_set_value(request->line, on) == 0;
}

int gpio_request_descriptor(const gpio_request *request)
{
    return gpiod_line_event_get_fd(request->line);
}

int gpio_request_read_events(gpio_request *request, int64_t times_ns[GPIO_EVENTS_MAX])
{
    struct gpiod_line_event events[GPIO_EVENTS_MAX];
    int count = gpiod_line_event_read_multiple(request->line, events, GPIO_EVENTS_MAX);
    for (int i = 0; i < count; i++)
        times_ns[i] = (int64_t)events[i].ts.tv_sec * 1000000000 + events[i].ts.tv_nsec;
    return count;
}

void gpio_request_release(gpio_request *request)
{
    gpiod_line_release(request->line);
    gpiod_chip_close(request->chip);
    free(request);
}
