#include "timed_line.h"

#include <poll.h>
#include <unistd.h>

#include "stream_host.h"

enum { BITS_PER_BYTE = 10, LINE_END_BYTES = 2 };

timed_line timed_line_of(int descriptor, unsigned baud)
{
    return (timed_line){.descriptor = descriptor,
                        .byte_ns = baud > 0 ? INT64_C(1000000000) * BITS_PER_BYTE / baud : 0};
}

static bool take_some(timed_line *line, int64_t deadline_ns)
{
    const int64_t left_ms = (deadline_ns - host_clock_ns() + 999999) / 1000000;
    struct pollfd wait = {.fd = line->descriptor, .events = POLLIN};
    if (left_ms <= 0 || poll(&wait, 1, (int)left_ms) <= 0)
        return false;
    const ssize_t count = read(line->descriptor, line->bytes, sizeof line->bytes);
    const int64_t now_ns = host_clock_ns();
    line->taken = 0;
    line->size = count > 0 ? (size_t)count : 0;
    line->chunk_begin_ns = line->free_ns > now_ns ? line->free_ns : now_ns;
    line->free_ns = line->chunk_begin_ns + (int64_t)line->size * line->byte_ns;
    return count >= 0;
}

static int64_t byte_begin_ns(const timed_line *line, size_t index)
{
    return line->chunk_begin_ns + (int64_t)index * line->byte_ns;
}

static bool is_line_end(uint8_t byte)
{
    return byte == '\r' || byte == '\n';
}

/* A sentence is complete before its line end, which belongs to it. */
static void end_record(timed_line *line, int64_t end_ns, unsigned to_come_bytes, timed_frame *times)
{
    times->bytes = line->receiver.record.type == TAPEMARK_RECORD_FRAME ? 0 : times->bytes;
    times->bytes += line->record_bytes + to_come_bytes;
    times->last_ns = end_ns + to_come_bytes * line->byte_ns;
    line->record_bytes = 0;
}

/* Goes through the bytes at hand; false when no record was complete within them. */
static bool next_record(timed_line *line, timed_frame *times)
{
    while (line->taken < line->size) {
        const size_t index = line->taken++;
        const uint8_t byte = line->bytes[index];
        if (line->record_bytes == 0 && is_line_end(byte))
            continue;
        if (line->record_bytes++ == 0)
            line->record_begin_ns = byte_begin_ns(line, index);
        if (tapemark_receiver_push(&line->receiver, byte) == TAPEMARK_RECORD_NONE)
            continue;
        end_record(line, byte_begin_ns(line, index + 1), byte == 0 ? 0 : LINE_END_BYTES, times);
        return true;
    }
    return false;
}

/* The device's clock, which is this machine's, of which the record holds 32 bits. */
static int64_t whole_time_ns(uint32_t time_us, int64_t now_ns)
{
    const uint32_t now_us = (uint32_t)(now_ns / 1000);
    return now_ns / 1000 * 1000 - (int64_t)(now_us - time_us) * 1000;
}

static void begin_frame(const timed_line *line, timed_frame *got)
{
    got->head = line->receiver.record.as.frame;
    got->first_ns = line->record_begin_ns;
    got->capture_ns = whole_time_ns(got->head.capture_us, got->first_ns);
}

bool timed_line_frame(timed_line *line, int timeout_ms, timed_frame *got)
{
    const int64_t deadline_ns = host_clock_ns() + (int64_t)timeout_ms * 1000000;
    bool begun = false;
    unsigned expected = 0;
    got->bytes = 0;
    for (;;) {
        if (!next_record(line, got)) {
            if (!take_some(line, deadline_ns))
                return false;
            continue;
        }
        if (line->receiver.record.type == TAPEMARK_RECORD_FRAME) {
            begin_frame(line, got);
            expected = got->head.records;
            begun = (got->head.flags & TAPEMARK_FRAME_TIMED) != 0;
        } else if (begun) {
            expected--;
        }
        if (begun && expected == 0)
            return true;
    }
}
