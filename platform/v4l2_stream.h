/* The buffers that a Video4Linux driver fills and shows to us. */
#ifndef PLATFORM_V4L2_STREAM_H
#define PLATFORM_V4L2_STREAM_H

#include "error_text.h"

#include <linux/videodev2.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { V4L2_STREAM_BUFFERS_MAX = 16 };

typedef struct v4l2_mapped_buffer {
    void *bytes;
    size_t size;
} v4l2_mapped_buffer;

/* Zeroed before the first start. */
typedef struct v4l2_stream {
    int descriptor;
    v4l2_mapped_buffer buffers[V4L2_STREAM_BUFFERS_MAX];
    uint32_t buffer_count;
    uint32_t with_driver;  /* buffers that the driver may fill, or has filled */
    bool requested;        /* the driver has set memory aside, and lets no format be set meanwhile */
    bool running;
} v4l2_stream;

/* Starts a device that is set up, with all buffers given to the driver. Each has at least least_bytes. What was begun
 * before a failure is left for v4l2_stream_stop(). */
bool v4l2_stream_start(v4l2_stream *stream, int descriptor, size_t least_bytes, error_text *error);

void v4l2_stream_stop(v4l2_stream *stream);

/* Both return 0, or what errno was. */
int v4l2_stream_give(v4l2_stream *stream, uint32_t index);
int v4l2_stream_take(v4l2_stream *stream, struct v4l2_buffer *buffer);

#endif
