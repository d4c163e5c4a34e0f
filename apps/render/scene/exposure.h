/* The light that falls on the sensor while it is exposed, from one pose of the camera or from several. */
#ifndef SCENE_EXPOSURE_H
#define SCENE_EXPOSURE_H

#include "canvas.h"
#include "scene.h"

/* Background, panels, tapes and pictures. False when memory runs out. */
bool paint_exposure(const scene *view, canvas *picture);

#endif
