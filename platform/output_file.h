/*
 * A file that comes into being only when it is whole: it is written under another name in the same directory and
 * renamed at the end. Until then a file of that name stays as it was. What is no regular file, such as a pipe, a
 * device or "-" for standard output, is written at once.
 */
#ifndef PLATFORM_OUTPUT_FILE_H
#define PLATFORM_OUTPUT_FILE_H

#include "error_text.h"

#include <stdbool.h>
#include <stdio.h>

typedef struct output_file output_file;

/* NULL, with the reason but not the path, on failure. SIGINT, SIGTERM and SIGHUP remove what is not finished. */
output_file *output_file_open(const char *path, error_text *error);

/* To be written to, not to be closed. */
FILE *output_file_stream(output_file *file);

/* Writes out and closes what is written so far; nothing can be added. False when not all of it could be written. */
bool output_file_complete(output_file *file, error_text *error);

/* Completes the file and gives it its name, or else removes it; releases `file` in both cases. */
bool output_file_publish(output_file *file, error_text *error);

/* Removes and releases; NULL is fine. */
void output_file_discard(output_file *file);

#endif
