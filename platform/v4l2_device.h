/* A Video4Linux capture device: what it can do, and setting it up. camera_v4l2.c streams from it. */
#ifndef PLATFORM_V4L2_DEVICE_H
#define PLATFORM_V4L2_DEVICE_H

#include "camera_mode.h"

#include <linux/videodev2.h>

enum { V4L2_MODES_MAX = 512 };

typedef struct v4l2_device {
    int descriptor;
    char card[33];
    bool routed;           /* its picture comes from other devices, which have to be set up first */
    uint32_t jpeg_fourcc;  /* two codes mean JPEG: the one that it listed */
    camera_mode modes[V4L2_MODES_MAX];
    size_t mode_count;
} v4l2_device;

/* As set: what the driver answered. */
typedef struct v4l2_picture {
    frame_layout layout;  /* of the frames that come; not for JPEGs, but for their sides */
    size_t image_bytes;   /* of the largest frame */
} v4l2_picture;

/* ioctl() that goes on after signals; 0, or what errno was. */
int v4l2_call(int descriptor, unsigned long request, void *argument);

bool v4l2_device_open(v4l2_device *device, const char *path, error_text *error);
void v4l2_device_close(v4l2_device *device);

/* Finds out the modes. Of sizes that go in steps, those listed are the wished one and some usual ones. */
void v4l2_device_list_modes(v4l2_device *device, const camera_wishes *wishes);

/* Sets format and size; fails when the driver answers with others than were asked for. */
bool v4l2_device_set_picture(v4l2_device *device, const camera_mode *mode, v4l2_picture *picture, error_text *error);

/* Returns the rate that was set; 0 when the device does not tell. */
double v4l2_device_set_rate(v4l2_device *device, double rate_hz);

/* Lets only a part of the picture be sent; a width of 0 is all of it again. */
bool v4l2_device_set_region(v4l2_device *device, camera_region *region, error_text *error);

/* What exposure and gain became stands in both afterwards; 0 leaves them to the camera, where it can. */
bool v4l2_device_set_light(v4l2_device *device, int32_t width_px, int32_t *exposure_us, double *gain,
                           error_text *error);

#endif
