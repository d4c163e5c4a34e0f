/* PNG pictures of all depths and kinds of colour, transparent ones among them. What OpenCV makes of one is OpenCV's;
 * what is made of that is ours. */
#include <string.h>

#include "played_frames.h"

/* OpenCV takes as much memory as a header tells it to. */
static bool is_small(const uint8_t *bytes, size_t size)
{
    enum { WIDTH_AT = 16, HEIGHT_AT = 20, HEAD_BYTES = 26 };
    static const uint8_t none[3] = {0};
    return size >= HEAD_BYTES && memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) == 0 &&
           memcmp(bytes + WIDTH_AT, none, 3) == 0 && memcmp(bytes + HEIGHT_AT, none, 3) == 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (is_small(bytes, size))
        play_bytes(bytes, size, NULL);
    return 0;
}
