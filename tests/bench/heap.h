/* Peak heap use of a stretch of code, shared libraries included. */
#ifndef BENCH_HEAP_H
#define BENCH_HEAP_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* False where allocations cannot be seen: another C library than glibc, or a sanitizer in their place. */
bool heap_is_counted(void);

/* Counts from zero. */
void heap_count_start(void);

/* Most bytes that were in use at once since the start, as the allocator rounds them. */
size_t heap_count_stop(void);

#ifdef __cplusplus
}
#endif

#endif
