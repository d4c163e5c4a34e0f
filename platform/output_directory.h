/*
 * A set of files that come into being together: they are written into a hidden directory beside their place and moved
 * there when all are done. Until then, and after any failure or interruption, files of earlier runs stand as they
 * were and nothing else is left behind.
 */
#ifndef PLATFORM_OUTPUT_DIRECTORY_H
#define PLATFORM_OUTPUT_DIRECTORY_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct output_directory output_directory;

/* Makes the hidden directory, and sees to it that SIGINT, SIGTERM and SIGHUP remove it before they end the process:
 * call it before other threads are started, and once at a time. `path` may be a directory that exists or one to be
 * made in one that does. NULL, with the reason but not the path, on failure. */
output_directory *output_directory_open(const char *path, error_text *error);

/* Where files are to be written for now. */
const char *output_directory_path(const output_directory *directory);

/* Moves all files into place, over those of the same names, or none of them; releases `directory` in both cases.
 * Only files are moved, no directories. */
bool output_directory_publish(output_directory *directory, error_text *error);

/* Removes what was written; NULL is fine. */
void output_directory_discard(output_directory *directory);

/* Names files in a message by where they would have been moved to. */
void output_directory_rename_in_error(const output_directory *directory, error_text *error);

#endif
