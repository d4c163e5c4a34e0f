/*
 * Where frames go: one file for all, or, in formats that hold a single picture, a numbered file each. Nothing is seen
 * under its name before all is written.
 */
#ifndef RENDER_FRAME_OUTPUT_H
#define RENDER_FRAME_OUTPUT_H

#include "capture.h"
#include "error_text.h"

#include <stddef.h>

typedef struct frame_output frame_output;

typedef struct frame_output_plan {
    const char *path;  /* "-": standard output */
    const capture_format *format;
    int32_t width_px, height_px;
    size_t stride_bytes;
    size_t frame_count;
    double fps;
} frame_output_plan;

/* NULL, with the path, on failure. */
frame_output *frame_output_open(const frame_output_plan *wanted, error_text *error);

/* Writes the next frame. */
bool frame_output_add(frame_output *output, const uint16_t *samples, error_text *error);

/* Ends the writing. What is written has its name only after frame_output_publish(). */
bool frame_output_complete(frame_output *output, error_text *error);

bool frame_output_publish(frame_output *output, error_text *error);

/* Removes what has no name yet; NULL is fine. */
void frame_output_close(frame_output *output);

#endif
