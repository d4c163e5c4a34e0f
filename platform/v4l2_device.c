#include "v4l2_device.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* Drivers end their lists themselves; this ends those of drivers that do not. */
enum { LIST_MAX = 256 };

typedef struct v4l2_coding {
    uint32_t fourcc;
    pixel_format format;
    bool jpeg;
} v4l2_coding;

static const v4l2_coding codings[] = {
    {V4L2_PIX_FMT_GREY, PIXEL_GREY, false},          {V4L2_PIX_FMT_Y10, PIXEL_Y10, false},
    {V4L2_PIX_FMT_Y12, PIXEL_Y12, false},            {V4L2_PIX_FMT_Y16, PIXEL_Y16, false},
    {V4L2_PIX_FMT_Y10P, PIXEL_Y10P, false},          {V4L2_PIX_FMT_YUYV, PIXEL_YUYV, false},
    {V4L2_PIX_FMT_UYVY, PIXEL_UYVY, false},          {V4L2_PIX_FMT_NV12, PIXEL_NV12, false},
    {V4L2_PIX_FMT_YUV420, PIXEL_YU12, false},        {V4L2_PIX_FMT_SRGGB8, PIXEL_SRGGB8, false},
    {V4L2_PIX_FMT_SGRBG8, PIXEL_SGRBG8, false},      {V4L2_PIX_FMT_SGBRG8, PIXEL_SGBRG8, false},
    {V4L2_PIX_FMT_SBGGR8, PIXEL_SBGGR8, false},      {V4L2_PIX_FMT_SRGGB10, PIXEL_SRGGB10, false},
    {V4L2_PIX_FMT_SGRBG10, PIXEL_SGRBG10, false},    {V4L2_PIX_FMT_SGBRG10, PIXEL_SGBRG10, false},
    {V4L2_PIX_FMT_SBGGR10, PIXEL_SBGGR10, false},    {V4L2_PIX_FMT_SRGGB10P, PIXEL_SRGGB10P, false},
    {V4L2_PIX_FMT_SGRBG10P, PIXEL_SGRBG10P, false},  {V4L2_PIX_FMT_SGBRG10P, PIXEL_SGBRG10P, false},
    {V4L2_PIX_FMT_SBGGR10P, PIXEL_SBGGR10P, false},  {V4L2_PIX_FMT_MJPEG, PIXEL_GREY, true},
    {V4L2_PIX_FMT_JPEG, PIXEL_GREY, true},
};

static const v4l2_coding *coding_of_fourcc(uint32_t fourcc)
{
    for (size_t i = 0; i < sizeof codings / sizeof *codings; i++)
        if (codings[i].fourcc == fourcc)
            return &codings[i];
    return NULL;
}

int v4l2_call(int descriptor, unsigned long request, void *argument)
{
    enum { TRIES_MAX = 100 };
    int failure = EINTR;
    for (int i = 0; i < TRIES_MAX && failure == EINTR; i++)
        failure = ioctl(descriptor, request, argument) < 0 ? errno : 0;
    return failure;
}

static void explain_open(int failure, error_text *error)
{
    if (failure == EACCES || failure == EPERM)
        error_text_set(error, "may not be opened; who runs this has to be in the group video");
    else if (failure == EBUSY)
        error_text_set(error, "is used by another program");
    else
        error_text_set(error, "cannot be opened: %s", strerror(failure));
}

static bool ask_capabilities(v4l2_device *device, error_text *error)
{
    struct v4l2_capability answer = {0};
    int failure = v4l2_call(device->descriptor, VIDIOC_QUERYCAP, &answer);
    if (failure == ENOTTY || failure == EINVAL) {
        error_text_set(error, "is no Video4Linux device");
        return false;
    }
    if (failure != 0) {
        error_text_set(error, "does not tell what it can do: %s", strerror(failure));
        return false;
    }
    uint32_t able = answer.capabilities & V4L2_CAP_DEVICE_CAPS ? answer.device_caps : answer.capabilities;
    snprintf(device->card, sizeof device->card, "%.*s", (int)sizeof answer.card, (const char *)answer.card);
    device->routed = (able & V4L2_CAP_IO_MC) != 0;
    if (able & V4L2_CAP_VIDEO_CAPTURE && able & V4L2_CAP_STREAMING)
        return true;
    if (able & V4L2_CAP_VIDEO_CAPTURE_MPLANE)
        error_text_set(error, "gives its pictures in several planes, which only libcamera reads: try libcamera:0");
    else
        error_text_set(error, "is no camera: it does not stream pictures");
    return false;
}

bool v4l2_device_open(v4l2_device *device, const char *path, error_text *error)
{
    *device = (v4l2_device){.descriptor = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC)};
    if (device->descriptor < 0) {
        explain_open(errno, error);
        return false;
    }
    if (ask_capabilities(device, error))
        return true;
    v4l2_device_close(device);
    return false;
}

void v4l2_device_close(v4l2_device *device)
{
    if (device->descriptor >= 0)
        close(device->descriptor);
    device->descriptor = -1;
}

