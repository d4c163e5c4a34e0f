/* A frame saved as a picture (PGM), under the time of its capture. */
#ifndef STREAM_SNAPSHOT_H
#define STREAM_SNAPSHOT_H

#include "gray.h"

/* DIRECTORY/frame-SECONDS.MILLISECONDS.pgm, of the clock on the wall. `path` gets the name. */
bool snapshot_save(const char *directory, const gray_view *view, char *path, size_t path_size, error_text *error);

#endif
