#include "jpeg_frame.h"

#include <stdlib.h>

static unsigned two_bytes(const uint8_t *bytes)
{
    return (unsigned)bytes[0] << 8 | bytes[1];
}

/* Before any memory is set aside for it: a damaged header may tell of gigabytes. Segments follow one another up to
 * the scan; the one that tells the size is of the kind SOF. */
static bool tells_size(const uint8_t *bytes, size_t size, const frame_layout *expected)
{
    enum { SOF_FIRST = 0xc0, SOF_LAST = 0xcf, HUFFMAN = 0xc4, EXTENSION = 0xc8, ARITHMETIC = 0xcc, SCAN = 0xda };
    size_t at = 2;
    while (at + 9 <= size && bytes[at] == 0xff) {
        uint8_t kind = bytes[at + 1];
        if (kind == 0xff) {
            at++;
            continue;
        }
        bool is_frame = kind >= SOF_FIRST && kind <= SOF_LAST && kind != HUFFMAN && kind != EXTENSION &&
                        kind != ARITHMETIC;
        if (is_frame)
            return two_bytes(bytes + at + 5) == (unsigned)expected->height_px &&
                   two_bytes(bytes + at + 7) == (unsigned)expected->width_px;
        if (kind == SCAN)
            return false;
        at += 2 + two_bytes(bytes + at + 2);
    }
    return false;
}

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
    if (!has_both_ends(bytes, size) || !tells_size(bytes, size, expected) ||
        !opencv_decode_still(bytes, size, &fresh, &ignored))
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
