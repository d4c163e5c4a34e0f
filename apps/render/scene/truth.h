/* What a scene's picture shows, and where. */
#ifndef SCENE_TRUTH_H
#define SCENE_TRUTH_H

#include "scene.h"

/* False when memory runs out. */
bool find_truth(const scene *view, scene_truth *truth);

#endif
