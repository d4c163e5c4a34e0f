/*
 * What fuzz targets share. A target is one function that takes any bytes; libFuzzer calls it with those that it makes
 * up (preset fuzz), and replay.c with those of files, in all other builds.
 *
 * A target fails by ending the process: through a sanitizer, a signal, a limit on memory, or CLAIM().
 */
#ifndef FUZZ_TARGET_H
#define FUZZ_TARGET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* The names are libFuzzer's. The second one is optional: it changes `size` bytes into others, `size_max` at most, for
 * inputs of which next to nothing is left when any byte is changed. */
int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t size_max, unsigned seed);

/* libFuzzer's own changes, for the second one. */
size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t size_max);

static inline void claim(bool holds, const char *what, const char *file, int line)
{
    if (holds)
        return;
    fprintf(stderr, "%s:%d: does not hold: %s\n", file, line, what);
    abort();
}

/* What has to be so, whatever the bytes. */
#define CLAIM(condition) claim(condition, #condition, __FILE__, __LINE__)

/* Memory of exactly this size, so that what is read or written beyond it is noticed. One byte where it is 0. */
static inline void *exact_memory(size_t size)
{
    void *memory = malloc(size > 0 ? size : 1);
    if (memory == NULL)
        abort();
    return memory;
}

#endif
