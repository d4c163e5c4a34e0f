/* Paints a tape into a picture, each pixel the mean over its area. */
#ifndef SCENE_TAPE_PAINT_H
#define SCENE_TAPE_PAINT_H

#include "canvas.h"
#include "prints.h"
#include "world.h"

/* Where nothing is in front of it; where it meets other tapes or pictures, pixels are only marked as mixed. False
 * when memory runs out. */
bool paint_tape(world *seen, size_t thing_index, const tape_print *print, canvas *picture);

/* Its light at a point that is on it. */
float tape_light_at(const thing *tape, const tape_print *print, double x_px, double y_px);

#endif
