/*
 * A camera in a thread of its own. Opening it, waiting for its frames, reading a recording's next one from a slow
 * disk or a pipe, closing it: whatever of that takes long, or never ends, the program goes on meanwhile.
 *
 * One frame at a time is out. While it is, the thread waits, and then takes the newest one that there is.
 */
#ifndef STREAM_CAMERA_THREAD_H
#define STREAM_CAMERA_THREAD_H

#include "camera.h"

typedef struct camera_thread camera_thread;

/* Begins to open a camera and to set it up. NULL, with an error, when there is no thread to be had. */
camera_thread *camera_thread_open(const char *name, const camera_wishes *wishes, error_text *error);

/* For poll(): readable when camera_thread_next() or camera_thread_has_ended() may have another answer. */
int camera_thread_descriptor(const camera_thread *self);

/* Never waits; CAMERA_TIMEOUT: nothing yet. After CAMERA_END and all below, it is only good for closing. */
camera_status camera_thread_next(camera_thread *self, camera_frame *output, error_text *error);

/* Gives the frame back. */
void camera_thread_release(camera_thread *self);

/* As the device confirmed them, without waiting; false before that. */
bool camera_thread_settings(camera_thread *self, camera_settings *settings);

/* As camera_set_light() and camera_configure(). False, with an error, also when the camera cannot be reached now. */
bool camera_thread_set_light(camera_thread *self, int32_t exposure_us, double gain, error_text *error);
bool camera_thread_configure(camera_thread *self, const camera_wishes *wishes, error_text *error);

/* Asks it to close the camera and to end. The frame that is out is given back with that. */
void camera_thread_leave(camera_thread *self);

bool camera_thread_has_ended(camera_thread *self);

/* Asks as well, and waits for so long. False when it has not ended by then: it is left to itself, and lets go of
 * everything once it can. NULL is fine, and true. */
bool camera_thread_close(camera_thread *self, int64_t patience_ns);

#endif
