/*
 * Cameras: list, open, configure, next frame, release, close. Behind it are Video4Linux devices, libcamera (where it
 * was built with it) and recordings, played as if a camera gave them.
 *
 * The newest frame wins. Whoever is slower than the camera gets the newest frame that there is, and the number of
 * those that were left out; nothing waits in a queue. One frame at a time is out: it is given back with
 * camera_release(), or by asking for the next one.
 *
 * A camera belongs to one thread at a time.
 */
#ifndef PLATFORM_CAMERA_H
#define PLATFORM_CAMERA_H

#include "camera_mode.h"
#include "frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct camera camera;

/* Unplugged, stuck and failing cameras are ordinary answers: a program waits, opens again, or ends. */
typedef enum camera_status {
    CAMERA_FRAME,
    CAMERA_TIMEOUT,  /* no frame came in time; the next call may have better luck */
    CAMERA_END,      /* a recording has no more; this and all below: only good for closing */
    CAMERA_GONE,     /* unplugged */
    CAMERA_FAILED    /* the error says how */
} camera_status;

typedef struct camera_settings {
    camera_mode mode;        /* as the device confirmed it */
    int32_t exposure_us;     /* 0: the camera sees to it */
    double gain;             /* 0: the camera sees to it */
    camera_region region;    /* all zero: the whole picture */
} camera_settings;

typedef struct camera_frame {
    frame image;            /* its time is the middle of the exposure as far as known, by camera_clock_ns(); its
                               sequence counts dropped frames as well */
    uint32_t dropped;       /* frames that came since the one given before and were not given */
    int32_t exposure_us;    /* 0: not known */
} camera_frame;

typedef struct camera_counts {
    uint64_t given;
    uint64_t dropped;   /* because a newer one was there, or before they reached us */
    uint64_t damaged;   /* that came short, marked as faulty, or as JPEGs that cannot be decoded */
} camera_counts;

typedef struct camera_description {
    const char *name;   /* for camera_open() */
    const char *label;  /* for people */
    const camera_mode *modes;
    size_t mode_count;
} camera_description;

/* Tells of each camera that can be seen, the one first that "auto" takes. Recordings are not listed. */
void camera_list(void (*tell)(void *context, const camera_description *description), void *context);

/* Takes one of
 *     auto                    the first camera listed
 *     v4l2:DEVICE             v4l2:/dev/video0
 *     libcamera:NUMBER        libcamera:0; or libcamera:ID, as libcamera names it
 *     file:PATH[@RATE]        what tapemark-decode reads, a directory included; at its recorded pace, or at RATE
 *                             frames a second; @max: as fast as frames are asked for
 *     raw:LAYOUT,PATH[@RATE]  headerless frames: raw:Y10P:640x480:832,capture.bin
 * NULL on failure. */
camera *camera_open(const char *name, error_text *error);

/* Sets the camera up and starts it; again at any time, which takes back the frame that is out. A wish that cannot be
 * met is an error that tells what there is, and leaves a camera that was running stopped. A recording is played as it
 * is: of all wishes only the rate counts, and only where nothing else tells it. */
bool camera_configure(camera *device, const camera_wishes *wishes, error_text *error);

/* Changes exposure and gain of a running camera, without missing a frame; 0 leaves it to the camera. What is out of
 * range is moved into it: the settings tell. */
bool camera_set_light(camera *device, int32_t exposure_us, double gain, error_text *error);

const camera_settings *camera_settings_of(const camera *device);

/* For camera_open(): what it was opened as, or what "auto" came to. */
const char *camera_name(const camera *device);

/* Waits up to timeout_ms for a frame; 0 only looks. */
camera_status camera_next(camera *device, int timeout_ms, camera_frame *output, error_text *error);

/* Gives the frame back that camera_next() gave; its pixels are no longer there. */
void camera_release(camera *device);

/* For poll(): readable when camera_next() would not wait (it may still find that nothing usable came). It stays the
 * same until the camera is configured again, and only means something while no frame is out. -1 before that. */
int camera_descriptor(const camera *device);

camera_counts camera_counts_of(const camera *device);

/* NULL is fine. */
void camera_close(camera *device);

/* Nanoseconds on CLOCK_MONOTONIC, the clock of all frames. */
int64_t camera_clock_ns(void);

#ifdef __cplusplus
}
#endif

#endif
