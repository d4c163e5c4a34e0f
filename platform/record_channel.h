/* The ways out that record_sink.c manages: what differs between a serial port, a pipe, a file, a pseudo terminal and
 * UDP. Not for others. */
#ifndef PLATFORM_RECORD_CHANNEL_H
#define PLATFORM_RECORD_CHANNEL_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct record_channel record_channel;

typedef struct record_channel_methods {
    /* Both answer the number of bytes, 0 when none can go now, -1 when the channel is of no more use. */
    ptrdiff_t (*write)(record_channel *self, const uint8_t *bytes, size_t size, error_text *error);
    ptrdiff_t (*read)(record_channel *self, uint8_t *bytes, size_t size, error_text *error);  /* NULL: one way */
    size_t (*waiting_bytes)(const record_channel *self);  /* taken and not yet gone; NULL: not known */
    void (*flush)(record_channel *self);                  /* throws those away; NULL: cannot */
    int (*descriptor)(const record_channel *self);        /* for poll(); -1: none for now */
    void (*close)(record_channel *self);
} record_channel_methods;

/* The first member of each kind. */
struct record_channel {
    const record_channel_methods *methods;
    short gone_events;        /* what poll() tells when the other end is gone */
    int64_t byte_ns;          /* what a byte takes on the line; 0: next to nothing */
};

typedef struct record_channel_kind {
    const char *prefix;
    bool ends;  /* when it is lost, there is no opening it again */
    /* Only whether what follows the prefix makes sense. */
    bool (*check)(const char *target, error_text *error);
    /* NULL on failure. */
    record_channel *(*open)(const char *target, error_text *error);
} record_channel_kind;

extern const record_channel_kind record_channel_serial;
extern const record_channel_kind record_channel_stdout;
extern const record_channel_kind record_channel_file;
extern const record_channel_kind record_channel_pty;
extern const record_channel_kind record_channel_udp;

/* What write() and read() answer when the system call answered `count`. */
ptrdiff_t record_channel_moved(ptrdiff_t count, error_text *error);

#endif
