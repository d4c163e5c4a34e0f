/* The truth about a video as JSON: an array with an object a frame. */
#ifndef SCENE_TRUTH_JSON_H
#define SCENE_TRUTH_JSON_H

#include <stdio.h>

#include "scene.h"

void truth_json_begin(FILE *file);
void truth_json_frame(FILE *file, int frame, const scene *view, const scene_truth *truth);
void truth_json_end(FILE *file);

#endif
