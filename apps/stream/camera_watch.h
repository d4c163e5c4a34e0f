/* A camera that comes back: it is opened again, at growing intervals, when it is gone, fails or gives no frames. */
#ifndef STREAM_CAMERA_WATCH_H
#define STREAM_CAMERA_WATCH_H

#include "camera.h"
#include "settings.h"

typedef enum camera_watch_state {
    CAMERA_WATCH_RUNNING,
    CAMERA_WATCH_SILENT,  /* it is there, but no frame has come for too long */
    CAMERA_WATCH_LOST,
    CAMERA_WATCH_ENDED    /* a recording has no more */
} camera_watch_state;

typedef struct camera_watch {
    char name[SETTING_TEXT_BYTES];
    camera *device;               /* NULL while it is lost */
    camera_watch_state state;
    bool recorded;                /* a recording: that it gives nothing for a while is as it was */
    bool repeat;
    int64_t retry_ns;             /* when it is opened again */
    int64_t pause_ns;             /* until the time after that */
    int64_t last_frame_ns;        /* or when it was opened */
    int64_t period_ns;            /* between the last two frames; 0: not known */
    uint64_t frames;              /* since it was opened */
    uint16_t seq;                 /* of the last FRAME */
    uint64_t failures;
    bool news;
    error_text message;
} camera_watch;

/* Begins with a camera, in place of the one before. False, with an error, when it is a recording that cannot be
 * played; a camera that is not there only is lost. */
bool camera_watch_begin(camera_watch *watch, const stream_settings *settings, error_text *error);

/* For poll(); -1 while there is nothing to wait for. */
int camera_watch_descriptor(const camera_watch *watch);

/* When camera_watch_next() has something to do even without a frame. */
int64_t camera_watch_wake_ns(const camera_watch *watch);

/* Takes a frame that is there, without waiting, and looks after the camera. `wishes` are for when it has to be opened
 * again. */
bool camera_watch_next(camera_watch *watch, const stream_settings *settings, int64_t now_ns, camera_frame *output);

/* True once after each change of state, with one line about it. */
bool camera_watch_news(camera_watch *watch, error_text *message);

bool camera_watch_is_lost(const camera_watch *watch);

void camera_watch_close(camera_watch *watch);

#endif
