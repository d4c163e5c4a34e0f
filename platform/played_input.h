/* A recording or picture that camera_file.c plays: its frames, and the times beside it where there are some. */
#ifndef PLATFORM_PLAYED_INPUT_H
#define PLATFORM_PLAYED_INPUT_H

#include "frame_source.h"
#include "recording.h"

/* Zeroed while closed. */
typedef struct played_input {
    frame_source *source;    /* NULL: closed */
    recording_times *times;  /* NULL where there are none */
    int lock;                /* so that nobody records over it */
} played_input;

/* `headless` is the layout of frames that come without a head, or NULL. */
bool played_input_open(played_input *input, const char *path, const frame_layout *headless, error_text *error);

/* `number` is that of the frame where no times tell another. */
frame_status played_input_next(played_input *input, uint64_t number, frame *image, recorded_frame *recorded,
                               error_text *error);

void played_input_close(played_input *input);

#endif
