#include "jpeg_frame.h"

#include <stdlib.h>

/* Cameras fill up what is behind the end of the picture; where there is no end, OpenCV would show gray in its place
 * and say nothing. */
static bool has_both_ends(const uint8_t *bytes, size_t size)
{
    if (size < 4 || bytes[0] != 0xff || bytes[1] != 0xd8)
        return false;
    while (size > 4 && bytes[size - 1] != 0xd9)
        size--;
    return bytes[size - 2] == 0xff && bytes[size - 1] == 0xd9;
}

bool jpeg_frame_decode(jpeg_frame *decoder, const uint8_t *bytes, size_t size, const frame_layout *expected)
{
    error_text ignored;
    gray_picture last = decoder->picture;
    gray_picture fresh = {0};
    if (!has_both_ends(bytes, size) || !opencv_decode_still(bytes, size, &fresh, &ignored))
        return false;
    decoder->picture = fresh;
    free(last.pixels);
    return fresh.width_px == expected->width_px && fresh.height_px == expected->height_px;
}

void jpeg_frame_release(jpeg_frame *decoder)
{
    free(decoder->picture.pixels);
    *decoder = (jpeg_frame){0};
}
