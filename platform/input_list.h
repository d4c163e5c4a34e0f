/* The inputs named by a user, with directories replaced by what is in them, and a name for each to appear in
 * reports. */
#ifndef PLATFORM_INPUT_LIST_H
#define PLATFORM_INPUT_LIST_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct input_file {
    char *path;        /* "-" is standard input */
    const char *name;  /* the path's last component; the whole path where several inputs share that component;
                          "stdin" for standard input */
    bool name_shared;
    bool raw;          /* a headerless capture */
} input_file;

typedef struct input_list {
    input_file *files;
    size_t count;
    size_t capacity;
} input_list;

/* Adds a path as it is. False only when memory runs out. */
bool input_list_add(input_list *list, const char *path, bool raw, error_text *error);

/* Adds the pictures and videos that lie in a directory, by the endings of their names and in the order of these
 * (byte by byte); hidden files and subdirectories do not count. With `raw_format`, the name of a pixel format,
 * names that end in .raw, .bin, .yuv or that format are added as headerless captures; else it is NULL.
 * `skipped_count` tells how many other files there are. False when the directory cannot be read or holds nothing
 * to decode. */
bool input_list_add_directory(input_list *list, const char *path, const char *raw_format, size_t *skipped_count,
                              error_text *error);

bool input_is_directory(const char *path);

/* Sets the names, when all inputs are there. */
void input_list_set_names(input_list *list);

void input_list_release(input_list *list);

#endif
