/*
 * A camera that comes back: it is opened again, at growing intervals, when it is gone, fails or gives no frames. What
 * is not fresh is no frame: one with the time of a frame before it, or one that was refused.
 */
#ifndef STREAM_CAMERA_WATCH_H
#define STREAM_CAMERA_WATCH_H

#include "camera_thread.h"
#include "settings.h"

typedef enum camera_watch_state {
    CAMERA_WATCH_RUNNING,
    CAMERA_WATCH_SILENT,  /* it is there or being opened, but no frame has come for too long */
    CAMERA_WATCH_LOST,
    CAMERA_WATCH_ENDED    /* a recording has no more */
} camera_watch_state;

/* All zero before it begins. */
typedef struct camera_watch {
    char name[SETTING_TEXT_BYTES];
    camera_thread *thread;        /* NULL while it is lost */
    camera_thread *leaving;       /* the one before, which may still be closing the device; NULL: none */
    int64_t give_up_ns;           /* when that one is left to itself */
    bool left_behind;             /* one was */
    bool opened;                  /* the device is open, and being waited for */
    camera_watch_state state;
    bool recorded;                /* a recording: that it gives nothing for a while is as it was */
    bool repeat;
    int64_t retry_ns;             /* when it is opened again */
    int64_t pause_ns;             /* until the time after that */
    int64_t last_frame_ns;        /* when it came, or when the camera began to be opened */
    int64_t last_capture_ns;      /* its time of capture */
    int64_t period_ns;            /* between the last two frames; 0: not known */
    uint64_t frames;              /* since it was opened */
    uint32_t dropped;             /* frames that were refused since the last one that was not */
    const char *complaint;        /* about silence */
    uint16_t seq;                 /* of the last FRAME */
    uint64_t sequence;            /* of the last frame, which goes on when the camera is opened again */
    uint64_t failures;
    bool told;                    /* people know that there are no frames */
    bool news;
    error_text message;
} camera_watch;

/* Begins with a camera, in place of the one before. */
void camera_watch_begin(camera_watch *watch, const stream_settings *settings);

/* For poll(); -1 while there is nothing to wait for. */
int camera_watch_descriptor(const camera_watch *watch);

/* When camera_watch_next() has something to do even without a frame. */
int64_t camera_watch_wake_ns(const camera_watch *watch);

/* Takes a frame that is there, without waiting, and looks after the camera. `settings` are for when it has to be
 * opened again. A frame has to be accepted or refused, and then released. */
bool camera_watch_next(camera_watch *watch, const stream_settings *settings, int64_t now_ns, camera_frame *output);

/* It counts as one, and gets the next number. */
void camera_watch_accept(camera_watch *watch, const camera_frame *got, int64_t now_ns);

/* It is as if it had not come; `reason`, which has to last, tells people why. The frame is not to be used then. */
void camera_watch_refuse(camera_watch *watch, const camera_frame *got, const char *reason, int64_t now_ns);

void camera_watch_release(camera_watch *watch);

/* As the device confirmed them; false while there is none. */
bool camera_watch_settings(const camera_watch *watch, camera_settings *settings);

/* True once after each change of state, with one line about it. */
bool camera_watch_news(camera_watch *watch, error_text *message);

bool camera_watch_is_lost(const camera_watch *watch);

/* A recording that cannot be played, or played on. */
bool camera_watch_has_failed(const camera_watch *watch);

/* There will be no more frames. */
bool camera_watch_is_over(const camera_watch *watch);

/* Within a second; within a frame's time where no driver has to be waited for. False when a driver or a pipe still
 * holds the thread: it must not meet the end of the libraries that it uses. */
bool camera_watch_close(camera_watch *watch);

#endif