static void add_mode(v4l2_device *device, const v4l2_coding *coding, uint32_t width_px, uint32_t height_px,
                     double rate_hz)
{
    if (device->mode_count == V4L2_MODES_MAX || width_px > FRAME_SIDE_MAX_PX || height_px > FRAME_SIDE_MAX_PX)
        return;
    device->modes[device->mode_count++] =
        (camera_mode){coding->format, coding->jpeg, (int32_t)width_px, (int32_t)height_px, rate_hz};
}

static double rate_of(const struct v4l2_fract *interval)
{
    return interval->numerator != 0 ? (double)interval->denominator / interval->numerator : 0;
}

/* One mode a rate. Rates without steps are as good as one: the wished one moved into their range. */
static void add_size(v4l2_device *device, const v4l2_coding *coding, uint32_t width_px, uint32_t height_px,
                     const camera_wishes *wishes)
{
    struct v4l2_frmivalenum interval = {.pixel_format = coding->fourcc, .width = width_px, .height = height_px};
    bool any = false;
    for (; interval.index < LIST_MAX; interval.index++) {
        if (v4l2_call(device->descriptor, VIDIOC_ENUM_FRAMEINTERVALS, &interval) != 0)
            break;
        any = true;
        if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
            double wanted_hz = wishes->rate_hz > 0 ? wishes->rate_hz : 30;
            double highest_hz = rate_of(&interval.stepwise.min);
            double lowest_hz = rate_of(&interval.stepwise.max);
            add_mode(device, coding, width_px, height_px, fmin(fmax(wanted_hz, lowest_hz), highest_hz));
            break;
        }
        add_mode(device, coding, width_px, height_px, rate_of(&interval.discrete));
    }
    if (!any)
        add_mode(device, coding, width_px, height_px, 0);
}

static bool on_steps(uint32_t side, uint32_t least, uint32_t most, uint32_t step)
{
    return side >= least && side <= most && (side - least) % (step > 0 ? step : 1) == 0;
}

static void add_stepwise_sizes(v4l2_device *device, const v4l2_coding *coding,
                               const struct v4l2_frmsize_stepwise *range, const camera_wishes *wishes)
{
    const uint32_t sizes[][2] = {
        {(uint32_t)wishes->width_px, (uint32_t)wishes->height_px}, {1280, 720}, {640, 480},
        {range->min_width, range->min_height}, {range->max_width, range->max_height},
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        if (sizes[i][0] > 0 && on_steps(sizes[i][0], range->min_width, range->max_width, range->step_width) &&
            on_steps(sizes[i][1], range->min_height, range->max_height, range->step_height))
            add_size(device, coding, sizes[i][0], sizes[i][1], wishes);
}

static void add_coding(v4l2_device *device, const v4l2_coding *coding, const camera_wishes *wishes)
{
    struct v4l2_frmsizeenum size = {.pixel_format = coding->fourcc};
    for (; size.index < LIST_MAX; size.index++) {
        if (v4l2_call(device->descriptor, VIDIOC_ENUM_FRAMESIZES, &size) != 0)
            break;
        if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
            add_stepwise_sizes(device, coding, &size.stepwise, wishes);
            return;
        }
        add_size(device, coding, size.discrete.width, size.discrete.height, wishes);
    }
    /* Capture cards and the like have the size of what they are connected to, and no list. */
    if (size.index == 0)
        add_mode(device, coding, 0, 0, 0);
}

void v4l2_device_list_modes(v4l2_device *device, const camera_wishes *wishes)
{
    struct v4l2_fmtdesc description = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    device->mode_count = 0;
    for (; description.index < LIST_MAX; description.index++) {
        if (v4l2_call(device->descriptor, VIDIOC_ENUM_FMT, &description) != 0)
            break;
        const v4l2_coding *coding = coding_of_fourcc(description.pixelformat);
        if (coding != NULL && coding->jpeg)
            device->jpeg_fourcc = coding->fourcc;
        if (coding != NULL)
            add_coding(device, coding, wishes);
    }
}

/* The driver's answer as a layout; false when frames of it cannot be read. */
static bool take_picture(const struct v4l2_pix_format *answer, const v4l2_coding *coding, v4l2_picture *picture,
                         error_text *error)
{
    if (answer->width < 1 || answer->width > FRAME_SIDE_MAX_PX || answer->height < 1 ||
        answer->height > FRAME_SIDE_MAX_PX) {
        error_text_set(error, "answers with an impossible size of %ux%u px", answer->width, answer->height);
        return false;
    }
    frame_layout *layout = &picture->layout;
    *layout = (frame_layout){coding->format, (int32_t)answer->width, (int32_t)answer->height, answer->bytesperline};
    picture->image_bytes = answer->sizeimage;
    if (coding->jpeg) {
        layout->stride_bytes = answer->width;
        return true;
    }
    if (layout->stride_bytes == 0)
        layout->stride_bytes = frame_layout_least_stride(layout->format, layout->width_px);
    size_t bytes = frame_layout_size_bytes(layout);
    if (bytes == 0 || answer->sizeimage < bytes) {
        error_text_set(error, "answers with rows of %u bytes and pictures of %u, which %s:%ux%u does not fit into",
                       answer->bytesperline, answer->sizeimage, pixel_format_describe(layout->format)->name,
                       answer->width, answer->height);
        return false;
    }
    return true;
}

