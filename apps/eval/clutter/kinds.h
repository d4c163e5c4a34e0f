/* The kinds of clutter: painted ones, and those whose sheets lie in a directory. */
#ifndef CLUTTER_KINDS_H
#define CLUTTER_KINDS_H

#include <stddef.h>

#include "input_list.h"
#include "patterns.h"
#include "surfaces.h"

enum { KINDS_MAX = 64, KIND_NAME_MAX = 31 };

/* Exactly one of `paint`, `pattern` and a count of files is there. */
typedef struct clutter_kind {
    char name[KIND_NAME_MAX + 1];
    surface_painter *paint;
    module_pattern *pattern;
    size_t first_file, file_count;  /* in the list */
} clutter_kind;

typedef struct clutter_kinds {
    clutter_kind list[KINDS_MAX];
    size_t count;
    input_list files;
} clutter_kinds;

/* Zeroed before. */
void kinds_add_painted(clutter_kinds *kinds);

/* Adds a kind for all pictures in a directory whose names are the same up to the last hyphen. */
bool kinds_add_directory(clutter_kinds *kinds, const char *path, error_text *error);

void kinds_release(clutter_kinds *kinds);

/* Makes the sheet of a kind with a seed; `number` tells which one it is, from 0. */
bool kind_paint(const clutter_kinds *kinds, const clutter_kind *kind, uint64_t seed, size_t number, sheet *painted,
                error_text *error);

#endif
