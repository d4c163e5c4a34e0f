/* Video4Linux cameras: buffers that the driver fills and shows to us, one of which may be out at a time. */
#include "camera_backend.h"
#include "jpeg_frame.h"
#include "v4l2_device.h"
#include "v4l2_stream.h"
#include "v4l2_times.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FAILURES_MAX = 8,    /* of the kind that may pass, in a row, before the camera counts as broken */
    DEVICES_MAX = 64
};

typedef struct v4l2_camera {
    camera base;
    v4l2_device device;
    v4l2_picture picture;
    v4l2_stream stream;
    uint32_t had_to_fill;     /* buffers that the driver had since we looked last */
    int held;                 /* the buffer that is out; -1: none */
    int failures;             /* in a row */
    int64_t last_stamp_ns;
    uint32_t last_sequence;
    v4l2_delay delay;
    bool refused;             /* the frame before was too old: the next one is as new as it gets */
    bool promised;            /* poll() found a buffer ready */
    jpeg_frame jpeg;
} v4l2_camera;

/* ---- Setting up ------------------------------------------------------------------------------------------ */

static bool set_up(v4l2_camera *self, const camera_wishes *wishes, error_text *error)
{
    v4l2_device *device = &self->device;
    camera_settings *settings = &self->base.settings;
    camera_region region = wishes->region;

    v4l2_device_list_modes(device, wishes);
    const camera_mode *chosen = camera_mode_choose(device->modes, device->mode_count, wishes, error);
    if (chosen == NULL)
        return false;
    camera_mode mode = *chosen;
    if (!v4l2_device_set_region(device, &(camera_region){0}, error) ||
        !v4l2_device_set_picture(device, &mode, &self->picture, error))
        return false;
    if (region.width_px > 0) {
        if (!v4l2_device_set_region(device, &region, error))
            return false;
        mode.width_px = region.width_px;
        mode.height_px = region.height_px;
        if (!v4l2_device_set_picture(device, &mode, &self->picture, error))
            return false;
    }
    mode.width_px = self->picture.layout.width_px;
    mode.height_px = self->picture.layout.height_px;
    mode.rate_hz = v4l2_device_set_rate(device, wishes->rate_hz > 0 ? wishes->rate_hz : mode.rate_hz);
    *settings = (camera_settings){mode, wishes->exposure_us, wishes->gain, region};
    return v4l2_device_set_light(device, mode.width_px, &settings->exposure_us, &settings->gain, error);
}

static bool start(v4l2_camera *self, error_text *error)
{
    size_t frame_bytes = self->base.settings.mode.jpeg ? 1 : frame_layout_size_bytes(&self->picture.layout);
    if (!v4l2_stream_start(&self->stream, self->device.descriptor, frame_bytes, error))
        return false;
    self->had_to_fill = self->stream.with_driver;
    self->failures = 0;
    self->last_stamp_ns = 0;
    self->refused = false;
    self->promised = false;
    v4l2_delay_begin(&self->delay);
    camera_restart_numbers(&self->base);
    return true;
}

static bool configure(camera *base, const camera_wishes *wishes, error_text *error)
{
    v4l2_camera *self = (v4l2_camera *)base;
    v4l2_stream_stop(&self->stream);
    self->held = -1;
    if (set_up(self, wishes, error) && start(self, error))
        return true;
    v4l2_stream_stop(&self->stream);
    return false;
}

static bool set_light(camera *base, int32_t exposure_us, double gain, error_text *error)
{
    v4l2_camera *self = (v4l2_camera *)base;
    if (!self->stream.running) {
        error_text_set(error, "is not set up");
        return false;
    }
    if (!v4l2_device_set_light(&self->device, base->settings.mode.width_px, &exposure_us, &gain, error))
        return false;
    base->settings.exposure_us = exposure_us;
    base->settings.gain = gain;
    return true;
}

/* ---- Frames --------------------------------------------------------------------------------------------- */

/* A device that was unplugged answers everything with ENODEV, but may fail in other ways first. */
static camera_status explain_failure(v4l2_camera *self, int failure, error_text *error)
{
    struct v4l2_capability ignored;
    if (failure == ENODEV || failure == ENXIO ||
        v4l2_call(self->device.descriptor, VIDIOC_QUERYCAP, &ignored) == ENODEV) {
        error_text_set(error, "is gone: it was unplugged, or its driver was removed");
        return CAMERA_GONE;
    }
    error_text_set(error, "gives no more frames: %s", strerror(failure));
    return CAMERA_FAILED;
}

/* Failures that may pass are let pass a few times. */
static camera_status bear_failure(v4l2_camera *self, error_text *error)
{
    error_text reason;
    camera_status status = explain_failure(self, EIO, &reason);
    if (status == CAMERA_FAILED && ++self->failures < FAILURES_MAX)
        return CAMERA_TIMEOUT;
    *error = reason;
    return status;
}

