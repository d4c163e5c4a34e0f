#include "camera_watch.h"

#include <stdio.h>
#include <string.h>

static const int64_t first_pause_ns = 500000000, longest_pause_ns = 8000000000;

/* Without a frame for that long, the camera is silent; then it is opened again. */
static const int64_t silence_ns = 500000000, patience_ns = 3000000000;

/* For a device to be closed before another one, which may be the same, is opened in its place, and at the end. */
static const int64_t close_patience_ns = 1000000000, brief_ns = 30000000;

static void tell(camera_watch *watch, const char *reason)
{
    watch->news = true;
    error_text_set(&watch->message, "camera %.150s: %.240s", watch->name, reason);
}

/* Only the first of several failures in a row is told. */
static void tell_failure(camera_watch *watch, const char *reason)
{
    if (watch->told)
        return;
    watch->told = true;
    watch->failures++;
    tell(watch, reason);
}

/* ---- Opening and losing -------------------------------------------------------------------------------------- */

static void plan_retry(camera_watch *watch, int64_t now_ns)
{
    watch->retry_ns = now_ns + watch->pause_ns;
    watch->pause_ns = watch->pause_ns * 2 < longest_pause_ns ? watch->pause_ns * 2 : longest_pause_ns;
}

/* The device has to be let go of first. */
static void dismiss_thread(camera_watch *watch)
{
    if (watch->thread == NULL)
        return;
    camera_thread_leave(watch->thread);
    watch->leaving = watch->thread;
    watch->give_up_ns = INT64_MAX;
    watch->thread = NULL;
}

/* Whether the one before is no more, or it is no use to wait for it any longer. */
static bool thread_has_left(camera_watch *watch, int64_t now_ns)
{
    if (watch->leaving == NULL)
        return true;
    if (!camera_thread_has_ended(watch->leaving) && now_ns < watch->give_up_ns)
        return false;
    watch->left_behind = !camera_thread_close(watch->leaving, 0) || watch->left_behind;
    watch->leaving = NULL;
    return true;
}

static void lose(camera_watch *watch, const char *reason, int64_t now_ns)
{
    dismiss_thread(watch);
    tell_failure(watch, reason);
    watch->state = CAMERA_WATCH_LOST;
    plan_retry(watch, now_ns);
}

static void open_device(camera_watch *watch, const stream_settings *settings, int64_t now_ns)
{
    error_text reason;
    camera_wishes wishes = settings_camera_wishes(settings);
    watch->thread = camera_thread_open(watch->name, &wishes, &reason);
    watch->last_frame_ns = now_ns;
    watch->last_capture_ns = INT64_MIN;
    watch->frames = 0;
    watch->opened = false;
    watch->complaint = "gives no frames";
    if (watch->thread == NULL)
        lose(watch, reason.text, now_ns);
}

static void look_for_camera(camera_watch *watch, const stream_settings *settings, int64_t now_ns)
{
    if (thread_has_left(watch, now_ns) && now_ns >= watch->retry_ns)
        open_device(watch, settings, now_ns);
}

void camera_watch_begin(camera_watch *watch, const stream_settings *settings)
{
    int64_t now_ns = camera_clock_ns();
    dismiss_thread(watch);
    camera_watch fresh = {.leaving = watch->leaving, .give_up_ns = now_ns + close_patience_ns,
                          .left_behind = watch->left_behind, .state = CAMERA_WATCH_RUNNING, .retry_ns = now_ns,
                          .pause_ns = first_pause_ns, .last_frame_ns = now_ns, .seq = watch->seq,
                          .sequence = watch->sequence,
                          .failures = watch->failures, .repeat = settings->repeat};
    memcpy(fresh.name, settings->camera, sizeof fresh.name);
    fresh.recorded = strncmp(fresh.name, "file:", 5) == 0 || strncmp(fresh.name, "raw:", 4) == 0;
    *watch = fresh;
    look_for_camera(watch, settings, now_ns);
}

/* ---- Waiting ------------------------------------------------------------------------------------------------- */

