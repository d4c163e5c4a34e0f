/* A line that is on around an exposure to come, from a thread of its own: while a frame is decoded, the next one is
 * exposed. */
#ifndef STREAM_STROBE_H
#define STREAM_STROBE_H

#include "gpio_lines.h"

typedef struct strobe strobe;

/* Takes the line, also on failure; NULL then. */
strobe *strobe_open(gpio_output *line, error_text *error);

/* When to go on and off, on CLOCK_MONOTONIC; and again after each period, a few times, so that frames are lit as well
 * that follow one that nobody was given. A plan corrects the one before, and leaves out none of its flashes. */
typedef struct strobe_times {
    int64_t on_ns, off_ns;
    int64_t period_ns;
} strobe_times;

void strobe_plan(strobe *self, const strobe_times *times);

/* True once, when the line has failed. */
bool strobe_news(strobe *self, error_text *message);

/* NULL is fine. */
void strobe_close(strobe *self);

#endif
