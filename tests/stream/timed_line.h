/* The other end of a line, byte by byte: when each frame begins and ends on the wire. Bytes are taken as they come;
 * on a serial line each then leaves as its rate has it, one after the other, as from a serial port's hardware. */
#ifndef TIMED_LINE_H
#define TIMED_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tapemark_receiver.h"

/* All zero but for the first two. */
typedef struct timed_line {
    int descriptor;
    int64_t byte_ns;         /* 0: no serial line */
    int64_t free_ns;         /* when the wire has carried all that was taken */
    tapemark_receiver receiver;
    uint8_t bytes[2048];
    size_t size, taken;
    int64_t chunk_begin_ns;  /* when the first of them began to leave */
    int64_t record_begin_ns;
    size_t record_bytes;     /* of the one that is coming in; 0: none has begun */
} timed_line;

/* Times are those of CLOCK_MONOTONIC. */
typedef struct timed_frame {
    tapemark_frame_record head;
    int64_t capture_ns;  /* as the FRAME says */
    int64_t first_ns;    /* when its first byte began to leave */
    int64_t last_ns;     /* when its last byte had left, that of its markers included */
    size_t bytes;
} timed_frame;

/* 8 data bits, a start and a stop bit. */
timed_line timed_line_of(int descriptor, unsigned baud);

/* The next whole frame with a time; false when none comes in time. What goes between frames takes its time, too. */
bool timed_line_frame(timed_line *line, int timeout_ms, timed_frame *got);

#endif
