/* What the tests of record sinks share: a loop around a sink, and the other end of a terminal. */
#ifndef SINK_TEST_H
#define SINK_TEST_H

#include "record_sink.h"

/* cmocka.h wants these before it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

int64_t now_ms(void);

/* Steps the sink as a program does, for so long; answers how often the loop went round. */
int run_for(record_sink *sink, int64_t duration_ms);

/* Until it is so, or for 30 s; false when it did not come to that. */
bool run_until_state(record_sink *sink, record_sink_state state);
bool run_until_ready(record_sink *sink);
bool run_until_sent(record_sink *sink, uint64_t records);

/* Likewise, until so many bytes have come; answers how many have. */
size_t run_until_read(record_sink *sink, uint8_t *bytes, size_t wanted);

/* A directory of this test's own, with a slash at its end. */
const char *own_directory(void);
void remove_own_directory(void);

/* A path in it; each of the last few stays valid. */
const char *own_path(const char *name);

/* Makes a pseudo terminal whose other end the sink can open at `link`; the descriptor of this end, which does not
 * wait. */
int terminal_at(const char *link);

/* Reads what is there, up to `size`, for up to 30 s or until `wanted` bytes have come. */
size_t read_bytes(int descriptor, uint8_t *bytes, size_t size, size_t wanted);

record_sink *open_sink(const char *kind, const char *path);
void send_text(record_sink *sink, const char *text, unsigned records);
void assert_no_news(record_sink *sink);
void assert_news(record_sink *sink, const char *part);

#endif
