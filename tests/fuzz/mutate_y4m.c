/* A Y4M file of which the header tells another size than its frames have ends at the first frame. So, every other
 * time, the frames are made anew after the header: as many of the right size as there is room for, three at most. */
#include <string.h>

#include "fuzz_target.h"

enum { HEADER_MAX_BYTES = 200, FRAMES_MAX = 3 };

static unsigned long side_after(const char *header, const char *key)
{
    const char *at = strstr(header, key);
    return at != NULL ? strtoul(at + strlen(key), NULL, 10) : 0;
}

/* Enough of them for most kinds of chroma. */
static size_t frame_bytes(const char *header)
{
    const size_t luma = side_after(header, " W") * side_after(header, " H");
    const size_t sample_bytes = strstr(header, "10") || strstr(header, "12") || strstr(header, "16") ? 2 : 1;
    const size_t chroma = strstr(header, "mono")  ? 0
                          : strstr(header, "444") ? 2 * luma
                          : strstr(header, "422") ? luma
                                                  : luma / 2;
    return sample_bytes * (luma + chroma);
}

static size_t append_frames(uint8_t *bytes, size_t size, size_t size_max, size_t frame, unsigned seed)
{
    static const char tag[] = "FRAME\n";
    for (int i = 0; i < FRAMES_MAX && size + sizeof tag - 1 + frame <= size_max; i++) {
        memcpy(bytes + size, tag, sizeof tag - 1);
        size += sizeof tag - 1;
        memset(bytes + size, (int)(seed & 0xff), frame);
        size += frame;
    }
    return size;
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t size_max, unsigned seed)
{
    char header[HEADER_MAX_BYTES + 1] = "";
    size = LLVMFuzzerMutate(bytes, size, size_max);
    const uint8_t *end = memchr(bytes, '\n', size < HEADER_MAX_BYTES ? size : HEADER_MAX_BYTES);
    if (seed % 2 == 0 || end == NULL)
        return size;
    memcpy(header, bytes, (size_t)(end - bytes));
    const size_t frame = frame_bytes(header);
    if (frame == 0 || frame > size_max)
        return size;
    return append_frames(bytes, (size_t)(end - bytes) + 1, size_max, frame, seed);
}
