/* JPEGs: one after another in a file, and as cameras send them. What OpenCV makes of one is OpenCV's; where it ends,
 * how large it may be and what is taken of it is ours. */
#include <string.h>

#include "byte_script.h"
#include "jpeg_frame.h"
#include "played_frames.h"

/* OpenCV takes as much memory as a header tells it to. */
static bool is_small(const uint8_t *bytes, size_t size)
{
    enum { SIDE_MAX_PX = 1024 };
    for (size_t i = 0; i + 9 < size; i++) {
        const bool is_frame = bytes[i] == 0xff && bytes[i + 1] >= 0xc0 && bytes[i + 1] <= 0xcf;
        const uint32_t height = (uint32_t)bytes[i + 5] << 8 | bytes[i + 6];
        const uint32_t width = (uint32_t)bytes[i + 7] << 8 | bytes[i + 8];
        if (is_frame && height * width > SIDE_MAX_PX * SIDE_MAX_PX)
            return false;
    }
    return true;
}

static void decode_frame(const uint8_t *bytes, size_t size, jpeg_frame *decoder)
{
    const frame_layout expected = {PIXEL_GREY, 16, 16, 16};
    uint8_t *exact = exact_memory(size);
    memcpy(exact, bytes, size);
    if (jpeg_frame_decode(decoder, exact, size, &expected))
        CLAIM(decoder->picture.pixels != NULL && decoder->picture.width_px == 16 && decoder->picture.height_px == 16);
    free(exact);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    jpeg_frame decoder = {0};
    if (!is_small(bytes, size))
        return 0;
    decode_frame(bytes, size, &decoder);
    decode_frame(bytes, size / 2, &decoder);
    if (size >= 3 && memcmp(bytes, "\xff\xd8\xff", 3) == 0)
        play_bytes(bytes, size, NULL);
    jpeg_frame_release(&decoder);
    return 0;
}
