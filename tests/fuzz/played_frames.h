/* Frames out of a file or pipe with any content, to the end, and as gray. */
#ifndef PLAYED_FRAMES_H
#define PLAYED_FRAMES_H

#include "content_file.h"
#include "frame_source.h"

/* Claims what frame_source.h and gray.h promise: pixels as the layout tells, all of them there; an error that says
 * something. `raw` is the layout of headerless frames, or NULL. */
void play_frames(const content_file *file, const frame_layout *raw);

/* As a file, and as a pipe. */
void play_bytes(const uint8_t *bytes, size_t size, const frame_layout *raw);

#endif
