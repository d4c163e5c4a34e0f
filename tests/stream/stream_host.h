/* The other end of the line: runs tapemark-stream with a pseudo terminal as its serial port, reads what it says with
 * the microcontroller's receiver, and gives commands. */
#ifndef STREAM_HOST_H
#define STREAM_HOST_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>

#include "tapemark_receiver.h"

enum { HOST_ARGUMENTS_MAX = 40, HOST_SAID_BYTES = 8192, HOST_READ_BYTES = 512 };

typedef struct stream_host {
    pid_t program;
    int line;                /* our end of the terminal; -1: the program was given none */
    int device;              /* its end, held open so that the program may come and go; -1 after host_unplug() */
    char device_path[64];
    int output;              /* the program's standard output; 0: ours */
    int said_pipe;
    char said[HOST_SAID_BYTES];  /* on standard error so far */
    size_t said_size;
    tapemark_receiver receiver;
    uint8_t bytes[2 * HOST_READ_BYTES];
    size_t size, taken;
    uint64_t taken_bytes;    /* by the receiver, so far */
    int64_t record_ns;       /* when the last record was complete */
    /* Gets what came before it is looked at, and may change it: answers how many bytes it is then, up to twice as
     * many. May be NULL. */
    size_t (*on_bytes)(void *context, uint8_t *bytes, size_t size);
    void *context;
} stream_host;

/* A terminal, and no program yet. False when the system has none. */
bool host_open(stream_host *host);

/* Starts the program with these arguments, up to a NULL. "LINE" in an argument becomes the terminal's path. */
bool host_start(stream_host *host, const char *program, const char *const *arguments);

/* The next record that comes within that time, from now on. */
bool host_record(stream_host *host, int timeout_ms, tapemark_record *record);

/* The next one of this type; those before it are passed over. */
bool host_record_of(stream_host *host, tapemark_record_type type, int timeout_ms, tapemark_record *record);

/* Forgets what has come and was not looked at. */
void host_forget(stream_host *host);

void host_command(stream_host *host, uint16_t number, const char *verb, const char *name, const char *value);

/* The terminal goes, as a USB adapter that is pulled out. The program has to know it by a link that is no more: its
 * own name may be that of another terminal at once. */
void host_unplug(stream_host *host);

/* Whether the program has said this on standard error, or does within that time. */
bool host_says(stream_host *host, const char *text, int timeout_ms);

unsigned host_count_said(stream_host *host, const char *text);

/* Whether it has, and host_wait() need not wait. */
bool host_has_ended(const stream_host *host);

/* The exit status; -1 when it does not end within that time, or by a signal. */
int host_wait(stream_host *host, int timeout_ms);

/* Ends everything that is still there. */
void host_close(stream_host *host);

int64_t host_clock_ns(void);

void host_sleep_ms(int time_ms);

#endif
