#include "camera_backend.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

typedef struct camera_kind {
    const char *prefix;
    camera *(*open)(const char *name, error_text *error);
} camera_kind;

static const camera_kind kinds[] = {
    {"v4l2:", camera_v4l2_open},
    {"libcamera:", camera_libcamera_open},
    {"file:", camera_file_open},
    {"raw:", camera_raw_open},
};

void camera_list(camera_teller tell, void *context)
{
    camera_libcamera_list(true, tell, context);
    camera_v4l2_list(tell, context);
    camera_libcamera_list(false, tell, context);
}

static void keep_first(void *context, const camera_description *description)
{
    char *name = context;
    if (name[0] == '\0' && strlen(description->name) < CAMERA_NAME_BYTES)
        snprintf(name, CAMERA_NAME_BYTES, "%s", description->name);
}

static camera *open_named(const char *name, error_text *error)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t length = strlen(kinds[i].prefix);
        if (strncmp(name, kinds[i].prefix, length) != 0)
            continue;
        camera *device = kinds[i].open(name + length, error);
        if (device != NULL)
            snprintf(device->name, sizeof device->name, "%s", name);
        return device;
    }
    error_text_set(error, "expected auto, v4l2:DEVICE, libcamera:NUMBER, file:PATH[@RATE] or raw:LAYOUT,PATH[@RATE]");
    return NULL;
}

camera *camera_open(const char *name, error_text *error)
{
    char first[CAMERA_NAME_BYTES] = "";
    if (strcmp(name, "auto") != 0)
        return open_named(name, error);
    camera_list(keep_first, first);
    if (first[0] == '\0') {
        error_text_set(error, "no camera was found");
        return NULL;
    }
    error_text reason;
    camera *device = open_named(first, &reason);
    if (device == NULL)
        error_text_set(error, "%s: %s", first, reason.text);
    return device;
}

bool camera_configure(camera *device, const camera_wishes *wishes, error_text *error)
{
    return camera_wishes_valid(wishes, error) && device->methods->configure(device, wishes, error);
}

bool camera_set_light(camera *device, int32_t exposure_us, double gain, error_text *error)
{
    camera_wishes wishes = {.exposure_us = exposure_us, .gain = gain};
    return camera_wishes_valid(&wishes, error) && device->methods->set_light(device, exposure_us, gain, error);
}

const camera_settings *camera_settings_of(const camera *device)
{
    return &device->settings;
}

const char *camera_name(const camera *device)
{
    return device->name;
}

camera_status camera_next(camera *device, int timeout_ms, camera_frame *output, error_text *error)
{
    device->methods->release(device);
    return device->methods->next(device, timeout_ms > 0 ? timeout_ms : 0, output, error);
}

void camera_release(camera *device)
{
    device->methods->release(device);
}

int camera_descriptor(const camera *device)
{
    return device->methods->descriptor(device);
}

camera_counts camera_counts_of(const camera *device)
{
    return device->counts;
}

void camera_close(camera *device)
{
    if (device != NULL)
        device->methods->close(device);
}

static int64_t clock_ns(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

int64_t camera_clock_ns(void)
{
    return clock_ns(CLOCK_MONOTONIC);
}

int64_t camera_normal_time_ns(int64_t device_time_ns)
{
    const int64_t credible_ns = INT64_C(10) * 1000 * 1000 * 1000;
    int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
    int64_t awake_time_ns = device_time_ns;
    if (device_time_ns > now_ns)
        awake_time_ns -= clock_ns(CLOCK_BOOTTIME) - now_ns;
    bool credible = awake_time_ns <= now_ns && awake_time_ns > now_ns - credible_ns;
    return credible ? awake_time_ns : now_ns;
}

int camera_left_ms(int64_t deadline_ns)
{
    const int64_t most_ms = 1000 * 1000 * 1000;
    int64_t left_ns = deadline_ns - camera_clock_ns();
    if (left_ns <= 0)
        return 0;
    int64_t left_ms = (left_ns + 999999) / 1000000;
    return (int)(left_ms < most_ms ? left_ms : most_ms);
}

void camera_count_frame(camera *device, uint32_t device_sequence, camera_frame *output)
{
    /* A larger step is a device that numbers frames anew, not a thousand lost ones. */
    const uint32_t step_max = 1000;
    frame_numbers *numbers = &device->numbers;
    uint32_t dropped = numbers->passed_over;
    if (numbers->any) {
        uint32_t step = device_sequence - numbers->last_device_sequence;
        if (step >= 1 && step <= step_max && step - 1 > dropped)
            dropped = step - 1;
    }
    numbers->any = true;
    numbers->last_device_sequence = device_sequence;
    numbers->passed_over = 0;
    output->dropped = dropped;
    output->image.sequence = numbers->next + dropped;
    numbers->next = output->image.sequence + 1;
    device->counts.given++;
    device->counts.dropped += dropped;
}

void camera_pass_over(camera *device)
{
    device->numbers.passed_over++;
}

void camera_restart_numbers(camera *device)
{
    device->numbers.any = false;
}
