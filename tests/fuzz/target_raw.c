/* Headerless captures: the first line is their layout as users write it, the rest is the file. */
#include <string.h>

#include "played_frames.h"

enum { LAYOUT_MAX_BYTES = 80, FRAME_MAX_BYTES = 1 << 20 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char text[LAYOUT_MAX_BYTES + 1] = "";
    error_text error = {""};
    frame_layout layout;
    const uint8_t *end = memchr(bytes, '\n', size < LAYOUT_MAX_BYTES ? size : LAYOUT_MAX_BYTES);
    if (end == NULL)
        return 0;
    memcpy(text, bytes, (size_t)(end - bytes));
    if (!frame_layout_parse(text, &layout, &error)) {
        CLAIM(error.text[0] != '\0');
        return 0;
    }
    const size_t frame_bytes = frame_layout_size_bytes(&layout);
    CLAIM(frame_bytes > 0);
    CLAIM(layout.stride_bytes >= frame_layout_least_stride(layout.format, layout.width_px));
    end++;
    if (frame_bytes <= FRAME_MAX_BYTES)
        play_bytes(end, size - (size_t)(end - bytes), &layout);
    return 0;
}
