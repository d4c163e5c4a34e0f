/* PGM pictures, binary and plain, one and several in a file. */
#include "played_frames.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size >= 2 && bytes[0] == 'P' && (bytes[1] == '2' || bytes[1] == '5'))
        play_bytes(bytes, size, NULL);
    return 0;
}
