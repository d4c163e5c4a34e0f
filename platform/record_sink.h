/*
 * Where records go: a serial port, a pseudo terminal, standard output, a file, a UDP address; all behind one
 * interface that never waits. Records go out in groups, a frame's with what is said beside it, and a group that has
 * begun is finished.
 *
 * There is no queue. A group is taken only when its first byte would leave at once: until then the caller keeps the
 * newest one, lets it replace the one before, and writes it down (with its age) at the last moment. What a serial
 * line is still busy with is known from its rate and from the system.
 *
 * A port that is not there, is unplugged or fails is opened again by itself, at growing intervals. Only when it has
 * taken bytes it counts as back, so that one that can be opened and not written to makes no news each time.
 *
 * In a loop: record_sink_wants(), poll(), record_sink_step(); then news, read, ready and send as needed.
 */
#ifndef PLATFORM_RECORD_SINK_H
#define PLATFORM_RECORD_SINK_H

#include "error_text.h"

#include <poll.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 255 records of a frame as the longest sentences, and what is said beside them. */
enum { RECORD_GROUP_MAX_BYTES = 24 * 1024 };

typedef struct record_sink record_sink;

typedef enum record_sink_state {
    RECORD_SINK_OPEN,
    RECORD_SINK_STALLED,  /* it is there, but takes no bytes; what it was given is too old by now and thrown away */
    RECORD_SINK_LOST,     /* not there, refused or unplugged; tried again by itself */
    RECORD_SINK_ENDED     /* whoever read standard output is gone for good */
} record_sink_state;

typedef struct record_sink_counts {
    uint64_t records_sent;
    uint64_t records_lost;  /* of groups that had begun, or were given to a sink that could not take them */
    uint64_t failures;      /* times that it was lost or stalled */
} record_sink_counts;

typedef struct record_sink_wait {
    struct pollfd descriptor;  /* .fd is -1 when there is nothing to be polled, which poll() passes over */
    int64_t wake_ns;           /* on CLOCK_MONOTONIC: call record_sink_step() by then; INT64_MAX: no need to */
} record_sink_wait;

/* Takes one of
 *     serial:DEVICE[:BAUD]  8 data bits, no parity, 1 stop bit; 115200 baud unless told
 *     -                     standard output
 *     file:PATH             appended to
 *     pty:PATH              a new pseudo terminal; PATH becomes a link to it
 *     udp:HOST:PORT         a datagram a group; HOST is a number, 192.168.4.1 or [::1], or "localhost"
 * NULL when the name makes no sense. One that makes sense and cannot be opened now gives a sink that is LOST, with
 * the reason as its first news. SIGPIPE is ignored from here on, so that no closed pipe ends the program. */
record_sink *record_sink_open(const char *name, error_text *error);

/* Only whether the name makes sense. */
bool record_sink_check(const char *name, error_text *error);

/* As it was opened. */
const char *record_sink_name(const record_sink *sink);

/* What to wait for next. */
void record_sink_wants(const record_sink *sink, record_sink_wait *wait);

/* Does all that can be done without waiting: goes on with a group, takes in what came back, notices what is wrong,
 * opens again. To be called after each poll(), whatever that found. */
void record_sink_step(record_sink *sink);

record_sink_state record_sink_state_of(const record_sink *sink);

/* True once after each change of state, with one line about it, the sink's name included. */
bool record_sink_news(record_sink *sink, error_text *message);

/* A group that is given now begins to go out at once. Also true of a LOST sink that has been opened again: whether it
 * is back shows with the next group. */
bool record_sink_ready(const record_sink *sink);

/* Gives a group of at most RECORD_GROUP_MAX_BYTES. What is given to a sink that is not ready is lost, and counted.
 * The bytes are copied. */
void record_sink_send(record_sink *sink, const uint8_t *group, size_t size, unsigned record_count);

/* When the last byte given so far leaves, or left: computed from the rate of a serial port, else when the system
 * took it. INT64_MAX while the system has not taken all. On CLOCK_MONOTONIC. */
int64_t record_sink_last_byte_ns(const record_sink *sink);

/* What has come back on the same line, without waiting; 0 when nothing has. */
size_t record_sink_read(record_sink *sink, uint8_t *bytes, size_t size);

record_sink_counts record_sink_counts_of(const record_sink *sink);

/* Does not wait for bytes that are still to go out. NULL is fine. */
void record_sink_close(record_sink *sink);

#ifdef __cplusplus
}
#endif

#endif
