/* What the tests of this folder share: cmocka, and files that live as long as a test needs them. */
#ifndef TEST_MAIN_H
#define TEST_MAIN_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "frame_source.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* A file of this process with this content; the next call with the same ending replaces it. */
static inline const char *temporary_file(const char *ending, const void *bytes, size_t size)
{
    static char path[256];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/tapemark-test-%ld%s", folder != NULL ? folder : "/tmp", (long)getpid(), ending);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* Opens content as a file and forgets the file's name at once. */
static inline frame_source *open_content(const void *bytes, size_t size, const frame_layout *raw, error_text *error)
{
    const char *path = temporary_file("", bytes, size);
    error->text[0] = '\0';
    frame_source *source = frame_source_open_file(path, raw, error);
    unlink(path);
    return source;
}

/* The same through a pipe, whose size nobody can tell; not more than fits into one. */
static inline frame_source *open_piped_content(const void *bytes, size_t size, const frame_layout *raw,
                                               error_text *error)
{
    int ends[2];
    char path[64];
    assert_int_equal(pipe(ends), 0);
    assert_int_equal(write(ends[1], bytes, size), size);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[0]);
    close(ends[1]);
    error->text[0] = '\0';
    frame_source *source = frame_source_open_file(path, raw, error);
    close(ends[0]);
    return source;
}

#endif
