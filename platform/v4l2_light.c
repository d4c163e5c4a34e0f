/* Exposure and gain of a Video4Linux device: webcams count 100 us, sensors count rows; either may be there. */
#include "v4l2_device.h"

#include <errno.h>
#include <math.h>
#include <string.h>

typedef struct control_range {
    int32_t least;
    int32_t most;
} control_range;

static bool find_control(const v4l2_device *device, uint32_t id, control_range *range)
{
    struct v4l2_queryctrl query = {.id = id};
    if (v4l2_call(device->descriptor, VIDIOC_QUERYCTRL, &query) != 0 || query.flags & V4L2_CTRL_FLAG_DISABLED)
        return false;
    *range = (control_range){query.minimum, query.maximum};
    return true;
}

static int set_control(const v4l2_device *device, uint32_t id, int32_t value)
{
    struct v4l2_control control = {id, value};
    return v4l2_call(device->descriptor, VIDIOC_S_CTRL, &control);
}

static int64_t get_control(const v4l2_device *device, uint32_t id)
{
    struct v4l2_ext_control control = {.id = id};
    struct v4l2_ext_controls controls = {.which = V4L2_CTRL_WHICH_CUR_VAL, .count = 1, .controls = &control};
    if (v4l2_call(device->descriptor, VIDIOC_G_EXT_CTRLS, &controls) != 0)
        return 0;
    return id == V4L2_CID_PIXEL_RATE ? control.value64 : control.value;
}

static int32_t into_range(double value, const control_range *range)
{
    return (int32_t)lround(fmin(fmax(value, range->least), range->most));
}

/* Which control sets the exposure, and the microseconds of one step of it. */
static bool find_exposure(const v4l2_device *device, int32_t width_px, uint32_t *id, control_range *range,
                          double *step_us)
{
    if (find_control(device, V4L2_CID_EXPOSURE_ABSOLUTE, range)) {
        *id = V4L2_CID_EXPOSURE_ABSOLUTE;
        *step_us = 100;
        return true;
    }
    *id = V4L2_CID_EXPOSURE;
    if (!find_control(device, V4L2_CID_EXPOSURE, range))
        return false;
    int64_t pixels_a_second = get_control(device, V4L2_CID_PIXEL_RATE);
    int64_t blank_px = get_control(device, V4L2_CID_HBLANK);
    *step_us = pixels_a_second > 0 ? ((double)width_px + (double)blank_px) * 1e6 / (double)pixels_a_second : 0;
    return *step_us > 0;
}

static bool fix_exposure(v4l2_device *device, int32_t width_px, int32_t *exposure_us, error_text *error)
{
    uint32_t id;
    control_range range, ignored;
    double step_us;
    if (!find_exposure(device, width_px, &id, &range, &step_us)) {
        error_text_set(error, "has no control for the exposure; leave it to the camera");
        return false;
    }
    if (find_control(device, V4L2_CID_EXPOSURE_AUTO, &ignored))
        set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    int32_t steps = into_range(*exposure_us / step_us, &range);
    int failure = set_control(device, id, steps > 0 ? steps : 1);
    if (failure != 0) {
        error_text_set(error, "does not take an exposure of %d us: %s", *exposure_us, strerror(failure));
        return false;
    }
    *exposure_us = (int32_t)lround(fmin((steps > 0 ? steps : 1) * step_us, INT32_MAX));
    return true;
}

/* Webcams know only the aperture's priority as automatic, others only full automatic. Without the control there is
 * nothing to give back. The rate may not fall to make the picture brighter. */
static void free_exposure(v4l2_device *device)
{
    control_range ignored;
    if (find_control(device, V4L2_CID_EXPOSURE_AUTO, &ignored) &&
        set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO) != 0)
        set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY);
    if (find_control(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, &ignored))
        set_control(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
}

static bool fix_gain(v4l2_device *device, double *gain, error_text *error)
{
    control_range range, ignored;
    uint32_t id = V4L2_CID_ANALOGUE_GAIN;
    if (!find_control(device, id, &range)) {
        id = V4L2_CID_GAIN;
        if (!find_control(device, id, &range)) {
            error_text_set(error, "has no control for the gain; leave it to the camera");
            return false;
        }
    }
    if (find_control(device, V4L2_CID_AUTOGAIN, &ignored))
        set_control(device, V4L2_CID_AUTOGAIN, 0);
    int32_t steps = into_range(*gain, &range);
    int failure = set_control(device, id, steps);
    if (failure != 0) {
        error_text_set(error, "does not take a gain of %d: %s", (int)steps, strerror(failure));
        return false;
    }
    *gain = steps;
    return true;
}

bool v4l2_device_set_light(v4l2_device *device, int32_t width_px, int32_t *exposure_us, double *gain,
                           error_text *error)
{
    control_range ignored;
    if (*exposure_us == 0)
        free_exposure(device);
    else if (!fix_exposure(device, width_px, exposure_us, error))
        return false;
    if (*gain > 0)
        return fix_gain(device, gain, error);
    if (find_control(device, V4L2_CID_AUTOGAIN, &ignored))
        set_control(device, V4L2_CID_AUTOGAIN, 1);
    return true;
}
