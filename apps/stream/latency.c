#include "latency.h"

#include <stdlib.h>

void latency_add(latency *times, int64_t sample_ns)
{
    if (times->count < LATENCY_SAMPLES)
        times->samples_ns[times->count++] = sample_ns;
}

static int compare(const void *left, const void *right)
{
    const int64_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

int64_t latency_percentile_ns(latency *times, unsigned percent)
{
    if (times->count == 0)
        return 0;
    qsort(times->samples_ns, times->count, sizeof *times->samples_ns, compare);
    size_t rank = (times->count * percent + 99) / 100;
    return times->samples_ns[rank > 0 ? rank - 1 : 0];
}

void latency_clear(latency *times)
{
    times->count = 0;
}
