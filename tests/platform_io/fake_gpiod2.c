/* As much of libgpiod 2 as is used, over the chips that do not exist. */
#include "fake_gpiod.h"

#include <errno.h>
#include <gpiod.h>
#include <stdlib.h>
#include <string.h>

struct gpiod_chip_info {
    const fake_chip *chip;
};

struct gpiod_line_settings {
    bool input, rising, active_low, starts_on;
    int pull;
};

struct gpiod_line_config {
    unsigned offset;
    struct gpiod_line_settings settings;
};

struct gpiod_request_config {
    char consumer[32];
};

struct gpiod_line_request {
    fake_line *line;
    unsigned offset;
};

struct gpiod_edge_event {
    uint64_t time_ns;
};

struct gpiod_edge_event_buffer {
    size_t capacity, count;
    struct gpiod_edge_event events[FAKE_EVENTS_MAX];
};

static void *new_handle(size_t size)
{
    fake_open_handles++;
    return calloc(1, size);
}

static void free_handle(void *handle)
{
    fake_open_handles -= handle != NULL;
    free(handle);
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

struct gpiod_chip_info *gpiod_chip_get_info(struct gpiod_chip *chip)
{
    struct gpiod_chip_info *info = new_handle(sizeof *info);
    info->chip = (const fake_chip *)(const void *)chip;
    return info;
}

int gpiod_chip_get_line_offset_from_name(struct gpiod_chip *chip, const char *name)
{
    const fake_chip *fake = (const fake_chip *)(const void *)chip;
    for (int i = 0; i < fake->line_count; i++) {
        if (strcmp(fake->line_names[i], name) == 0)
            return i;
    }
    errno = ENOENT;
    return -1;
}

void gpiod_chip_info_free(struct gpiod_chip_info *info)
{
    free_handle(info);
}

const char *gpiod_chip_info_get_name(struct gpiod_chip_info *info)
{
    return info->chip->name;
}

const char *gpiod_chip_info_get_label(struct gpiod_chip_info *info)
{
    return info->chip->label;
}

size_t gpiod_chip_info_get_num_lines(struct gpiod_chip_info *info)
{
    return (size_t)info->chip->line_count;
}

struct gpiod_line_settings *gpiod_line_settings_new(void)
{
    return new_handle(sizeof(struct gpiod_line_settings));
}

void gpiod_line_settings_free(struct gpiod_line_settings *settings)
{
    free_handle(settings);
}

int gpiod_line_settings_set_direction(struct gpiod_line_settings *settings, enum gpiod_line_direction direction)
{
    settings->input = direction == GPIOD_LINE_DIRECTION_INPUT;
    return 0;
}

int gpiod_line_settings_set_edge_detection(struct gpiod_line_settings *settings, enum gpiod_line_edge edge)
{
    settings->rising = edge == GPIOD_LINE_EDGE_RISING;
    return 0;
}

int gpiod_line_settings_set_bias(struct gpiod_line_settings *settings, enum gpiod_line_bias bias)
{
    settings->pull = bias == GPIOD_LINE_BIAS_PULL_UP ? 1 : bias == GPIOD_LINE_BIAS_PULL_DOWN ? -1 : 0;
    return 0;
}

void gpiod_line_settings_set_active_low(struct gpiod_line_settings *settings, bool active_low)
{
    settings->active_low = active_low;
}

int gpiod_line_settings_set_output_value(struct gpiod_line_settings *settings, enum gpiod_line_value value)
{
    settings->starts_on = value == GPIOD_LINE_VALUE_ACTIVE;
    return 0;
}

struct gpiod_line_config *gpiod_line_config_new(void)
{
    return new_handle(sizeof(struct gpiod_line_config));
}

void gpiod_line_config_free(struct gpiod_line_config *config)
{
    free_handle(config);
}

int gpiod_line_config_add_line_settings(struct gpiod_line_config *config, const unsigned int *offsets,
                                        size_t num_offsets, struct gpiod_line_settings *settings)
{
    config->offset = offsets[0];
    config->settings = *settings;
    return num_offsets == 1 ? 0 : -1;
}

struct gpiod_request_config *gpiod_request_config_new(void)
{
    return new_handle(sizeof(struct gpiod_request_config));
}

void gpiod_request_config_free(struct gpiod_request_config *config)
{
    free_handle(config);
}

void gpiod_request_config_set_consumer(struct gpiod_request_config *config, const char *consumer)
{
    strncpy(config->consumer, consumer, sizeof config->consumer - 1);
}

struct gpiod_line_request *gpiod_chip_request_lines(struct gpiod_chip *chip, struct gpiod_request_config *req_cfg,
                                                    struct gpiod_line_config *line_cfg)
{
    fake_line *line = &((fake_chip *)(void *)chip)->lines[line_cfg->offset];
    const struct gpiod_line_settings *settings = &line_cfg->settings;
    errno = EINVAL;
    if (strcmp(req_cfg->consumer, "tapemark") != 0 || settings->starts_on || settings->rising != settings->input ||
        !fake_take(line, settings->input ? FAKE_INPUT : FAKE_OUTPUT, settings->active_low, settings->pull))
        return NULL;
    struct gpiod_line_request *request = new_handle(sizeof *request);
    *request = (struct gpiod_line_request){line, line_cfg->offset};
    return request;
}

void gpiod_line_request_release(struct gpiod_line_request *request)
{
    fake_free(request->line);
    free_handle(request);
}

int gpiod_line_request_set_value(struct gpiod_line_request *request, unsigned int offset, enum gpiod_line_value value)
{
    errno = EINVAL;
    return offset == request->offset ? fake_set(request->line, value == GPIOD_LINE_VALUE_ACTIVE) : -1;
}

int gpiod_line_request_get_fd(struct gpiod_line_request *request)
{
    return request->line->events[0];
}

int gpiod_line_request_read_edge_events(struct gpiod_line_request *request, struct gpiod_edge_event_buffer *buffer,
                                        size_t max_events)
{
    int64_t times_ns[FAKE_EVENTS_MAX];
    errno = EINVAL;
    buffer->count = 0;
    if (max_events > buffer->capacity)
        return -1;
    int count = fake_read_events(request->line, times_ns, (int)max_events);
    for (int i = 0; i < count; i++)
        buffer->events[buffer->count++].time_ns = (uint64_t)times_ns[i];
    return count;
}

struct gpiod_edge_event *gpiod_edge_event_buffer_get_event(struct gpiod_edge_event_buffer *buffer,
                                                           unsigned long index)
{
    errno = EINVAL;
    return index < buffer->count ? &buffer->events[index] : NULL;
}

uint64_t gpiod_edge_event_get_timestamp_ns(struct gpiod_edge_event *event)
{
    return event->time_ns;
}

struct gpiod_edge_event_buffer *gpiod_edge_event_buffer_new(size_t capacity)
{
    struct gpiod_edge_event_buffer *buffer = new_handle(sizeof *buffer);
    buffer->capacity = capacity < FAKE_EVENTS_MAX ? capacity : FAKE_EVENTS_MAX;
    return buffer;
}

void gpiod_edge_event_buffer_free(struct gpiod_edge_event_buffer *buffer)
{
    free_handle(buffer);
}
