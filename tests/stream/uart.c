#include "uart.h"

#include <stdbool.h>

enum { BITS_PER_BYTE = 10, DATA_BITS = 8 };

/* Of the line, in the sender's bit times from the beginning; it idles high. */
static bool level_at(const uint8_t *sent, size_t size, double time)
{
    const size_t bit = (size_t)time, byte = bit / BITS_PER_BYTE, place = bit % BITS_PER_BYTE;
    if (byte >= size || place == BITS_PER_BYTE - 1)
        return true;
    return place > 0 && (sent[byte] >> (place - 1) & 1) != 0;
}

/* Looks sixteen times a bit for the line to be low, as hardware does. */
static double next_start(const uint8_t *sent, size_t size, double time, double bit_time)
{
    const double end = (double)size * BITS_PER_BYTE;
    while (time < end && level_at(sent, size, time))
        time += bit_time / 16;
    return time;
}

static uint8_t sample_byte(const uint8_t *sent, size_t size, double start, double bit_time)
{
    uint8_t byte = 0;
    for (unsigned i = 0; i < DATA_BITS; i++)
        if (level_at(sent, size, start + (1.5 + i) * bit_time))
            byte |= (uint8_t)(1u << i);
    return byte;
}

size_t uart_misread(const uint8_t *sent, size_t size, double share, uint8_t *output, size_t room)
{
    const double bit_time = 1 / share, end = (double)size * BITS_PER_BYTE;
    size_t count = 0;
    double time = next_start(sent, size, 0, bit_time);
    while (time < end && count < room) {
        /* What is high again in the middle of the start bit was none. */
        const bool begun = !level_at(sent, size, time + bit_time / 2);
        if (begun)
            output[count++] = sample_byte(sent, size, time, bit_time);
        time = next_start(sent, size, time + (begun ? 9.5 : 0.5) * bit_time, bit_time);
    }
    return count;
}