static const v4l2_coding *coding_of_mode(const v4l2_device *device, const camera_mode *mode)
{
    for (size_t i = 0; i < sizeof codings / sizeof *codings; i++)
        if (mode->jpeg ? codings[i].fourcc == device->jpeg_fourcc : codings[i].format == mode->format)
            return &codings[i];
    return NULL;
}

bool v4l2_device_set_picture(v4l2_device *device, const camera_mode *mode, v4l2_picture *picture, error_text *error)
{
    struct v4l2_format format = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    const v4l2_coding *coding = coding_of_mode(device, mode);
    int failure = v4l2_call(device->descriptor, VIDIOC_G_FMT, &format);
    if (failure == 0) {
        struct v4l2_pix_format *wanted = &format.fmt.pix;
        *wanted = (struct v4l2_pix_format){
            .width = mode->width_px > 0 ? (uint32_t)mode->width_px : wanted->width,
            .height = mode->width_px > 0 ? (uint32_t)mode->height_px : wanted->height,
            .pixelformat = coding->fourcc,
            .field = V4L2_FIELD_NONE,
        };
        failure = v4l2_call(device->descriptor, VIDIOC_S_FMT, &format);
    }
    const struct v4l2_pix_format *answer = &format.fmt.pix;
    if (failure == EBUSY)
        error_text_set(error, "is used by another program");
    else if (failure != 0)
        error_text_set(error, "cannot be set to %s: %s", camera_mode_format(mode), strerror(failure));
    else if (answer->pixelformat != coding->fourcc)
        error_text_set(error, "does not give %s after all", camera_mode_format(mode));
    else if (answer->field != V4L2_FIELD_NONE && answer->field != V4L2_FIELD_ANY)
        error_text_set(error, "gives interlaced pictures; only progressive ones can be read");
    else if (mode->width_px > 0 &&
             (answer->width != (uint32_t)mode->width_px || answer->height != (uint32_t)mode->height_px))
        error_text_set(error, "answers with %ux%u px instead of %dx%d", answer->width, answer->height,
                       mode->width_px, mode->height_px);
    else
        return take_picture(answer, coding, picture, error);
    return false;
}

double v4l2_device_set_rate(v4l2_device *device, double rate_hz)
{
    struct v4l2_streamparm parameters = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE};
    struct v4l2_captureparm *capture = &parameters.parm.capture;
    if (v4l2_call(device->descriptor, VIDIOC_G_PARM, &parameters) != 0)
        return 0;
    if (rate_hz > 0 && capture->capability & V4L2_CAP_TIMEPERFRAME) {
        capture->timeperframe = (struct v4l2_fract){1000, (uint32_t)lround(rate_hz * 1000)};
        if (v4l2_call(device->descriptor, VIDIOC_S_PARM, &parameters) != 0)
            return 0;
    }
    return rate_of(&capture->timeperframe);
}

static bool reset_region(v4l2_device *device)
{
    struct v4l2_selection selection = {.type = V4L2_BUF_TYPE_VIDEO_CAPTURE, .target = V4L2_SEL_TGT_CROP_DEFAULT};
    if (v4l2_call(device->descriptor, VIDIOC_G_SELECTION, &selection) == 0) {
        selection.target = V4L2_SEL_TGT_CROP;
        v4l2_call(device->descriptor, VIDIOC_S_SELECTION, &selection);
    }
    return true;
}

bool v4l2_device_set_region(v4l2_device *device, camera_region *region, error_text *error)
{
    if (region->width_px == 0)
        return reset_region(device);
    struct v4l2_selection selection = {
        .type = V4L2_BUF_TYPE_VIDEO_CAPTURE,
        .target = V4L2_SEL_TGT_CROP,
        .r = {region->x_px, region->y_px, (uint32_t)region->width_px, (uint32_t)region->height_px},
    };
    int failure = v4l2_call(device->descriptor, VIDIOC_S_SELECTION, &selection);
    if (failure != 0) {
        error_text_set(error, "cannot give a region of its picture: %s",
                       failure == ENOTTY ? "the device does not crop" : strerror(failure));
        return false;
    }
    const struct v4l2_rect *got = &selection.r;
    if (got->left < 0 || got->top < 0 || got->width < 1 || got->width > FRAME_SIDE_MAX_PX || got->height < 1 ||
        got->height > FRAME_SIDE_MAX_PX) {
        error_text_set(error, "answers with an impossible region");
        return false;
    }
    *region = (camera_region){got->left, got->top, (int32_t)got->width, (int32_t)got->height};
    return true;
}