static bool is_whole(const v4l2_camera *self, const struct v4l2_buffer *buffer)
{
    if (buffer->flags & V4L2_BUF_FLAG_ERROR)
        return false;
    if (self->base.settings.mode.jpeg)
        return buffer->bytesused > 0 && buffer->bytesused <= self->stream.buffers[buffer->index].size;
    return buffer->bytesused >= frame_layout_size_bytes(&self->picture.layout);
}

/* A driver that is stuck may show the last frame again. */
static bool is_repeated(const v4l2_camera *self, const struct v4l2_buffer *buffer)
{
    return self->base.numbers.any && buffer->sequence == self->last_sequence &&
           v4l2_stamp_ns(buffer) == self->last_stamp_ns;
}

/* CAMERA_FRAME: the driver has given back a buffer, whatever is in it; CAMERA_TIMEOUT: it has none. */
static camera_status take_buffer(v4l2_camera *self, struct v4l2_buffer *buffer, error_text *error)
{
    int failure = v4l2_stream_take(&self->stream, buffer);
    if (failure == EAGAIN)
        return CAMERA_TIMEOUT;
    if (failure == EIO) {
        self->base.counts.damaged++;
        return bear_failure(self, error);
    }
    if (failure == EBADSLT) {
        error_text_set(error, "gives back buffer %u, which it was not given", buffer->index);
        return CAMERA_FAILED;
    }
    if (failure != 0)
        return explain_failure(self, failure, error);
    self->failures = 0;
    return CAMERA_FRAME;
}

static camera_status pass_over(v4l2_camera *self, uint32_t index, error_text *error)
{
    camera_pass_over(&self->base);
    int failure = v4l2_stream_give(&self->stream, index);
    return failure == 0 ? CAMERA_TIMEOUT : explain_failure(self, failure, error);
}

/* Takes all that is ready, and keeps the newest whole frame of it. `starved` tells that the driver had nothing left
 * to fill, so that even the newest may be old. */
static camera_status take_newest(v4l2_camera *self, struct v4l2_buffer *newest, bool *starved, error_text *error)
{
    struct v4l2_buffer buffer;
    bool any = false;
    uint32_t taken = 0;
    camera_status status = CAMERA_FRAME;
    /* The bound is for drivers that fill buffers faster than we can look. */
    while (taken < 2 * V4L2_STREAM_BUFFERS_MAX && (status = take_buffer(self, &buffer, error)) == CAMERA_FRAME) {
        bool whole = is_whole(self, &buffer) && !is_repeated(self, &buffer);
        uint32_t unwanted = whole ? newest->index : buffer.index;
        taken++;
        self->base.counts.damaged += !whole;
        if (any || !whole)
            status = pass_over(self, unwanted, error);
        if (whole)
            *newest = buffer;
        any = any || whole;
        if (status == CAMERA_GONE || status == CAMERA_FAILED)
            return status;
    }
    *starved = taken >= self->had_to_fill;
    if (status == CAMERA_GONE || status == CAMERA_FAILED)
        return status;
    return any ? CAMERA_FRAME : CAMERA_TIMEOUT;
}

static int64_t frame_time_ns(const v4l2_camera *self)
{
    double rate_hz = self->base.settings.mode.rate_hz;
    return rate_hz > 0 ? (int64_t)(1e9 / rate_hz) : 0;
}

/* Readies the frame; CAMERA_TIMEOUT when there is none in it after all. */
static camera_status hand_out(v4l2_camera *self, const struct v4l2_buffer *buffer, camera_frame *output,
                              error_text *error)
{
    const frame_layout *layout = &self->picture.layout;
    const uint8_t *bytes = self->stream.buffers[buffer->index].bytes;
    self->last_stamp_ns = v4l2_stamp_ns(buffer);
    self->last_sequence = buffer->sequence;
    output->exposure_us = self->base.settings.exposure_us;
    output->image = (frame){*layout, bytes, 0, v4l2_middle_of_exposure_ns(buffer, frame_time_ns(self),
                                                                           output->exposure_us)};
    self->held = (int)buffer->index;

    if (self->base.settings.mode.jpeg) {
        bool decoded = jpeg_frame_decode(&self->jpeg, bytes, buffer->bytesused, layout);
        int failure = v4l2_stream_give(&self->stream, buffer->index);
        self->held = -1;
        output->image.data = self->jpeg.picture.pixels;
        if (failure != 0)
            return explain_failure(self, failure, error);
        if (!decoded) {
            self->base.counts.damaged++;
            camera_pass_over(&self->base);
            return CAMERA_TIMEOUT;
        }
    }
    camera_count_frame(&self->base, buffer->sequence, output);
    return CAMERA_FRAME;
}

