/* Y4M videos. */
#include <string.h>

#include "played_frames.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static const char magic[] = "YUV4MPEG2";
    if (size >= sizeof magic - 1 && memcmp(bytes, magic, sizeof magic - 1) == 0)
        play_bytes(bytes, size, NULL);
    return 0;
}
