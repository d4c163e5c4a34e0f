/* libgpiod 2.x */
#include "gpio_library.h"

#include <errno.h>
#include <gpiod.h>
#include <stdlib.h>

struct gpio_chip {
    struct gpiod_chip *handle;
    struct gpiod_chip_info *info;
};

struct gpio_request {
    struct gpiod_line_request *handle;
    struct gpiod_edge_event_buffer *events;
    unsigned line;
};

bool gpio_library_is_there(void)
{
    return true;
}

gpio_chip *gpio_chip_open(const char *path)
{
    gpio_chip *chip = calloc(1, sizeof *chip);
    if (chip == NULL)
        return NULL;
    chip->handle = gpiod_chip_open(path);
    chip->info = chip->handle != NULL ? gpiod_chip_get_info(chip->handle) : NULL;
    if (chip->info == NULL) {
        int reason = errno;
        gpio_chip_close(chip);
        errno = reason;
        return NULL;
    }
    return chip;
}

const char *gpio_chip_name(const gpio_chip *chip)
{
    return gpiod_chip_info_get_name(chip->info);
}

const char *gpio_chip_label(const gpio_chip *chip)
{
    return gpiod_chip_info_get_label(chip->info);
}

unsigned gpio_chip_line_count(const gpio_chip *chip)
{
    return (unsigned)gpiod_chip_info_get_num_lines(chip->info);
}

int gpio_chip_find_line(const gpio_chip *chip, const char *name)
{
    return gpiod_chip_get_line_offset_from_name(chip->handle, name);
}

void gpio_chip_close(gpio_chip *chip)
{
    if (chip->info != NULL)
        gpiod_chip_info_free(chip->info);
    if (chip->handle != NULL)
        gpiod_chip_close(chip->handle);
    free(chip);
}

static bool put_settings(struct gpiod_line_settings *settings, const gpio_line_wish *wish)
{
    gpiod_line_settings_set_active_low(settings, wish->on_when_low);
    if (wish->pull != GPIO_PULL_NONE && gpiod_line_settings_set_bias(settings, wish->pull == GPIO_PULL_UP
            ? GPIOD_LINE_BIAS_PULL_UP : GPIOD_LINE_BIAS_PULL_DOWN) != 0)
        return false;
    if (wish->input)
        return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_INPUT) == 0 &&
               gpiod_line_settings_set_edge_detection(settings, GPIOD_LINE_EDGE_RISING) == 0;
    return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_OUTPUT) == 0 &&
           gpiod_line_settings_set_output_value(settings, GPIOD_LINE_VALUE_INACTIVE) == 0;
}

static struct gpiod_line_request *request_handle(const gpio_chip *chip, unsigned line, const gpio_line_wish *wish)
{
    struct gpiod_line_request *handle = NULL;
    struct gpiod_line_settings *settings = gpiod_line_settings_new();
    struct gpiod_line_config *lines = gpiod_line_config_new();
    struct gpiod_request_config *request = gpiod_request_config_new();
    if (settings != NULL && lines != NULL && request != NULL && put_settings(settings, wish) &&
        gpiod_line_config_add_line_settings(lines, &line, 1, settings) == 0) {
        gpiod_request_config_set_consumer(request, "tapemark");
        handle = gpiod_chip_request_lines(chip->handle, request, lines);
    }
    int reason = errno;
    gpiod_request_config_free(request);
    gpiod_line_config_free(lines);
    gpiod_line_settings_free(settings);
    errno = reason;
    return handle;
}

gpio_request *gpio_request_line(gpio_chip *chip, unsigned line, const gpio_line_wish *wish)
{
    gpio_request *request = calloc(1, sizeof *request);
    if (request != NULL) {
        request->line = line;
        request->events = gpiod_edge_event_buffer_new(GPIO_EVENTS_MAX);
        request->handle = request->events != NULL ? request_handle(chip, line, wish) : NULL;
    }
    int reason = errno;
    gpio_chip_close(chip);
    if (request != NULL && request->handle == NULL) {
        gpiod_edge_event_buffer_free(request->events);
        free(request);
        request = NULL;
    }
    errno = reason;
    return request;
}

bool gpio_request_set(gpio_request *request, bool on)
{
    return gpiod_line_request_set_value(request->handle, request->line,
                                        on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
}

int gpio_request_descriptor(const gpio_request *request)
{
    return gpiod_line_request_get_fd(request->handle);
}

int gpio_request_read_events(gpio_request *request, int64_t times_ns[GPIO_EVENTS_MAX])
{
    int count = gpiod_line_request_read_edge_events(request->handle, request->events, GPIO_EVENTS_MAX);
    for (int i = 0; i < count; i++) {
        struct gpiod_edge_event *event = gpiod_edge_event_buffer_get_event(request->events, (unsigned long)i);
        times_ns[i] = (int64_t)gpiod_edge_event_get_timestamp_ns(event);
    }
    return count;
}

void gpio_request_release(gpio_request *request)
{
    gpiod_line_request_release(request->handle);
    gpiod_edge_event_buffer_free(request->events);
    free(request);
}
