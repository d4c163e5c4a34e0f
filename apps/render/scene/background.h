/* What is behind the tapes. */
#ifndef SCENE_BACKGROUND_H
#define SCENE_BACKGROUND_H

#include "canvas.h"
#include "scene.h"

/* Fills the picture with shades, unless it is a room. False when memory runs out. */
bool paint_background(const scene *view, canvas *picture);

/* Fills some rows with shades, from the first to before the last. */
void paint_room(const scene *view, int32_t top, int32_t bottom, canvas *picture);

#endif
