/* What light, lens and sensor do to a picture. */
#ifndef SCENE_DEGRADE_H
#define SCENE_DEGRADE_H

#include "canvas.h"
#include "scene.h"

void apply_light(const scene_light *light, canvas *picture);

/* False when memory runs out. */
bool apply_optics(const scene_optics *optics, canvas *picture);

/* Adds noise and gives samples of `bits` bits. */
void apply_sensor(const scene_sensor *sensor, uint64_t seed, unsigned bits, const canvas *picture,
                  uint16_t *samples);

/* From a shade to linear light and back, both 0 to 255. */
double light_of_shade(double shade, double gamma);
double shade_of_light(double light, double gamma);

#endif
