/* One line on standard error that is written over and over, where a person watches and the work takes long. */
#ifndef DECODE_PROGRESS_H
#define DECODE_PROGRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct progress {
    bool wanted;  /* standard error is a terminal, and standard output, whose lines would get mixed up, is not */
    bool shown;
    int64_t next_us;
} progress;

/* Microseconds of a clock that never jumps. */
int64_t monotonic_us(void);

void progress_init(progress *line);

/* Shows how far a run has come: frames of one input, `expected` in all or 0 while that is not known, and which
 * input of how many this is. Does nothing most of the times. */
void progress_update(progress *line, const char *source, uint64_t frames, uint64_t expected, size_t input,
                     size_t input_count);

/* Wipes the line, so that something else can be printed. */
void progress_clear(progress *line);

#endif
