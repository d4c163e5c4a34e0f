/* What the time stamps of Video4Linux buffers tell. */
#ifndef PLATFORM_V4L2_TIMES_H
#define PLATFORM_V4L2_TIMES_H

#include <linux/videodev2.h>
#include <stdbool.h>
#include <stdint.h>

/* How long frames take to get here. */
typedef struct v4l2_delay {
    int64_t shortest_ns;  /* from a frame's time stamp until it was taken, about the least there is */
} v4l2_delay;

/* By camera_clock_ns(); now, when the driver tells no time that could be this frame's. */
int64_t v4l2_stamp_ns(const struct v4l2_buffer *buffer);

void v4l2_delay_begin(v4l2_delay *delay);

/* Drivers that always keep a buffer are never seen to starve: there a frame counts as old when it took much longer
 * than others to get here. What "others" took may grow slowly. */
bool v4l2_delay_is_old(v4l2_delay *delay, const struct v4l2_buffer *buffer, int64_t period_ns);

/* A frame that came at once, and still was old: that is how long they take now. */
void v4l2_delay_accept(v4l2_delay *delay, const struct v4l2_buffer *buffer);

/* Stamps are of the start of the exposure or of the end of the frame; then its middle row was read out half a frame
 * time ago, when cameras read out as slowly as their rate allows. An exposure of 0 is not known. */
int64_t v4l2_middle_of_exposure_ns(const struct v4l2_buffer *buffer, int64_t period_ns, int32_t exposure_us);

#endif
