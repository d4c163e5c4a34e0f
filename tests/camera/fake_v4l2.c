#include "fake_v4l2.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <time.h>

/* The linker gives these names to the wrapped functions and to what they stand for (--wrap). */
int __real_open64(const char *path, int flags, ...);
int __real_close(int descriptor);
int __real_poll(struct pollfd *waiting, nfds_t count, int timeout_ms);
void *__real_mmap64(void *address, size_t size, int protection, int flags, int descriptor, off_t offset);
int __real_munmap(void *address, size_t size);
int __wrap_open64(const char *path, int flags, ...);
int __wrap_close(int descriptor);
int __wrap_poll(struct pollfd *waiting, nfds_t count, int timeout_ms);
void *__wrap_mmap64(void *address, size_t size, int protection, int flags, int descriptor, off_t offset);
int __wrap_munmap(void *address, size_t size);
int __wrap_ioctl(int descriptor, unsigned long request, void *argument);
int __real_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);

fake_camera fake;

typedef struct buffer_queue {
    uint32_t index[FAKE_BUFFERS];
    uint32_t bytes_used[FAKE_BUFFERS];
    uint32_t sequence[FAKE_BUFFERS];
    uint32_t flags[FAKE_BUFFERS];
    struct timeval stamp[FAKE_BUFFERS];
    int count;
} buffer_queue;

static const fake_mode usual_mode = {V4L2_PIX_FMT_GREY, 64, 48, 1};
static int device_descriptor = -1;
static bool unplugged;
static unsigned long failing_request;
static int failing_errno, failing_after, failing_times;
static _Alignas(16) uint8_t memory[FAKE_BUFFERS][FAKE_BUFFER_BYTES];
static buffer_queue given, done;

void fake_reset(void)
{
    fake = (fake_camera){.modes = &usual_mode, .mode_count = 1, .buffers = FAKE_BUFFERS, .crops = true,
                         .field = V4L2_FIELD_NONE, .maps = -1,
                         .capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING,
                         .flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE};
    unplugged = false;
    failing_request = 0;
    failing_times = 0;
    given.count = 0;
    done.count = 0;
}

void fake_fail(unsigned long request, int failure, int after, int times)
{
    failing_request = request;
    failing_errno = failure;
    failing_after = after;
    failing_times = times;
}

void fake_unplug(void)
{
    unplugged = true;
}

int64_t fake_control_value(uint32_t id)
{
    for (size_t i = 0; i < fake.control_count; i++)
        if (fake.controls[i].id == id)
            return fake.controls[i].value;
    return INT64_MIN;
}

static struct timeval stamp_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    int64_t time_us = ((int64_t)now.tv_sec * 1000000000 + now.tv_nsec - fake.age_ns) / 1000;
    if (fake.stamp_us != 0)
        time_us = fake.stamp_us;
    return (struct timeval){(time_t)(time_us / 1000000), (suseconds_t)(time_us % 1000000)};
}

static uint32_t take_first(buffer_queue *queue)
{
    uint32_t index = queue->index[0];
    queue->count--;
    memmove(queue->index, queue->index + 1, (size_t)queue->count * sizeof *queue->index);
    memmove(queue->bytes_used, queue->bytes_used + 1, (size_t)queue->count * sizeof *queue->bytes_used);
    memmove(queue->sequence, queue->sequence + 1, (size_t)queue->count * sizeof *queue->sequence);
    memmove(queue->flags, queue->flags + 1, (size_t)queue->count * sizeof *queue->flags);
    memmove(queue->stamp, queue->stamp + 1, (size_t)queue->count * sizeof *queue->stamp);
    return index;
}

static void take_picture(void)
{
    uint32_t sequence = fake.sequence++;
    if (!fake.streaming || given.count <= fake.kept)
        return;
    uint32_t index = take_first(&given);
    uint32_t bytes = fake.picture.sizeimage;
    memset(memory[index], (int)(sequence & 0xff), bytes);
    if (fake.content != NULL) {
        memcpy(memory[index], fake.content, fake.content_size);
        bytes = (uint32_t)fake.content_size;
    }
    int last = done.count++;
    done.index[last] = index;
    done.bytes_used[last] = fake.bytes_used != 0 ? fake.bytes_used : bytes;
    done.sequence[last] = sequence;
    done.flags[last] = fake.flags;
    done.stamp[last] = stamp_now();
}

void fake_take(int count)
{
    for (int i = 0; i < count; i++)
        take_picture();
}

