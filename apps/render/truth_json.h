/* The truth about a frame as JSON: one line, see README.md. */
#ifndef RENDER_TRUTH_JSON_H
#define RENDER_TRUTH_JSON_H

#include <stdio.h>

#include "scene.h"

/* `picture_count`: pictures behind these are covers, and are left out. */
void truth_json_frame(FILE *file, size_t frame, double time_s, const scene *view, size_t picture_count,
                      const scene_truth *truth);

#endif
