/* The CRC of each chunk is put right, three times of four. */
#include "fuzz_target.h"

static uint32_t crc32_of(const uint8_t *bytes, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static void put_big_endian(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t size_max, unsigned seed)
{
    enum { MAGIC_BYTES = 8, LENGTH_BYTES = 4, KIND_BYTES = 4, CRC_BYTES = 4 };
    size = LLVMFuzzerMutate(bytes, size, size_max);
    for (size_t at = MAGIC_BYTES; seed % 4 != 0 && at + LENGTH_BYTES + KIND_BYTES + CRC_BYTES <= size;) {
        const size_t content = big_endian(bytes + at);
        if (content > size - at - LENGTH_BYTES - KIND_BYTES - CRC_BYTES)
            break;
        uint8_t *const kind = bytes + at + LENGTH_BYTES;
        put_big_endian(kind + KIND_BYTES + content, crc32_of(kind, KIND_BYTES + content));
        at += LENGTH_BYTES + KIND_BYTES + content + CRC_BYTES;
    }
    return size;
}
