#include "vivid.h"

#include "picture.h"
#include "v4l2_device.h"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static bool call(int descriptor, unsigned long request, void *argument, const char *what, error_text *error)
{
    int failure = v4l2_call(descriptor, request, argument);
    if (failure != 0)
        error_text_set(error, "%s: %s", what, strerror(failure));
    return failure == 0;
}

/* vivid's controls have no fixed numbers. */
static bool set_control(int descriptor, const char *name, int32_t value, error_text *error)
{
    struct v4l2_queryctrl query = {.id = V4L2_CTRL_FLAG_NEXT_CTRL};
    while (v4l2_call(descriptor, VIDIOC_QUERYCTRL, &query) == 0) {
        if (strcmp((const char *)query.name, name) == 0)
            return call(descriptor, VIDIOC_S_CTRL, &(struct v4l2_control){query.id, value}, name, error);
        query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    error_text_set(error, "no control '%s'", name);
    return false;
}

static bool set_size(int descriptor, int32_t width_px, int32_t height_px, error_text *error)
{
    struct v4l2_enum_dv_timings timings = {0};
    for (; v4l2_call(descriptor, VIDIOC_ENUM_DV_TIMINGS, &timings) == 0; timings.index++) {
        const struct v4l2_bt_timings *bt = &timings.timings.bt;
        double rate_hz = (double)bt->pixelclock / ((double)V4L2_DV_BT_FRAME_WIDTH(bt) * V4L2_DV_BT_FRAME_HEIGHT(bt));
        if (bt->width == (uint32_t)width_px && bt->height == (uint32_t)height_px && !bt->interlaced && rate_hz > 25)
            return call(descriptor, VIDIOC_S_DV_TIMINGS, &timings.timings, "timings", error);
    }
    error_text_set(error, "no timings for %dx%d", width_px, height_px);
    return false;
}

bool vivid_connect(const char *capture, const char *output, int32_t width_px, int32_t height_px, error_text *error)
{
    int capture_descriptor = open(capture, O_RDWR | O_CLOEXEC);
    int output_descriptor = open(output, O_RDWR | O_CLOEXEC);
    bool done = set_control(capture_descriptor, "Loop Video", 1, error) &&
                set_control(capture_descriptor, "OSD Text Mode", 2, error) &&
                set_size(capture_descriptor, width_px, height_px, error) &&
                set_size(output_descriptor, width_px, height_px, error);
    close(capture_descriptor);
    close(output_descriptor);
    return done;
}

static uint32_t fourcc_of(pixel_format format)
{
    switch (format) {
    case PIXEL_YUYV: return V4L2_PIX_FMT_YUYV;
    case PIXEL_NV12: return V4L2_PIX_FMT_NV12;
    case PIXEL_Y10: return V4L2_PIX_FMT_Y10;
    default: return V4L2_PIX_FMT_GREY;
    }
}

static bool map_buffers(vivid_output *output, error_text *error)
{
    struct v4l2_requestbuffers request = {
        .count = VIVID_BUFFERS, .type = V4L2_BUF_TYPE_VIDEO_OUTPUT, .memory = V4L2_MEMORY_MMAP};
    if (!call(output->descriptor, VIDIOC_REQBUFS, &request, "REQBUFS", error))
        return false;
    for (uint32_t i = 0; i < VIVID_BUFFERS; i++) {
        struct v4l2_buffer buffer = {
            .index = i, .type = V4L2_BUF_TYPE_VIDEO_OUTPUT, .memory = V4L2_MEMORY_MMAP};
        if (!call(output->descriptor, VIDIOC_QUERYBUF, &buffer, "QUERYBUF", error))
            return false;
        void *bytes = mmap(NULL, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED, output->descriptor,
                           (off_t)buffer.m.offset);
        if (bytes == MAP_FAILED || buffer.length < frame_layout_size_bytes(&output->layout)) {
            error_text_set(error, "output buffers cannot be mapped");
            return false;
        }
        output->buffers[i] = bytes;
    }
    return true;
}

bool vivid_output_open(vivid_output *output, const char *path, pixel_format format, int32_t width_px,
                       int32_t height_px, error_text *error)
{
    struct v4l2_format wanted = {.type = V4L2_BUF_TYPE_VIDEO_OUTPUT};
    wanted.fmt.pix.width = (uint32_t)width_px;
    wanted.fmt.pix.height = (uint32_t)height_px;
    wanted.fmt.pix.pixelformat = fourcc_of(format);
    wanted.fmt.pix.field = V4L2_FIELD_NONE;
    output->descriptor = open(path, O_RDWR | O_CLOEXEC);
    if (!call(output->descriptor, VIDIOC_S_FMT, &wanted, "output format", error))
        return false;
    output->layout = (frame_layout){format, width_px, height_px, wanted.fmt.pix.bytesperline};
    return map_buffers(output, error);
}

void vivid_output_run(vivid_output *output, error_text *error)
{
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    const frame_layout *layout = &output->layout;
    uint8_t *all = picture_draw_kinds(layout->width_px, layout->height_px);
    bool done = all != NULL;
    for (uint32_t number = 0; done; number++) {
        struct v4l2_buffer buffer = {
            .index = number, .type = V4L2_BUF_TYPE_VIDEO_OUTPUT, .memory = V4L2_MEMORY_MMAP};
        if (number == VIVID_BUFFERS && !call(output->descriptor, VIDIOC_STREAMON, &type, "STREAMON", error))
            break;
        if (number >= VIVID_BUFFERS && !call(output->descriptor, VIDIOC_DQBUF, &buffer, "DQBUF", error))
            break;
        picture_encode(picture_of_number(all, layout->width_px, layout->height_px, number), layout,
                       output->buffers[buffer.index]);
        buffer.bytesused = (uint32_t)frame_layout_size_bytes(layout);
        buffer.field = V4L2_FIELD_NONE;
        done = call(output->descriptor, VIDIOC_QBUF, &buffer, "QBUF", error);
    }
    free(all);
}
