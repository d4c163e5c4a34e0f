/* What the tests of the whole program share: cmocka, the program at the end of a terminal, and records from it. */
#ifndef STREAM_TEST_H
#define STREAM_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cmocka.h>

#include "stream_host.h"
#include "walk_check.h"

#define WALK "file:" STREAM_DATA "/walk.y4m"
#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Long: a program with sanitizers on a busy machine takes seconds to begin. */
enum { SOON_MS = 30000 };

static truth walk;
static stream_host host;

static inline int read_truth(void **state)
{
    (void)state;
    return truth_read(STREAM_DATA "/walk.jsonl", &walk) && walk.count == WALK_FRAMES ? 0 : -1;
}

static inline int open_host(void **state)
{
    (void)state;
    return host_open(&host) ? 0 : -1;
}

static inline int close_host(void **state)
{
    (void)state;
    host_close(&host);
    return 0;
}

static inline void start(const char *const *arguments)
{
    assert_true(host_start(&host, STREAM_PROGRAM, arguments));
}

static inline tapemark_record expect_record(tapemark_record_type type)
{
    tapemark_record record;
    if (!host_record_of(&host, type, SOON_MS, &record))
        fail_msg("no record of type %d came; the program said: %s", (int)type, host.said);
    return record;
}

/* The next record; false when the program has ended, and all that it sent was taken. */
static inline bool next_before_end(tapemark_record *record)
{
    enum { ON_ITS_WAY_MS = 200 };
    for (int waited_ms = 0; waited_ms < SOON_MS; waited_ms += ON_ITS_WAY_MS) {
        const bool ended = host_has_ended(&host);
        if (host_record(&host, ON_ITS_WAY_MS, record))
            return true;
        if (ended)
            return false;
    }
    host_count_said(&host, "\n");
    fail_msg("no record came, and the program does not end; it said: %s", host.said);
    return false;
}

/* Older than two frame times, which are those of the camera, or of the frames that the machine could take, where
 * those are further apart: of frames that are sent, each in its turn. */
static inline bool is_too_old(const tapemark_frame_record *head, unsigned rate_hz)
{
    static uint32_t last_us;
    const uint32_t apart_us = head->capture_us - last_us, frame_us = 1000000 / rate_hz;
    if ((head->flags & TAPEMARK_FRAME_TIMED) == 0)
        return false;
    last_us = head->capture_us;
    return head->age_10us > 2 * (apart_us > frame_us ? apart_us : frame_us) / 10;
}

static inline void expect_silence(void)
{
    if (host_count_said(&host, "\n") > 0)
        fail_msg("the program said: %s", host.said);
}

/* Only on a machine that has time: the best of so many tries counts. */
enum { TRIES_MAX = 20 };

/* The next FRAME of which this holds; the test fails when it does not come to hold soon. */
static inline tapemark_record expect_frame(bool (*holds)(const tapemark_frame_record *head), const char *what)
{
    for (int i = 0; i < 200; i++) {
        tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        if (holds(&record.as.frame))
            return record;
    }
    fail_msg("no frame %s", what);
    return (tapemark_record){0};
}

#endif
