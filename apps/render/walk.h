/* A cart's camera passes tapes on a baseboard: obliquely at first, then nearly head on. */
#ifndef RENDER_WALK_H
#define RENDER_WALK_H

#include "scene.h"

enum { WALK_TAPES = 3 };

/* Its scene points to its tapes: do not copy it. */
typedef struct walk {
    scene view;
    scene_tape tapes[WALK_TAPES];
    uint64_t seed;
} walk;

/* Takes image size, optics, sensor, light and seed from `like`. */
void walk_begin(walk *way, const scene *like);

/* Sets the scene for a frame of the walk, 0 to frame_count - 1. */
void walk_to(walk *way, int frame, int frame_count);

#endif
