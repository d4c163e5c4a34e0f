/* A line that is on around an exposure to come, from a thread of its own: while a frame is decoded, the next one is
 * exposed. */
#ifndef STREAM_STROBE_H
#define STREAM_STROBE_H

#include "gpio_lines.h"

typedef struct strobe strobe;

/* Takes the line, also on failure; NULL then. */
strobe *strobe_open(gpio_output *line, error_text *error);

/* Both on CLOCK_MONOTONIC. A plan replaces one that has not begun. */
void strobe_plan(strobe *self, int64_t on_ns, int64_t off_ns);

/* True once, when the line has failed. */
bool strobe_news(strobe *self, error_text *message);

/* NULL is fine. */
void strobe_close(strobe *self);

#endif
