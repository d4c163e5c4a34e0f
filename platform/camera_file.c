/* Recordings and pictures, played as if a camera gave them. */
#include "camera_backend.h"
#include "file_formats.h"
#include "input_list.h"
#include "played_input.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

typedef enum pace { PACE_RECORDED, PACE_RATE, PACE_FREE } pace;

static const double rate_without_times_hz = 30;

/* Frames that are passed over in one call. A file that takes longer to read than to play would never be caught up
 * with: it is played slower. */
enum { PASSED_OVER_MAX = 100 };

/* A frame that was read, and when it is to be given. */
typedef struct played_frame {
    frame image;
    recorded_frame recorded;
    int64_t due_ns;
} played_frame;

typedef struct file_camera {
    camera base;
    input_list inputs;
    size_t input;            /* that is read from */
    bool headless;
    frame_layout layout;     /* of headless frames */
    played_input playing;    /* closed between two inputs */
    pace pace;
    double rate_hz;
    double wished_hz;        /* by whom it was set up */
    int timer;               /* readable from the time on that the next frame is due */

    /* The frame that comes next was read already, to know when it is due. */
    camera_status ahead;     /* CAMERA_TIMEOUT: not yet read */
    error_text ahead_error;
    played_frame next_one;
    frame_buffer copy;       /* of a frame whose place in the source was taken by the one behind it */
    int64_t period_ns;       /* to the frame before */
    bool source_has_begun;
    int64_t source_first_time_ns;
    int64_t source_begin_ns;
    uint64_t frame_count;    /* of all inputs */
} file_camera;

/* ---- Reading ahead -------------------------------------------------------------------------------------- */

static camera_status fail(file_camera *self, const char *reason)
{
    if (self->inputs.count > 1)
        error_text_set(&self->ahead_error, "%.150s: %.240s", self->inputs.files[self->input].path, reason);
    else
        error_text_set(&self->ahead_error, "%s", reason);
    return CAMERA_FAILED;
}

static camera_status open_input(file_camera *self)
{
    error_text reason;
    const input_file *file = &self->inputs.files[self->input];
    self->source_has_begun = false;
    if (!played_input_open(&self->playing, file->path, file->raw ? &self->layout : NULL, &reason))
        return fail(self, reason.text);
    return CAMERA_FRAME;
}

/* The next frame of this input; CAMERA_END at its end. */
static camera_status read_frame(file_camera *self)
{
    error_text reason;
    switch (played_input_next(&self->playing, self->frame_count, &self->next_one.image, &self->next_one.recorded,
                              &reason)) {
    case FRAME_READY:
        return CAMERA_FRAME;
    case FRAME_END:
        return CAMERA_END;
    case FRAME_FAILED:
        break;
    }
    return fail(self, reason.text);
}

/* When a frame is due by its recorded time, counted from the first one of its input, which comes a period after the
 * last one of the input before. */
static int64_t recorded_due_ns(file_camera *self, int64_t last_due_ns)
{
    const int64_t longest_ns = INT64_C(1) << 56;  /* two years */
    int64_t time_ns = self->next_one.recorded.time_ns;
    if (!self->source_has_begun) {
        self->source_first_time_ns = time_ns;
        self->source_begin_ns = self->frame_count == 0 ? last_due_ns : last_due_ns + self->period_ns;
    }
    self->source_has_begun = true;
    if (time_ns == FRAME_TIME_UNKNOWN || self->source_first_time_ns == FRAME_TIME_UNKNOWN)
        return self->frame_count == 0 ? last_due_ns : last_due_ns + self->period_ns;
    int64_t since_first_ns = time_ns - self->source_first_time_ns;
    if (since_first_ns > longest_ns)
        since_first_ns = longest_ns;
    int64_t due_ns = self->source_begin_ns + since_first_ns;
    return due_ns > last_due_ns ? due_ns : last_due_ns;
}

static bool has_own_times(const file_camera *self)
{
    return self->pace == PACE_RECORDED && self->source_first_time_ns != FRAME_TIME_UNKNOWN;
}

static void keep_period(file_camera *self, int64_t period_ns)
{
    self->period_ns = period_ns;
    if (has_own_times(self) && self->frame_count > 0)
        self->base.settings.mode.rate_hz = 1e9 / (double)period_ns;
}

static void find_due_time(file_camera *self)
{
    int64_t last_due_ns = self->next_one.due_ns;
    switch (self->pace) {
    case PACE_RECORDED:
        self->next_one.due_ns = recorded_due_ns(self, last_due_ns);
        if (self->next_one.due_ns > last_due_ns)
            keep_period(self, self->next_one.due_ns - last_due_ns);
        break;
    case PACE_RATE:
        self->next_one.due_ns = self->frame_count == 0 ? last_due_ns : last_due_ns + self->period_ns;
        break;
    case PACE_FREE:
        self->next_one.due_ns = camera_clock_ns();
        break;
    }
}

