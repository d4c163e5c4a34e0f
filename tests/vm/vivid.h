/* The kernel's virtual camera, vivid: what is written to its output node comes back on its capture node. */
#ifndef VM_VIVID_H
#define VM_VIVID_H

#include "error_text.h"
#include "frame.h"

#include <linux/videodev2.h>

/* Connects output with capture at this size: 640 x 480 or 1280 x 720. */
bool vivid_connect(const char *capture, const char *output, int32_t width_px, int32_t height_px, error_text *error);

enum { VIVID_BUFFERS = 4 };

typedef struct vivid_output {
    int descriptor;
    frame_layout layout;
    uint8_t *buffers[VIVID_BUFFERS];
} vivid_output;

bool vivid_output_open(vivid_output *output, const char *path, pixel_format format, int32_t width_px,
                       int32_t height_px, error_text *error);

/* Writes pictures 0, 1, 2, … for ever; returns on an error. */
void vivid_output_run(vivid_output *output, error_text *error);

#endif
