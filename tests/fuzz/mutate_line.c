/* Three of four lines get their checks put right. */
#include "checked_line.h"

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t size_max, unsigned seed)
{
    size = LLVMFuzzerMutate(bytes, size, size_max);
    if (seed % 4 != 0)
        check_line(bytes, size);
    return size;
}
