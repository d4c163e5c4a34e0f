/* Paints a marker picture, each pixel the exact mean over its area. */
#ifndef SCENE_PICTURE_PAINT_H
#define SCENE_PICTURE_PAINT_H

#include "canvas.h"
#include "prints.h"
#include "world.h"

/* Where nothing is in front of it; where it meets tapes or other pictures, pixels are only marked as mixed. False
 * when memory runs out. */
bool paint_picture(world *seen, size_t thing_index, const picture_print *print, canvas *picture);

/* Mean light of the part of a pixel that shows it. */
float picture_light_at(const world *seen, size_t thing_index, const picture_print *print, int32_t x, int32_t y);

#endif
