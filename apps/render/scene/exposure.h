/* The light that falls on the sensor while it is exposed, from one pose of the camera or from many. */
#ifndef SCENE_EXPOSURE_H
#define SCENE_EXPOSURE_H

#include "canvas.h"
#include "scene.h"

/* Background, panels, tapes and pictures. False when memory runs out. */
bool paint_exposure(const scene *view, canvas *picture);

/* The camera's pose some exposures after the middle of the exposure of the middle row. */
scene_camera camera_after(const scene *view, double exposures);

/* How long after that the middle of the exposure of a row is. */
double row_delay_exposures(const scene *view, double y_px);

#endif
