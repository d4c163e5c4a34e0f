/* What is behind the tapes. */
#ifndef SCENE_BACKGROUND_H
#define SCENE_BACKGROUND_H

#include "canvas.h"
#include "scene.h"

/* Fills the picture with shades. False when memory runs out. */
bool paint_background(const scene *view, canvas *picture);

#endif
