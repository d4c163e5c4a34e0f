/*
 * A Video4Linux camera without kernel: /dev/video0 as seen by programs that are linked with fake_v4l2.c, whose
 * open(), ioctl(), mmap(), munmap(), poll() and close() come first. Tests set what it offers, let it take pictures,
 * and let it fail.
 */
#ifndef FAKE_V4L2_H
#define FAKE_V4L2_H

#include <linux/videodev2.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FAKE_BUFFERS = 8, FAKE_CONTROLS = 12, FAKE_BUFFER_BYTES = 1 << 17 };

typedef struct fake_mode {
    uint32_t fourcc;
    uint32_t width;   /* 0: it has no list of sizes */
    uint32_t height;
    uint32_t rate;    /* 0: it has no list of rates */
} fake_mode;

typedef struct fake_control {
    uint32_t id;
    int32_t least;
    int32_t most;
    int64_t value;
} fake_control;

typedef struct fake_camera {
    /* What it offers: set by tests after fake_reset(). */
    const fake_mode *modes;
    size_t mode_count;
    struct v4l2_frmsize_stepwise steps;   /* instead of sizes, where max_width is not 0 */
    uint32_t capabilities;
    uint32_t buffers;                     /* that it gives */
    uint32_t buffer_bytes;                /* of each; 0: as many as a frame */
    bool crops;
    uint32_t field;
    uint32_t extra_stride;
    struct v4l2_pix_format answer;        /* to S_FMT, in those fields that are not 0 */
    fake_control controls[FAKE_CONTROLS];
    size_t control_count;

    /* How the next pictures come. */
    uint32_t flags;                       /* of their buffers */
    int64_t age_ns;                       /* when they are taken */
    int64_t stamp_us;                     /* 0: by their age */
    uint32_t bytes_used;                  /* 0: a whole frame */
    const void *content;                  /* NULL: all bytes are the sequence number's lowest */
    size_t content_size;
    int comes_while_waited;               /* pictures taken in each poll() */
    int kept;                             /* buffers that the driver does not give back while it has no others */
    bool endless;                         /* a buffer is filled as soon as it is given */
    short poll_events;                    /* what poll() answers besides */
    bool source_changed;
    uint32_t wrong_index;                 /* 0, or what DQBUF answers in place of the index */
    int64_t slept_ns;                     /* by which CLOCK_BOOTTIME is ahead */
    int maps;                             /* that mmap() grants; -1: all */

    /* What happened. */
    uint32_t sequence;
    int open_count;
    int mapped;
    int allocated;                        /* buffers, for which no format can be set */
    int calls;                            /* of ioctl() */
    int queued;
    bool streaming;
    struct v4l2_pix_format picture;
    struct v4l2_rect crop;
    struct v4l2_fract interval;
} fake_camera;

extern fake_camera fake;

/* A camera of 64 x 48 px in GREY, that shows as /dev/video0 and does all it is asked. Its rate is one frame a second,
 * so that no frame seems old because the machine is busy. */
void fake_reset(void);

/* It takes a number of pictures; those that find no buffer are lost. */
void fake_take(int count);

/* From the `after`th call on, `times` calls of this ioctl (or all, when below 0) fail with this errno. */
void fake_fail(unsigned long request, int failure, int after, int times);

/* From now on all fails with ENODEV. */
void fake_unplug(void);

int64_t fake_control_value(uint32_t id);

#endif