static int fail_with(int failure)
{
    errno = failure;
    return -1;
}

/* ---- What it offers -------------------------------------------------------------------------------------- */

static int query_capabilities(struct v4l2_capability *answer)
{
    memset(answer, 0, sizeof *answer);
    memcpy(answer->card, "Camera of the tests", sizeof "Camera of the tests");
    answer->capabilities = V4L2_CAP_DEVICE_CAPS | fake.capabilities;
    answer->device_caps = fake.capabilities;
    return 0;
}

/* The first mode of each format stands for it. */
static bool is_first_of_format(size_t mode)
{
    for (size_t i = 0; i < mode; i++)
        if (fake.modes[i].fourcc == fake.modes[mode].fourcc)
            return false;
    return true;
}

static int enumerate_formats(struct v4l2_fmtdesc *answer)
{
    uint32_t index = 0;
    for (size_t i = 0; i < fake.mode_count; i++) {
        if (is_first_of_format(i) && index++ == answer->index) {
            answer->pixelformat = fake.modes[i].fourcc;
            return 0;
        }
    }
    return fail_with(EINVAL);
}

static int enumerate_sizes(struct v4l2_frmsizeenum *answer)
{
    uint32_t index = 0;
    if (fake.steps.max_width > 0 && answer->index == 0) {
        answer->type = V4L2_FRMSIZE_TYPE_STEPWISE;
        answer->stepwise = fake.steps;
        return 0;
    }
    for (size_t i = 0; i < fake.mode_count; i++) {
        const fake_mode *mode = &fake.modes[i];
        bool repeated = i > 0 && mode[-1].fourcc == mode->fourcc && mode[-1].width == mode->width;
        if (mode->width == 0 || mode->fourcc != answer->pixel_format || repeated || index++ != answer->index)
            continue;
        answer->type = V4L2_FRMSIZE_TYPE_DISCRETE;
        answer->discrete = (struct v4l2_frmsize_discrete){mode->width, mode->height};
        return 0;
    }
    return fail_with(fake.modes[0].width == 0 ? ENOTTY : EINVAL);
}

static int enumerate_intervals(struct v4l2_frmivalenum *answer)
{
    uint32_t index = 0;
    for (size_t i = 0; i < fake.mode_count; i++) {
        const fake_mode *mode = &fake.modes[i];
        if (mode->rate == 0 || mode->fourcc != answer->pixel_format || mode->width != answer->width ||
            mode->height != answer->height || index++ != answer->index)
            continue;
        answer->type = V4L2_FRMIVAL_TYPE_DISCRETE;
        answer->discrete = (struct v4l2_fract){1, mode->rate};
        return 0;
    }
    return fail_with(EINVAL);
}

/* ---- What it is set to ----------------------------------------------------------------------------------- */

static uint32_t stride_of(uint32_t fourcc, uint32_t width)
{
    switch (fourcc) {
    case V4L2_PIX_FMT_YUYV:
    case V4L2_PIX_FMT_UYVY:
    case V4L2_PIX_FMT_Y10:
    case V4L2_PIX_FMT_Y12:
        return 2 * width;
    case V4L2_PIX_FMT_Y10P:
        return width * 5 / 4;
    case V4L2_PIX_FMT_MJPEG:
        return 0;
    default:
        return width;
    }
}

static int set_format(struct v4l2_format *format)
{
    struct v4l2_pix_format *picture = &format->fmt.pix;
    if (fake.allocated > 0)
        return fail_with(EBUSY);
    bool planar = picture->pixelformat == V4L2_PIX_FMT_NV12 || picture->pixelformat == V4L2_PIX_FMT_YUV420;
    uint32_t stride = stride_of(picture->pixelformat, picture->width);
    picture->bytesperline = stride > 0 ? stride + fake.extra_stride : 0;
    picture->sizeimage = stride > 0 ? picture->bytesperline * picture->height : FAKE_BUFFER_BYTES;
    if (planar)
        picture->sizeimage += picture->sizeimage / 2;
    picture->field = fake.field;
    picture->width = fake.answer.width != 0 ? fake.answer.width : picture->width;
    picture->height = fake.answer.height != 0 ? fake.answer.height : picture->height;
    picture->pixelformat = fake.answer.pixelformat != 0 ? fake.answer.pixelformat : picture->pixelformat;
    picture->bytesperline = fake.answer.bytesperline != 0 ? fake.answer.bytesperline : picture->bytesperline;
    picture->sizeimage = fake.answer.sizeimage != 0 ? fake.answer.sizeimage : picture->sizeimage;
    fake.picture = *picture;
    return 0;
}