static void arm_timer(const file_camera *self)
{
    int64_t due_ns = self->ahead == CAMERA_FRAME && self->next_one.due_ns > 0 ? self->next_one.due_ns : 1;
    struct itimerspec when = {.it_value = {(time_t)(due_ns / 1000000000), (long)(due_ns % 1000000000)}};
    timerfd_settime(self->timer, TFD_TIMER_ABSTIME, &when, NULL);
}

static void read_ahead(file_camera *self)
{
    do {
        if (self->playing.source == NULL)
            self->ahead = self->input < self->inputs.count ? open_input(self) : CAMERA_END;
        if (self->playing.source == NULL)
            break;
        self->ahead = read_frame(self);
        if (self->ahead == CAMERA_END) {
            played_input_close(&self->playing);
            self->input++;
        }
    } while (self->ahead == CAMERA_END);
    if (self->ahead == CAMERA_FRAME) {
        find_due_time(self);
        self->frame_count++;
    }
    arm_timer(self);
}

/* ---- The camera ----------------------------------------------------------------------------------------- */

/* Not known of free ones, and of a recording with times of its own not before its second frame. */
static double rate_at_first_hz(const file_camera *self)
{
    return self->pace == PACE_FREE || has_own_times(self) ? 0 : self->rate_hz;
}

/* A recording is played as it is: of all wishes the rate alone counts, at first, where nothing else tells it. */
static bool configure(camera *base, const camera_wishes *wishes, error_text *error)
{
    file_camera *self = (file_camera *)base;
    if (self->timer >= 0 && wishes->rate_hz != self->wished_hz)
        error_text_set(error, "is a recording: its rate cannot be set");
    if (self->timer >= 0)
        return wishes->rate_hz == self->wished_hz;
    self->wished_hz = wishes->rate_hz;
    self->timer = timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (self->timer < 0) {
        error_text_set(error, "cannot be played: %s", strerror(errno));
        return false;
    }
    if (self->pace != PACE_RATE)
        self->rate_hz = wishes->rate_hz > 0 ? wishes->rate_hz : rate_without_times_hz;
    self->period_ns = (int64_t)llround(1e9 / self->rate_hz);
    self->next_one.due_ns = camera_clock_ns();
    read_ahead(self);
    if (self->ahead == CAMERA_FAILED) {
        *error = self->ahead_error;
        return false;
    }
    if (self->ahead == CAMERA_FRAME) {
        const frame_layout *layout = &self->next_one.image.layout;
        base->settings.mode = (camera_mode){layout->format, false, layout->width_px, layout->height_px,
                                            rate_at_first_hz(self)};
    }
    return true;
}

static bool set_light(camera *base, int32_t exposure_us, double gain, error_text *error)
{
    (void)base;
    if (exposure_us == 0 && gain == 0)
        return true;
    error_text_set(error, "is a recording: its light cannot be set");
    return false;
}

static bool keep_copy(file_camera *self, played_frame *kept, error_text *error)
{
    size_t bytes = frame_layout_size_bytes(&self->next_one.image.layout);
    if (!frame_buffer_resize(&self->copy, bytes, error))
        return false;
    *kept = self->next_one;
    memcpy(self->copy.bytes, kept->image.data, bytes);
    kept->image.data = self->copy.bytes;
    return true;
}

/* Passes over all frames behind which another one is due. That takes reading on, so that the frame to be given may
 * be one that was kept, and the next one is there already. CAMERA_TIMEOUT when it is the next one. */
static camera_status find_newest(file_camera *self, played_frame *kept, error_text *error)
{
    int64_t now_ns = camera_clock_ns();
    for (int passed_over = 0; passed_over < PASSED_OVER_MAX; passed_over++) {
        if (self->pace == PACE_FREE || self->ahead != CAMERA_FRAME ||
            self->next_one.due_ns + self->period_ns > now_ns)
            return CAMERA_TIMEOUT;
        if (!keep_copy(self, kept, error))
            return CAMERA_FAILED;
        read_ahead(self);
        if (self->ahead != CAMERA_FRAME || self->next_one.due_ns > now_ns)
            return CAMERA_FRAME;
        camera_pass_over(&self->base);
    }
    self->source_begin_ns += now_ns - self->next_one.due_ns;
    self->next_one.due_ns = now_ns;
    return CAMERA_TIMEOUT;
}

