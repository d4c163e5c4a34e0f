/* The two files of a recording, for recording.c's thread: the disk may take its time here. Not for others. */
#ifndef PLATFORM_RECORDING_FILES_H
#define PLATFORM_RECORDING_FILES_H

#include "camera.h"

#include <stdatomic.h>

typedef struct recording_files recording_files;

/* As recording_open(). A pipe without a reader is refused. Another thread sets *given_up when a pipe's reader is not
 * to be waited for any more. */
recording_files *recording_files_open(const char *path, double rate_hz, const atomic_bool *given_up,
                                      error_text *error);

/* False, with an error, when the frame could not be written whole; what was written of it is cut off. All frames have
 * the layout of the first. */
bool recording_files_add(recording_files *files, const camera_frame *input, error_text *error);

/* False, with an error, when what was written did not reach the disk. */
bool recording_files_close(recording_files *files, error_text *error);

#endif
