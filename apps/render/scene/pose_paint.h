/* Everything that is seen from one pose of the camera. */
#ifndef SCENE_POSE_PAINT_H
#define SCENE_POSE_PAINT_H

#include "canvas.h"
#include "prints.h"

/* False when memory runs out. */
bool paint_pose(const scene *view, prints *all, canvas *picture);

#endif
