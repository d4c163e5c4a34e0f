/* Paints a tape into a picture, each pixel the mean over its area. */
#ifndef SCENE_TAPE_PAINT_H
#define SCENE_TAPE_PAINT_H

#include "canvas.h"
#include "scene.h"

/* `light` and `dark` are in the picture's linear light. False when memory runs out. */
bool paint_tape(const scene *view, const scene_tape *tape, float light, float dark, canvas *picture);

#endif
