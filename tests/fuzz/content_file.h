/* Bytes as files, for what is read by path. */
#ifndef CONTENT_FILE_H
#define CONTENT_FILE_H

#include "fuzz_target.h"

typedef struct content_file {
    int descriptor;
    char path[32];
} content_file;

/* A file in memory without a name of its own. */
content_file content_file_open(const uint8_t *bytes, size_t size);

/* A pipe, whose length nobody can tell, with as many of the bytes as go into one. */
content_file content_pipe_open(const uint8_t *bytes, size_t size);

void content_file_close(const content_file *file);

/* A file of this name in a directory of this process, which goes away with it. `path` has room for
 * CONTENT_PATH_BYTES. */
enum { CONTENT_PATH_BYTES = 300 };
void named_file_path(const char *name, char *path);
void named_file_write(const char *name, const uint8_t *bytes, size_t size);

#endif
