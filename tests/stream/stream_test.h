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
