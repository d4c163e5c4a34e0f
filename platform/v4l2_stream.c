#include "v4l2_stream.h"

#include "v4l2_device.h"

#include <errno.h>
#include <string.h>
#include <sys/mman.h>

enum {
    BUFFERS_WANTED = 6,  /* one is out, and drivers keep up to two for themselves */
    BUFFERS_NEEDED = 3
};

static struct v4l2_buffer buffer_of(uint32_t index)
{
    return (struct v4l2_buffer){
        .index = index, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
}

static int request_buffers(int descriptor, uint32_t *count)
{
    struct v4l2_requestbuffers request = {
        .count = *count, .type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .memory = V4L2_MEMORY_MMAP};
    int failure = v4l2_call(descriptor, VIDIOC_REQBUFS, &request);
    *count = request.count;
    return failure;
}

int v4l2_stream_give(v4l2_stream *stream, uint32_t index)
{
    struct v4l2_buffer buffer = buffer_of(index);
    int failure = v4l2_call(stream->descriptor, VIDIOC_QBUF, &buffer);
    if (failure == 0)
        stream->with_driver++;
    return failure;
}

int v4l2_stream_take(v4l2_stream *stream, struct v4l2_buffer *buffer)
{
    *buffer = buffer_of(0);
    int failure = v4l2_call(stream->descriptor, VIDIOC_DQBUF, buffer);
    if (failure == 0 && (buffer->index >= stream->buffer_count || stream->with_driver == 0))
        return EBADSLT;
    if (failure == 0)
        stream->with_driver--;
    return failure;
}

static bool map_buffer(v4l2_stream *stream, uint32_t index, size_t least_bytes, error_text *error)
{
    struct v4l2_buffer buffer = buffer_of(index);
    int failure = v4l2_call(stream->descriptor, VIDIOC_QUERYBUF, &buffer);
    if (failure != 0 || buffer.length < least_bytes) {
        error_text_set(error, "gives no buffers to read from: %s",
                       failure != 0 ? strerror(failure) : "they are smaller than a frame");
        return false;
    }
    void *bytes = mmap(NULL, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, stream->descriptor,
                       (off_t)buffer.m.offset);
    if (bytes == MAP_FAILED) {
        error_text_set(error, "does not share its buffers: %s", strerror(errno));
        return false;
    }
    stream->buffers[index] = (v4l2_mapped_buffer){bytes, buffer.length};
    stream->buffer_count = index + 1;
    failure = v4l2_stream_give(stream, index);
    if (failure != 0)
        error_text_set(error, "does not take its buffers: %s", strerror(failure));
    return failure == 0;
}

static bool map_buffers(v4l2_stream *stream, size_t least_bytes, error_text *error)
{
    uint32_t count = BUFFERS_WANTED;
    int failure = request_buffers(stream->descriptor, &count);
    if (failure == EBUSY) {
        error_text_set(error, "is used by another program");
        return false;
    }
    stream->requested = failure == 0;
    if (failure != 0 || count < BUFFERS_NEEDED) {
        error_text_set(error, "has no buffers to share: %s",
                       failure != 0 ? strerror(failure) : "fewer than are needed");
        return false;
    }
    for (uint32_t i = 0; i < count && i < V4L2_STREAM_BUFFERS_MAX; i++)
        if (!map_buffer(stream, i, least_bytes, error))
            return false;
    return true;
}

bool v4l2_stream_start(v4l2_stream *stream, int descriptor, size_t least_bytes, error_text *error)
{
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    stream->descriptor = descriptor;
    if (!map_buffers(stream, least_bytes, error))
        return false;
    int failure = v4l2_call(descriptor, VIDIOC_STREAMON, &type);
    if (failure == ENOSPC)
        error_text_set(error, "does not start: its USB bus has no bandwidth left; choose a smaller size or MJPEG");
    else if (failure != 0)
        error_text_set(error, "does not start: %s", strerror(failure));
    stream->running = failure == 0;
    return stream->running;
}

void v4l2_stream_stop(v4l2_stream *stream)
{
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    uint32_t none = 0;
    if (stream->running)
        v4l2_call(stream->descriptor, VIDIOC_STREAMOFF, &type);
    for (uint32_t i = 0; i < stream->buffer_count; i++)
        munmap(stream->buffers[i].bytes, stream->buffers[i].size);
    if (stream->requested)
        request_buffers(stream->descriptor, &none);
    *stream = (v4l2_stream){.running = false};
}
