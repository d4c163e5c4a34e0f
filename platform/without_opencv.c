/* In place of opencv_media.cpp where it was left out: PGM, Y4M and raw frames can be read all the same. A
 * preview stays empty. */
#include "opencv_media.h"

bool opencv_decode_still(const uint8_t *bytes, size_t size, gray_picture *picture, error_text *error)
{
    (void)bytes;
    (void)size;
    (void)picture;
    error_text_set(error, "is a picture that this program cannot read: it was built without OpenCV");
    return false;
}

size_t opencv_encode_jpeg(const uint8_t *bgr, int32_t width_px, int32_t height_px, uint8_t **bytes, size_t *capacity)
{
    (void)bgr;
    (void)width_px;
    (void)height_px;
    (void)bytes;
    (void)capacity;
    return 0;
}

frame_source *opencv_video_open(const char *path, error_text *error)
{
    (void)path;
    error_text_set(error, "is a video that this program cannot read: it was built without OpenCV");
    return NULL;
}
