#include "heap.h"

#include "sanitized.h"

#include <errno.h>
#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>

#if defined(__GLIBC__) && !BENCH_SANITIZED

/* glibc keeps its allocator under these names too, so that a program may put its own in front. */
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *block);

static bool counting;
static int64_t in_use_bytes;
static int64_t peak_bytes;

static void *counted(void *block)
{
    if (counting && block != NULL) {
        int64_t in_use = __atomic_add_fetch(&in_use_bytes, (int64_t)malloc_usable_size(block), __ATOMIC_RELAXED);
        if (in_use > peak_bytes)
            peak_bytes = in_use;
    }
    return block;
}

static void uncounted(void *block)
{
    if (counting && block != NULL)
        __atomic_sub_fetch(&in_use_bytes, (int64_t)malloc_usable_size(block), __ATOMIC_RELAXED);
}

void *malloc(size_t size)
{
    return counted(__libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
    return counted(__libc_calloc(count, size));
}

void *realloc(void *block, size_t size)
{
    uncounted(block);
    return counted(__libc_realloc(block, size));
}

void *memalign(size_t alignment, size_t size)
{
    return counted(__libc_memalign(alignment, size));
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return counted(__libc_memalign(alignment, size));
}

int posix_memalign(void **block, size_t alignment, size_t size)
{
    void *fresh = counted(__libc_memalign(alignment, size));
    if (fresh == NULL)
        return ENOMEM;
    *block = fresh;
    return 0;
}

void free(void *block)
{
    uncounted(block);
    __libc_free(block);
}

void heap_count_start(void)
{
    in_use_bytes = 0;
    peak_bytes = 0;
    counting = true;
}

size_t heap_count_stop(void)
{
    counting = false;
    return (size_t)peak_bytes;
}

/* Tools such as valgrind's may have put theirs in front of these. */
bool heap_is_counted(void)
{
    heap_count_start();
    char *volatile block = malloc(1000);
    free(block);
    return heap_count_stop() >= 1000;
}

#else

void heap_count_start(void)
{
}

size_t heap_count_stop(void)
{
    return 0;
}

bool heap_is_counted(void)
{
    return false;
}

#endif
