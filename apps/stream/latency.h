/* How long frames take from their capture to their last byte, over the last second. */
#ifndef STREAM_LATENCY_H
#define STREAM_LATENCY_H

#include <stddef.h>
#include <stdint.h>

/* More frames than that within a second leave the figures to the first of them. */
enum { LATENCY_SAMPLES = 2000 };

/* All zero at first. */
typedef struct latency {
    int64_t samples_ns[LATENCY_SAMPLES];
    size_t count;
} latency;

void latency_add(latency *times, int64_t sample_ns);

/* So many percent of the samples are at most that long; 0 without any. Sorts them. */
int64_t latency_percentile_ns(latency *times, unsigned percent);

void latency_clear(latency *times);

#endif
