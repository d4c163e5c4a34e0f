/* Everything that is seen from one pose of the camera. */
#ifndef SCENE_POSE_PAINT_H
#define SCENE_POSE_PAINT_H

#include "canvas.h"
#include "prints.h"
#include "world.h"

/* A background that is the same from all poses; false when memory runs out. */
bool paint_backdrop(const scene *view, canvas *behind);

/* Some rows of the picture, before this background. False when memory runs out. */
bool paint_pose(const scene *view, prints *all, pixel_rows rows, canvas *behind, canvas *picture);

#endif
