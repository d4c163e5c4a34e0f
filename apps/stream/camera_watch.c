#include "camera_watch.h"

#include <stdio.h>
#include <string.h>

static const int64_t first_pause_ns = 500000000, longest_pause_ns = 8000000000;

/* Without a frame for that long, the camera is silent; then it is opened again. */
static const int64_t silence_ns = 500000000, patience_ns = 3000000000;

static void tell(camera_watch *watch, const char *reason)
{
    watch->news = true;
    error_text_set(&watch->message, "camera %.150s: %.240s", watch->name, reason);
}

static void plan_retry(camera_watch *watch, int64_t now_ns)
{
    watch->retry_ns = now_ns + watch->pause_ns;
    watch->pause_ns = watch->pause_ns * 2 < longest_pause_ns ? watch->pause_ns * 2 : longest_pause_ns;
}

/* Only the first of several failures in a row is told. */
static void lose(camera_watch *watch, const char *reason, int64_t now_ns)
{
    camera_close(watch->device);
    watch->device = NULL;
    if (watch->state != CAMERA_WATCH_LOST) {
        watch->failures++;
        tell(watch, reason);
    }
    watch->state = CAMERA_WATCH_LOST;
    plan_retry(watch, now_ns);
}

static bool open_device(camera_watch *watch, const stream_settings *settings, error_text *error)
{
    camera_wishes wishes = settings_camera_wishes(settings);
    watch->device = camera_open(watch->name, error);
    if (watch->device == NULL)
        return false;
    if (camera_configure(watch->device, &wishes, error))
        return true;
    camera_close(watch->device);
    watch->device = NULL;
    return false;
}

bool camera_watch_begin(camera_watch *watch, const stream_settings *settings, error_text *error)
{
    camera_watch fresh = {.state = CAMERA_WATCH_RUNNING, .pause_ns = first_pause_ns, .seq = watch->seq,
                          .failures = watch->failures, .repeat = settings->repeat};
    int64_t now_ns = camera_clock_ns();
    memcpy(fresh.name, settings->camera, sizeof fresh.name);
    fresh.recorded = strncmp(fresh.name, "file:", 5) == 0 || strncmp(fresh.name, "raw:", 4) == 0;
    fresh.last_frame_ns = now_ns;
    camera_close(watch->device);
    *watch = fresh;
    if (open_device(watch, settings, error))
        return true;
    if (watch->recorded)
        return false;
    lose(watch, error->text, now_ns);
    return true;
}

int camera_watch_descriptor(const camera_watch *watch)
{
    return watch->device != NULL && watch->state != CAMERA_WATCH_ENDED ? camera_descriptor(watch->device) : -1;
}

static int64_t silence_limit_ns(const camera_watch *watch)
{
    int64_t periods_ns = watch->period_ns * 5 / 2;
    return periods_ns > silence_ns ? periods_ns : silence_ns;
}

static int64_t end_of_patience_ns(const camera_watch *watch)
{
    return watch->last_frame_ns + silence_limit_ns(watch) + patience_ns;
}

int64_t camera_watch_wake_ns(const camera_watch *watch)
{
    switch (watch->state) {
    case CAMERA_WATCH_RUNNING:
        return watch->last_frame_ns + silence_limit_ns(watch);
    case CAMERA_WATCH_SILENT:
        return watch->recorded ? INT64_MAX : end_of_patience_ns(watch);
    case CAMERA_WATCH_LOST:
        return watch->device != NULL ? end_of_patience_ns(watch) : watch->retry_ns;
    case CAMERA_WATCH_ENDED:
        break;
    }
    return INT64_MAX;
}

static void reopen(camera_watch *watch, const stream_settings *settings, int64_t now_ns)
{
    error_text reason;
    if (!open_device(watch, settings, &reason)) {
        lose(watch, reason.text, now_ns);
        return;
    }
    /* Whether it is back, its frames tell. */
    watch->last_frame_ns = camera_clock_ns();
    watch->frames = 0;
}

static void note_frame(camera_watch *watch, const camera_frame *got, int64_t now_ns)
{
    if (watch->state == CAMERA_WATCH_LOST || (watch->state == CAMERA_WATCH_SILENT && !watch->recorded))
        tell(watch, "gives frames again");
    watch->period_ns = watch->frames > 0 ? now_ns - watch->last_frame_ns : 0;
    watch->frames++;
    watch->state = CAMERA_WATCH_RUNNING;
    watch->pause_ns = first_pause_ns;
    watch->last_frame_ns = now_ns;
    watch->seq = (uint16_t)(watch->seq + got->dropped + 1);
}

/* At the end of a recording. */
static void end(camera_watch *watch, const stream_settings *settings, int64_t now_ns)
{
    error_text reason;
    if (!watch->repeat) {
        watch->state = CAMERA_WATCH_ENDED;
        return;
    }
    if (watch->frames == 0) {
        lose(watch, "holds no frames", now_ns);
        return;
    }
    camera_close(watch->device);
    watch->frames = 0;
    if (!open_device(watch, settings, &reason))
        lose(watch, reason.text, now_ns);
}

/* A camera that is there and yet gives nothing. */
static void look_after(camera_watch *watch, int64_t now_ns)
{
    if (watch->state == CAMERA_WATCH_RUNNING && now_ns >= camera_watch_wake_ns(watch)) {
        watch->state = CAMERA_WATCH_SILENT;
        if (!watch->recorded) {
            watch->failures++;
            tell(watch, "gives no frames");
        }
    } else if (!watch->recorded && now_ns >= end_of_patience_ns(watch)) {
        watch->state = CAMERA_WATCH_LOST;
        lose(watch, "gives no frames", now_ns);
    }
}

bool camera_watch_next(camera_watch *watch, const stream_settings *settings, int64_t now_ns, camera_frame *output)
{
    error_text reason = {""};
    if (watch->state == CAMERA_WATCH_ENDED)
        return false;
    if (watch->device == NULL) {
        if (now_ns >= watch->retry_ns)
            reopen(watch, settings, now_ns);
        return false;
    }
    switch (camera_next(watch->device, 0, output, &reason)) {
    case CAMERA_FRAME:
        note_frame(watch, output, now_ns);
        return true;
    case CAMERA_TIMEOUT:
        look_after(watch, now_ns);
        return false;
    case CAMERA_END:
        end(watch, settings, now_ns);
        return false;
    case CAMERA_GONE:
    case CAMERA_FAILED:
        lose(watch, reason.text[0] != '\0' ? reason.text : "is gone", now_ns);
        return false;
    }
    return false;
}

bool camera_watch_news(camera_watch *watch, error_text *message)
{
    bool news = watch->news;
    if (news)
        *message = watch->message;
    watch->news = false;
    return news;
}

bool camera_watch_is_lost(const camera_watch *watch)
{
    return watch->state != CAMERA_WATCH_RUNNING;
}

void camera_watch_close(camera_watch *watch)
{
    camera_close(watch->device);
    watch->device = NULL;
}
