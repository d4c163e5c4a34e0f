/*
 * What OpenCV does for us, behind a C interface: still pictures and videos to gray, gray to PNG, colour to JPEG.
 * OpenCV and the libraries below it print their complaints themselves; while they work, standard error is
 * pointed at /dev/null, so that users get one line, ours.
 */
#ifndef PLATFORM_OPENCV_MEDIA_H
#define PLATFORM_OPENCV_MEDIA_H

#include "frame_source.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gray_picture {
    uint8_t *pixels;  /* rows without gaps; malloc'ed, the caller frees it */
    int32_t width_px;
    int32_t height_px;
} gray_picture;

/* A whole still picture in memory. Transparent parts show white, orientation tags are followed. */
bool opencv_decode_still(const uint8_t *bytes, size_t size, gray_picture *picture, error_text *error);

/* A gray picture, rows without gaps, as PNG. The caller frees the bytes. */
bool opencv_encode_png(const uint8_t *pixels, int32_t width_px, int32_t height_px, uint8_t **bytes, size_t *size,
                       error_text *error);

/* A picture in colour (blue, green, red) as JPEG, in memory that is used again: `*bytes` is malloc'ed, of
 * `*capacity`, and grows as needed. Any thread. Answers the JPEG's size, 0 when memory runs out. */
size_t opencv_encode_jpeg(const uint8_t *bgr, int32_t width_px, int32_t height_px, uint8_t **bytes, size_t *capacity);

/* A video file, read through FFmpeg. Rotation tags are followed. NULL on failure. */
frame_source *opencv_video_open(const char *path, error_text *error);

#ifdef __cplusplus
}
#endif

#endif
