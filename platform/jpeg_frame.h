/* JPEGs as cameras send them, one a frame, to gray. */
#ifndef PLATFORM_JPEG_FRAME_H
#define PLATFORM_JPEG_FRAME_H

#include "opencv_media.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Zeroed before the first use. */
typedef struct jpeg_frame {
    gray_picture picture;
} jpeg_frame;

/* False when the JPEG is damaged, has no end or another size. The picture stays until the next call. */
bool jpeg_frame_decode(jpeg_frame *decoder, const uint8_t *bytes, size_t size, const frame_layout *expected);

void jpeg_frame_release(jpeg_frame *decoder);

#ifdef __cplusplus
}
#endif

#endif
