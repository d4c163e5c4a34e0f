#include "checked_line.h"

#include <string.h>

#include "tapemark_receiver.h"

static uint16_t crc_of(const uint8_t *bytes, size_t size)
{
    uint16_t crc = 0xffff;
    for (size_t i = 0; i < size; i++)
        crc = tapemark_crc16(crc, bytes[i]);
    return crc;
}

static void put_hex(uint8_t *at, unsigned value, int digits)
{
    while (digits-- > 0)
        *at++ = (uint8_t)"0123456789ABCDEF"[value >> 4 * digits & 15];
}

/* What is after the $, up to the *. */
static void check_sentence(uint8_t *body, size_t size)
{
    enum { CRC_DIGITS = 4 };
    uint8_t sum = 0;
    if (size <= CRC_DIGITS)
        return;
    put_hex(body + size - CRC_DIGITS, crc_of(body, size - CRC_DIGITS), CRC_DIGITS);
    for (size_t i = 0; i < size; i++)
        sum ^= body[i];
    put_hex(body + size + 1, sum, 2);
}

static void check_sentences(uint8_t *bytes, size_t size)
{
    for (size_t begin = 0; begin < size; begin++) {
        if (bytes[begin] != '$')
            continue;
        size_t end = begin + 1;
        while (end < size && bytes[end] != '*' && bytes[end] != '$')
            end++;
        if (end + 2 < size && bytes[end] == '*')
            check_sentence(bytes + begin + 1, end - begin - 1);
    }
}

/* One without a 0 in its payload but for those that COBS has taken out, unless the CRC has one. */
static void check_packet(uint8_t *coded, size_t size)
{
    enum { PAYLOAD_MAX = 253, CRC_BYTES = 2 };
    uint8_t payload[PAYLOAD_MAX + 1];
    size_t length = 0;
    for (size_t at = 0; at < size;) {
        const size_t block = coded[at];
        for (size_t i = 1; i < block && at + i < size && length < PAYLOAD_MAX; i++)
            payload[length++] = coded[at + i];
        at += block;
        if (at < size && length < PAYLOAD_MAX)
            payload[length++] = 0;
    }
    if (length <= CRC_BYTES || length + 1 != size)
        return;
    const uint16_t crc = crc_of(payload, length - CRC_BYTES);
    payload[length - 2] = (uint8_t)crc;
    payload[length - 1] = (uint8_t)(crc >> 8);
    size_t block = 0;
    for (size_t i = 0; i <= length; i++) {
        if (i < length && payload[i] != 0) {
            coded[i + 1] = payload[i];
            continue;
        }
        coded[block] = (uint8_t)(i + 1 - block);
        block = i + 1;
    }
}

static void check_packets(uint8_t *bytes, size_t size)
{
    size_t begin = 0;
    for (size_t end = 0; end < size; end++) {
        if (bytes[end] != 0)
            continue;
        if (end > begin && end - begin < 254)
            check_packet(bytes + begin, end - begin);
        begin = end + 1;
    }
}

void check_line(uint8_t *bytes, size_t size)
{
    check_sentences(bytes, size);
    check_packets(bytes, size);
}
