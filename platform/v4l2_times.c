#include "v4l2_times.h"

#include "camera_backend.h"

int64_t v4l2_stamp_ns(const struct v4l2_buffer *buffer)
{
    const int64_t seconds_max = INT64_MAX / 1000000000 - 1;
    if ((buffer->flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC ||
        buffer->timestamp.tv_sec < 0 || buffer->timestamp.tv_sec > seconds_max)
        return camera_clock_ns();
    return camera_normal_time_ns((int64_t)buffer->timestamp.tv_sec * 1000000000 +
                                 (int64_t)(buffer->timestamp.tv_usec % 1000000) * 1000);
}

void v4l2_delay_begin(v4l2_delay *delay)
{
    delay->shortest_ns = INT64_MAX;
}

static int64_t delay_of(const struct v4l2_buffer *buffer)
{
    return camera_clock_ns() - v4l2_stamp_ns(buffer);
}

bool v4l2_delay_is_old(v4l2_delay *delay, const struct v4l2_buffer *buffer, int64_t period_ns)
{
    int64_t delay_ns = delay_of(buffer);
    if (delay->shortest_ns == INT64_MAX || delay_ns < delay->shortest_ns)
        delay->shortest_ns = delay_ns;
    else
        delay->shortest_ns += period_ns / 64;
    return period_ns > 0 && delay_ns > delay->shortest_ns + period_ns + period_ns / 2;
}

void v4l2_delay_accept(v4l2_delay *delay, const struct v4l2_buffer *buffer)
{
    delay->shortest_ns = delay_of(buffer);
}

int64_t v4l2_middle_of_exposure_ns(const struct v4l2_buffer *buffer, int64_t period_ns, int32_t exposure_us)
{
    int64_t half_exposure_ns = (int64_t)exposure_us * 500;
    if ((buffer->flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE)
        return v4l2_stamp_ns(buffer) + half_exposure_ns;
    return v4l2_stamp_ns(buffer) - period_ns / 2 - half_exposure_ns;
}
