/* What falls on the scene, and what the lens lets through to the edges of the image. */
#ifndef SCENE_LIGHT_H
#define SCENE_LIGHT_H

#include "canvas.h"
#include "scene.h"

void apply_light(const scene_light *light, canvas *picture);

#endif