static int get_format(struct v4l2_format *format)
{
    format->fmt.pix = fake.picture;
    if (fake.picture.width == 0)
        format->fmt.pix = (struct v4l2_pix_format){.width = 64, .height = 48, .pixelformat = fake.modes[0].fourcc};
    return 0;
}

static int parameters(struct v4l2_streamparm *answer, bool set)
{
    if (set)
        fake.interval = answer->parm.capture.timeperframe;
    answer->parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    answer->parm.capture.timeperframe = fake.interval;
    return 0;
}

static int set_selection(struct v4l2_selection *selection)
{
    if (!fake.crops)
        return fail_with(ENOTTY);
    fake.crop = selection->r;
    return 0;
}

static int control(uint32_t id, const int64_t *value, int64_t *answer, struct v4l2_queryctrl *query)
{
    for (size_t i = 0; i < fake.control_count; i++) {
        fake_control *one = &fake.controls[i];
        if (one->id != id)
            continue;
        if (value != NULL && (*value < one->least || *value > one->most))
            return fail_with(ERANGE);
        if (value != NULL)
            one->value = *value;
        if (answer != NULL)
            *answer = one->value;
        if (query != NULL) {
            query->minimum = one->least;
            query->maximum = one->most;
        }
        return 0;
    }
    return fail_with(EINVAL);
}

static int get_extended(struct v4l2_ext_controls *controls)
{
    int64_t value = 0;
    int result = control(controls->controls->id, NULL, &value, NULL);
    if (controls->controls->id == V4L2_CID_PIXEL_RATE)
        controls->controls->value64 = value;
    else
        controls->controls->value = (int32_t)value;
    return result;
}

/* ---- Buffers --------------------------------------------------------------------------------------------- */

/* Its memory is as small as what the tests need. */
static int request_buffers(struct v4l2_requestbuffers *request)
{
    if (fake.picture.sizeimage > FAKE_BUFFER_BYTES || fake.buffer_bytes > FAKE_BUFFER_BYTES)
        return fail_with(ENOMEM);
    if (request->count > fake.buffers)
        request->count = fake.buffers;
    fake.allocated = (int)request->count;
    given.count = 0;
    done.count = 0;
    return 0;
}

static int give_buffer(const struct v4l2_buffer *buffer)
{
    if (buffer->index >= FAKE_BUFFERS || given.count == FAKE_BUFFERS)
        return fail_with(EINVAL);
    given.index[given.count++] = buffer->index;
    if (fake.endless && fake.streaming)
        take_picture();
    return 0;
}

static int get_buffer(struct v4l2_buffer *buffer)
{
    if (!fake.streaming)
        return fail_with(EINVAL);
    if (done.count == 0)
        return fail_with(EAGAIN);
    buffer->bytesused = done.bytes_used[0];
    buffer->sequence = done.sequence[0];
    buffer->flags = done.flags[0];
    buffer->timestamp = done.stamp[0];
    buffer->index = take_first(&done);
    if (fake.wrong_index != 0)
        buffer->index = fake.wrong_index;
    return 0;
}

static int show_buffer(struct v4l2_buffer *buffer)
{
    buffer->length = fake.buffer_bytes != 0 ? fake.buffer_bytes : fake.picture.sizeimage;
    buffer->m.offset = buffer->index * FAKE_BUFFER_BYTES;
    return 0;
}

static int stream(bool on)
{
    fake.streaming = on;
    if (!on) {
        given.count = 0;
        done.count = 0;
    }
    return 0;
}

static int next_event(struct v4l2_event *event)
{
    if (!fake.source_changed)
        return fail_with(ENOENT);
    event->type = V4L2_EVENT_SOURCE_CHANGE;
    event->u.src_change.changes = V4L2_EVENT_SRC_CH_RESOLUTION;
    return 0;
}