static void sleep_until(int64_t time_ns)
{
    struct timespec when = {(time_t)(time_ns / 1000000000), (long)(time_ns % 1000000000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, NULL);
}

/* Waits for the next frame to be due, but not beyond the deadline. Signals may end a sleep early. */
static bool wait_until_due(const file_camera *self, int64_t deadline_ns)
{
    int64_t due_ns = self->next_one.due_ns;
    for (int64_t now_ns = camera_clock_ns(); now_ns < due_ns; now_ns = camera_clock_ns()) {
        if (now_ns >= deadline_ns)
            return false;
        sleep_until(due_ns < deadline_ns ? due_ns : deadline_ns);
    }
    return true;
}

static camera_status hand_out(file_camera *self, const played_frame *given, camera_frame *output)
{
    output->image = given->image;
    output->image.time_ns = self->pace == PACE_FREE ? camera_clock_ns() : given->due_ns;
    output->exposure_us = given->recorded.exposure_us;
    camera_count_frame(&self->base, (uint32_t)given->recorded.sequence, output);
    return CAMERA_FRAME;
}

static camera_status next(camera *base, int timeout_ms, camera_frame *output, error_text *error)
{
    file_camera *self = (file_camera *)base;
    int64_t deadline_ns = camera_clock_ns() + (int64_t)timeout_ms * 1000000;
    played_frame kept;
    if (self->timer < 0) {
        error_text_set(error, "is not set up");
        return CAMERA_FAILED;
    }
    camera_status status = find_newest(self, &kept, error);
    if (status == CAMERA_FRAME)
        return hand_out(self, &kept, output);
    if (status == CAMERA_FAILED)
        return status;
    if (self->ahead != CAMERA_FRAME) {
        *error = self->ahead_error;
        return self->ahead;
    }
    if (!wait_until_due(self, deadline_ns))
        return CAMERA_TIMEOUT;
    self->ahead = CAMERA_TIMEOUT;
    return hand_out(self, &self->next_one, output);
}

static void release(camera *base)
{
    file_camera *self = (file_camera *)base;
    if (self->timer >= 0 && self->ahead == CAMERA_TIMEOUT)
        read_ahead(self);
}

static int descriptor(const camera *base)
{
    return ((const file_camera *)base)->timer;
}

static void close_camera(camera *base)
{
    file_camera *self = (file_camera *)base;
    played_input_close(&self->playing);
    input_list_release(&self->inputs);
    free(self->copy.bytes);
    if (self->timer >= 0)
        close(self->timer);
    free(self);
}

/* ---- Names ---------------------------------------------------------------------------------------------- */

/* What follows the last @ is a rate, unless the whole is the name of something that is there. False, with an error,
 * when it is none. */
static bool split_rate(char *path, pace *kind, double *rate_hz, error_text *error)
{
    struct stat ignored;
    char *at = strrchr(path, '@');
    *kind = PACE_RECORDED;
    if (at == NULL || stat(path, &ignored) == 0)
        return true;
    if (strcmp(at + 1, "max") == 0) {
        *kind = PACE_FREE;
    } else {
        char *end;
        *rate_hz = strtod(at + 1, &end);
        *kind = PACE_RATE;
        if (at[1] < '0' || at[1] > '9' || *end != '\0' || !(*rate_hz >= 0.001 && *rate_hz <= 10000)) {
            error_text_set(error, "is not there, and '%.20s' after it is no rate: 0.001 to 10000 frames a second, or "
                           "max", at + 1);
            return false;
        }
    }
    *at = '\0';
    return true;
}

static bool find_inputs(file_camera *self, const char *path, error_text *error)
{
    size_t skipped_count;
    if (input_is_directory(path))
        return input_list_add_directory(&self->inputs, path,
                                        self->headless ? pixel_format_describe(self->layout.format)->name : NULL,
                                        &skipped_count, error);
    if (!input_list_add(&self->inputs, path, self->headless, error))
        return false;
    /* So that a name that is wrong is told at once. */
    self->ahead = open_input(self);
    if (self->ahead == CAMERA_FAILED) {
        *error = self->ahead_error;
        return false;
    }
    self->ahead = CAMERA_TIMEOUT;
    return true;
}

static camera *open_camera(const char *name, const frame_layout *layout, error_text *error)
{
    static const camera_methods methods = {configure, set_light, next, release, descriptor, close_camera};
    file_camera *self = calloc(1, sizeof *self);
    char *path = strdup(name);
    if (self == NULL || path == NULL) {
        error_text_set(error, "not enough memory");
        free(self);
        free(path);
        return NULL;
    }
    self->base.methods = &methods;
    self->timer = -1;
    self->ahead = CAMERA_TIMEOUT;
    self->headless = layout != NULL;
    if (layout != NULL)
        self->layout = *layout;
    bool found = split_rate(path, &self->pace, &self->rate_hz, error) && find_inputs(self, path, error);
    free(path);
    if (!found) {
        close_camera(&self->base);
        return NULL;
    }
    return &self->base;
}

camera *camera_file_open(const char *name, error_text *error)
{
    return open_camera(name, NULL, error);
}

camera *camera_raw_open(const char *name, error_text *error)
{
    frame_layout layout;
    char text[80] = "";
    const char *comma = strchr(name, ',');
    if (comma == NULL || (size_t)(comma - name) >= sizeof text) {
        error_text_set(error, "expected raw:LAYOUT,PATH[@RATE], as in raw:GREY:640x480,capture.bin");
        return NULL;
    }
    memcpy(text, name, (size_t)(comma - name));
    if (!frame_layout_parse(text, &layout, error))
        return NULL;
    return open_camera(comma + 1, &layout, error);
}