static bool picture_has_changed(v4l2_camera *self)
{
    struct v4l2_event event = {0};
    return v4l2_call(self->device.descriptor, VIDIOC_DQEVENT, &event) == 0 &&
           event.type == V4L2_EVENT_SOURCE_CHANGE &&
           (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0;
}

/* CAMERA_FRAME: it is worth looking again. When there is no time left, what is wrong is noticed all the same. */
static camera_status wait_for_buffer(v4l2_camera *self, int64_t deadline_ns, error_text *error)
{
    struct pollfd waiting = {.fd = self->device.descriptor, .events = POLLIN | POLLPRI};
    int left_ms = camera_left_ms(deadline_ns);
    camera_status status = left_ms > 0 ? CAMERA_FRAME : CAMERA_TIMEOUT;
    int ready = poll(&waiting, 1, left_ms);
    self->promised = ready > 0 && (waiting.revents & POLLIN) != 0;
    if (ready == 0)
        return CAMERA_TIMEOUT;
    if (ready < 0)
        return errno == EINTR ? status : explain_failure(self, errno, error);
    if (waiting.revents & POLLPRI && picture_has_changed(self)) {
        error_text_set(error, "has changed the size of its picture");
        return CAMERA_FAILED;
    }
    if (!self->promised && waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) {
        camera_status borne = bear_failure(self, error);
        if (borne != CAMERA_TIMEOUT)
            return borne;
        poll(NULL, 0, left_ms < 10 ? left_ms : 10);
    }
    return status;
}

/* CAMERA_FRAME: a frame that is as new as can be had, in `buffer`. */
static camera_status choose_frame(v4l2_camera *self, bool just_asked, struct v4l2_buffer *buffer, error_text *error)
{
    const int breath_ms = 1;
    bool starved = false;
    camera_status status = take_newest(self, buffer, &starved, error);
    if (status == CAMERA_FRAME) {
        bool old = v4l2_delay_is_old(&self->delay, buffer, frame_time_ns(self));
        bool refused_before = self->refused;
        self->refused = just_asked && (starved || (old && !refused_before));
        if (self->refused)
            status = pass_over(self, buffer->index, error);
        else if (old)
            v4l2_delay_accept(&self->delay, buffer);
    } else if (status == CAMERA_TIMEOUT && self->promised) {
        /* Whoever asks as often as poll() promises something would be busy with nothing. */
        poll(NULL, 0, breath_ms);
    }
    return status;
}

static camera_status next(camera *base, int timeout_ms, camera_frame *output, error_text *error)
{
    v4l2_camera *self = (v4l2_camera *)base;
    int64_t deadline_ns = camera_clock_ns() + (int64_t)timeout_ms * 1000000;
    bool just_asked = true;
    camera_status status;

    if (!self->stream.running) {
        error_text_set(error, "is not set up");
        return CAMERA_FAILED;
    }
    do {
        struct v4l2_buffer buffer = {0};
        status = choose_frame(self, just_asked, &buffer, error);
        if (status == CAMERA_FRAME)
            status = hand_out(self, &buffer, output, error);
        just_asked = false;
        self->had_to_fill = self->stream.with_driver;
        if (status == CAMERA_TIMEOUT && self->stream.with_driver == 0) {
            error_text_set(error, "does not take its buffers back");
            return CAMERA_FAILED;
        }
        if (status != CAMERA_TIMEOUT)
            return status;
        status = wait_for_buffer(self, deadline_ns, error);
    } while (status == CAMERA_FRAME);
    return status;
}

static void release(camera *base)
{
    v4l2_camera *self = (v4l2_camera *)base;
    if (self->held >= 0)
        v4l2_stream_give(&self->stream, (uint32_t)self->held);
    self->held = -1;
}

static int descriptor(const camera *base)
{
    const v4l2_camera *self = (const v4l2_camera *)base;
    return self->stream.running ? self->device.descriptor : -1;
}

static void close_camera(camera *base)
{
    v4l2_camera *self = (v4l2_camera *)base;
    v4l2_stream_stop(&self->stream);
    v4l2_device_close(&self->device);
    jpeg_frame_release(&self->jpeg);
    free(self);
}

/* ---- Open and list -------------------------------------------------------------------------------------- */

camera *camera_v4l2_open(const char *name, error_text *error)
{
    static const camera_methods methods = {configure, set_light, next, release, descriptor, close_camera};
    struct v4l2_event_subscription changes = {.type = V4L2_EVENT_SOURCE_CHANGE};
    v4l2_camera *self = calloc(1, sizeof *self);
    if (self == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    self->base.methods = &methods;
    self->held = -1;
    if (!v4l2_device_open(&self->device, name, error)) {
        free(self);
        return NULL;
    }
    /* Most cameras know no such change, and say so. */
    v4l2_call(self->device.descriptor, VIDIOC_SUBSCRIBE_EVENT, &changes);
    return &self->base;
}

void camera_v4l2_list(camera_teller tell, void *context)
{
    const camera_wishes any = {0};
    for (int number = 0; number < DEVICES_MAX; number++) {
        char name[40];
        error_text ignored;
        v4l2_device device;
        snprintf(name, sizeof name, "v4l2:/dev/video%d", number);
        if (!v4l2_device_open(&device, name + sizeof "v4l2:" - 1, &ignored))
            continue;
        v4l2_device_list_modes(&device, &any);
        if (device.mode_count > 0 && !device.routed)
            tell(context, &(camera_description){name, device.card, device.modes, device.mode_count});
        v4l2_device_close(&device);
    }
}
