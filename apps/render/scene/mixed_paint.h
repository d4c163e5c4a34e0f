/* Pixels in which several things meet: at their edges. */
#ifndef SCENE_MIXED_PAINT_H
#define SCENE_MIXED_PAINT_H

#include "canvas.h"
#include "prints.h"
#include "world.h"

/* Paints all pixels marked as mixed, point by point of each; `behind` is what is seen where there is nothing. False
 * when memory runs out. */
bool paint_mixed(const world *seen, prints *all, const canvas *behind, canvas *picture);

#endif
