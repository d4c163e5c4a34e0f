/* What a camera can be set to, what is wanted of it, and which of the first serves the second best. */
#ifndef PLATFORM_CAMERA_MODE_H
#define PLATFORM_CAMERA_MODE_H

#include "error_text.h"
#include "frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct camera_mode {
    pixel_format format;  /* of the frames as they are given: GREY where the camera sends JPEGs */
    bool jpeg;
    int32_t width_px;     /* both 0: whatever the device is set to */
    int32_t height_px;
    double rate_hz;       /* 0: not known */
} camera_mode;

/* In pixels of the whole picture; a width of 0 is the whole picture. */
typedef struct camera_region {
    int32_t x_px;
    int32_t y_px;
    int32_t width_px;
    int32_t height_px;
} camera_region;

/* What is 0 or NULL is left to the camera. */
typedef struct camera_wishes {
    const char *format;   /* a name of pixel_format_describe(), or MJPEG */
    int32_t width_px;     /* both or none */
    int32_t height_px;
    double rate_hz;
    int32_t exposure_us;
    double gain;          /* libcamera: a factor; Video4Linux: steps of the device's own */
    camera_region region;
} camera_wishes;

/* As Video4Linux names it: the pixel format's name, or "MJPEG". */
const char *camera_mode_format(const camera_mode *mode);

/* False, with an error, for wishes that no camera could fulfil. */
bool camera_wishes_valid(const camera_wishes *wishes, error_text *error);

/* The mode that serves best: wished format and size first; then a rate of no less than wished (30 a second when
 * nothing is); no JPEG, which costs time and edges; of sizes the largest up to 1280 x 720; the format nearest to
 * gray; the lowest rate that is enough. NULL, with an error, when none has the format and size. */
const camera_mode *camera_mode_choose(const camera_mode *modes, size_t count, const camera_wishes *wishes,
                                      error_text *error);

#ifdef __cplusplus
}
#endif

#endif
