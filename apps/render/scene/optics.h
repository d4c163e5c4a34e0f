/* What the lens does to a picture, and a straight motion. */
#ifndef SCENE_OPTICS_H
#define SCENE_OPTICS_H

#include "canvas.h"
#include "scene.h"

enum { DISC_MAX_PX = 32, MOTION_MAX_PX = 128 };

/* False when memory runs out. */
bool apply_optics(const scene_optics *optics, canvas *picture);

#endif
