/* From light to samples. */
#ifndef SCENE_SENSOR_H
#define SCENE_SENSOR_H

#include "canvas.h"
#include "scene.h"

/* Exposes, adds noise and gives samples of `bits` bits. False when memory runs out. The picture is used up. */
bool apply_sensor(const scene_sensor *sensor, uint64_t seed, unsigned bits, canvas *picture, uint16_t *samples);

/* From a shade to linear light and back, both 0 to 255. */
double light_of_shade(double shade, double gamma);
double shade_of_light(double light, double gamma);

#endif