static int answer(unsigned long request, void *argument)
{
    struct v4l2_control *simple = argument;
    switch (request) {
    case VIDIOC_QUERYCAP: return query_capabilities(argument);
    case VIDIOC_ENUM_FMT: return enumerate_formats(argument);
    case VIDIOC_ENUM_FRAMESIZES: return enumerate_sizes(argument);
    case VIDIOC_ENUM_FRAMEINTERVALS: return enumerate_intervals(argument);
    case VIDIOC_G_FMT: return get_format(argument);
    case VIDIOC_S_FMT: return set_format(argument);
    case VIDIOC_G_PARM: return parameters(argument, false);
    case VIDIOC_S_PARM: return parameters(argument, true);
    case VIDIOC_G_SELECTION: return fake.crops ? 0 : fail_with(ENOTTY);
    case VIDIOC_S_SELECTION: return set_selection(argument);
    case VIDIOC_QUERYCTRL: return control(((struct v4l2_queryctrl *)argument)->id, NULL, NULL, argument);
    case VIDIOC_S_CTRL: return control(simple->id, &(int64_t){simple->value}, NULL, NULL);
    case VIDIOC_G_EXT_CTRLS: return get_extended(argument);
    case VIDIOC_REQBUFS: return request_buffers(argument);
    case VIDIOC_QUERYBUF: return show_buffer(argument);
    case VIDIOC_QBUF: return give_buffer(argument);
    case VIDIOC_DQBUF: return get_buffer(argument);
    case VIDIOC_STREAMON: return stream(true);
    case VIDIOC_STREAMOFF: return stream(false);
    case VIDIOC_SUBSCRIBE_EVENT: return 0;
    case VIDIOC_DQEVENT: return next_event(argument);
    default: return fail_with(ENOTTY);
    }
}

int __wrap_ioctl(int descriptor, unsigned long request, void *argument)
{
    if (descriptor < 0 || descriptor != device_descriptor)
        return fail_with(EBADF);
    fake.calls++;
    if (unplugged)
        return fail_with(ENODEV);
    if (request == failing_request && failing_after-- <= 0 && failing_times != 0) {
        failing_times -= failing_times > 0;
        return fail_with(failing_errno);
    }
    int result = answer(request, argument);
    fake.queued = given.count;
    return result;
}

/* ---- The rest of the system ------------------------------------------------------------------------------ */

int __wrap_open64(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    int mode = flags & O_CREAT ? va_arg(arguments, int) : 0;
    va_end(arguments);
    if (strncmp(path, "/dev/video", 10) != 0)
        return __real_open64(path, flags, mode);
    if (strcmp(path, "/dev/video0") != 0 || unplugged)
        return fail_with(ENOENT);
    if (failing_request == 0 && failing_times != 0)
        return fail_with(failing_errno);
    device_descriptor = __real_open64("/dev/null", O_RDWR);
    fake.open_count++;
    return device_descriptor;
}

int __wrap_close(int descriptor)
{
    if (descriptor >= 0 && descriptor == device_descriptor) {
        fake.open_count--;
        device_descriptor = -1;
        fake.allocated = 0;
        stream(false);
    }
    return __real_close(descriptor);
}

void *__wrap_mmap64(void *address, size_t size, int protection, int flags, int descriptor, off_t offset)
{
    if (descriptor < 0 || descriptor != device_descriptor)
        return __real_mmap64(address, size, protection, flags, descriptor, offset);
    if (fake.maps == 0) {
        errno = ENOMEM;
        return MAP_FAILED;
    }
    fake.maps -= fake.maps > 0;
    fake.mapped++;
    return memory[offset / FAKE_BUFFER_BYTES];
}

int __wrap_munmap(void *address, size_t size)
{
    if ((uint8_t *)address < (uint8_t *)memory || (uint8_t *)address >= (uint8_t *)(memory + FAKE_BUFFERS))
        return __real_munmap(address, size);
    fake.mapped--;
    return 0;
}

int __wrap_clock_gettime(clockid_t clock, struct timespec *now)
{
    int result = __real_clock_gettime(clock, now);
    if (clock == CLOCK_BOOTTIME) {
        __real_clock_gettime(CLOCK_MONOTONIC, now);
        int64_t time_ns = (int64_t)now->tv_sec * 1000000000 + now->tv_nsec + fake.slept_ns;
        *now = (struct timespec){(time_t)(time_ns / 1000000000), (long)(time_ns % 1000000000)};
    }
    return result;
}

/* Nothing is waited for: what would come in that time comes at once, or never. */
int __wrap_poll(struct pollfd *waiting, nfds_t count, int timeout_ms)
{
    if (count != 1 || waiting->fd < 0 || waiting->fd != device_descriptor)
        return __real_poll(waiting, count, timeout_ms);
    if (done.count == 0)
        fake_take(fake.comes_while_waited);
    waiting->revents = fake.poll_events;
    if (unplugged)
        waiting->revents = POLLERR | POLLHUP;
    else if (fake.source_changed)
        waiting->revents |= POLLPRI;
    if (done.count > 0)
        waiting->revents |= POLLIN;
    return waiting->revents != 0;
}