int camera_watch_descriptor(const camera_watch *watch)
{
    if (watch->thread == NULL)
        return watch->leaving != NULL ? camera_thread_descriptor(watch->leaving) : -1;
    return watch->state != CAMERA_WATCH_ENDED ? camera_thread_descriptor(watch->thread) : -1;
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

/* Where a driver never lets go of a device, there is no opening it again. */
static int64_t retry_time_ns(const camera_watch *watch)
{
    return watch->leaving != NULL ? watch->give_up_ns : watch->retry_ns;
}

int64_t camera_watch_wake_ns(const camera_watch *watch)
{
    int64_t wake_ns = INT64_MAX;
    if (watch->state == CAMERA_WATCH_ENDED)
        return wake_ns;
    if (watch->thread == NULL)
        wake_ns = retry_time_ns(watch);
    else if (!watch->recorded && (watch->opened || !watch->told))
        wake_ns = end_of_patience_ns(watch);
    int64_t silent_ns = watch->last_frame_ns + silence_limit_ns(watch);
    return watch->state == CAMERA_WATCH_RUNNING && silent_ns < wake_ns ? silent_ns : wake_ns;
}

/* ---- Frames -------------------------------------------------------------------------------------------------- */

/* A camera that is stuck may deliver what it has delivered before. */
static bool is_fresh(const camera_watch *watch, const camera_frame *got)
{
    return watch->recorded || got->image.time_ns == FRAME_TIME_UNKNOWN ||
           got->image.time_ns > watch->last_capture_ns;
}

void camera_watch_accept(camera_watch *watch, const camera_frame *got, int64_t now_ns)
{
    if (watch->told)
        tell(watch, "gives frames again");
    watch->told = false;
    watch->period_ns = watch->frames > 0 ? now_ns - watch->last_frame_ns : 0;
    watch->frames++;
    watch->state = CAMERA_WATCH_RUNNING;
    watch->complaint = "gives no frames";
    watch->pause_ns = first_pause_ns;
    watch->last_frame_ns = now_ns;
    watch->last_capture_ns = got->image.time_ns;
    watch->seq = (uint16_t)(watch->seq + got->dropped + 1);
    watch->sequence += got->dropped + 1;
}

void camera_watch_release(camera_watch *watch)
{
    if (watch->thread != NULL)
        camera_thread_release(watch->thread);
}

/* ---- Looking after it ---------------------------------------------------------------------------------------- */

/* At the end of a recording. Its first frame comes again as long after the last one as others do. */
static void end(camera_watch *watch, int64_t now_ns)
{
    camera_settings settings;
    if (!watch->repeat) {
        watch->state = CAMERA_WATCH_ENDED;
        return;
    }
    if (watch->frames == 0) {
        lose(watch, "holds no frames", now_ns);
        return;
    }
    double rate_hz = camera_watch_settings(watch, &settings) ? settings.mode.rate_hz : 0;
    dismiss_thread(watch);
    watch->retry_ns = rate_hz > 0 ? watch->last_capture_ns + (int64_t)(1e9 / rate_hz) : now_ns;
}

static void note_opening(camera_watch *watch, int64_t now_ns)
{
    camera_settings ignored;
    if (watch->opened || !camera_watch_settings(watch, &ignored))
        return;
    watch->opened = true;
    watch->last_frame_ns = now_ns;
}

static bool fall_silent(camera_watch *watch, int64_t now_ns)
{
    bool falls = watch->state == CAMERA_WATCH_RUNNING && now_ns >= watch->last_frame_ns + silence_limit_ns(watch);
    if (falls)
        watch->state = CAMERA_WATCH_SILENT;
    return falls;
}

/* A thread that is opening a device cannot be told to end: there is nothing to be done but to wait. */
static void look_after(camera_watch *watch, int64_t now_ns)
{
    note_opening(watch, now_ns);
    bool live = watch->opened && !watch->recorded;
    if (fall_silent(watch, now_ns)) {
        if (live)
            tell_failure(watch, watch->complaint);
    } else if (live && now_ns >= end_of_patience_ns(watch)) {
        lose(watch, watch->complaint, now_ns);
    } else if (!watch->recorded && now_ns >= end_of_patience_ns(watch)) {
        tell_failure(watch, "is being opened, and its driver does not answer");
    }
}

void camera_watch_refuse(camera_watch *watch, const camera_frame *got, const char *reason, int64_t now_ns)
{
    watch->dropped += got->dropped + 1;
    watch->complaint = reason;
    look_after(watch, now_ns);
}

static bool take(camera_watch *watch, int64_t now_ns, camera_frame *output)
{
    note_opening(watch, now_ns);
    output->dropped += watch->dropped;
    watch->dropped = 0;
    if (is_fresh(watch, output))
        return true;
    camera_watch_refuse(watch, output, "gives frames that it gave before", now_ns);
    camera_watch_release(watch);
    return false;
}

bool camera_watch_next(camera_watch *watch, const stream_settings *settings, int64_t now_ns, camera_frame *output)
{
    error_text reason = {""};
    if (watch->state == CAMERA_WATCH_ENDED)
        return false;
    if (watch->thread == NULL)
        look_for_camera(watch, settings, now_ns);
    if (watch->thread == NULL) {
        fall_silent(watch, now_ns);
        return false;
    }
    switch (camera_thread_next(watch->thread, output, &reason)) {
    case CAMERA_FRAME:
        return take(watch, now_ns, output);
    case CAMERA_TIMEOUT:
        look_after(watch, now_ns);
        return false;
    case CAMERA_END:
        end(watch, now_ns);
        return false;
    case CAMERA_GONE:
    case CAMERA_FAILED:
        lose(watch, reason.text[0] != '\0' ? reason.text : "is gone", now_ns);
        return false;
    }
    return false;
}

bool camera_watch_settings(const camera_watch *watch, camera_settings *settings)
{
    return watch->thread != NULL && camera_thread_settings(watch->thread, settings);
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

bool camera_watch_has_failed(const camera_watch *watch)
{
    return watch->recorded && watch->state == CAMERA_WATCH_LOST;
}

bool camera_watch_is_over(const camera_watch *watch)
{
    return watch->state == CAMERA_WATCH_ENDED || camera_watch_has_failed(watch);
}

bool camera_watch_close(camera_watch *watch)
{
    camera_settings ignored;
    bool open = !watch->recorded && camera_watch_settings(watch, &ignored);
    bool closed = camera_thread_close(watch->leaving, watch->recorded ? brief_ns : close_patience_ns);
    closed = camera_thread_close(watch->thread, open ? close_patience_ns : brief_ns) && closed;
    watch->thread = watch->leaving = NULL;
    return closed && !watch->left_behind;
}
