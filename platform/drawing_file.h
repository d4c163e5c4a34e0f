/* An output file that cairo writes into, with the reason when that fails. */
#ifndef PLATFORM_DRAWING_FILE_H
#define PLATFORM_DRAWING_FILE_H

#include "output_file.h"

#include <stddef.h>

typedef struct drawing_file {
    output_file *output;
    char path[300];    /* for messages */
    int error_number;  /* of the first write that failed; 0 while all went well */
} drawing_file;

bool drawing_file_open(drawing_file *file, const char *path, error_text *error);

/* After a failure nothing more is written. */
bool drawing_file_write(drawing_file *file, const void *bytes, size_t size);

/* Gives a whole file its name; one that could not be written is an error and leaves nothing behind. */
bool drawing_file_publish(drawing_file *file, error_text *error);

void drawing_file_discard(drawing_file *file);

#endif
