/* A camera before a sheet: from anywhere, in any light, sharp or not, by the seed. */
#ifndef CLUTTER_VIEW_H
#define CLUTTER_VIEW_H

#include "scene.h"
#include "sheet.h"

/* What a camera sees of an endless plane of sheets; light, optics and sensor are those of a scene. */
typedef struct sheet_view {
    scene look;             /* size, seed, light, optics and sensor */
    double px_per_texel;    /* at the picture's middle, if it were seen head on */
    double yaw_deg, pitch_deg, roll_deg;
    double at_x, at_y;      /* texel in the picture's middle */
    double paper, ink, sky; /* shades */
} sheet_view;

sheet_view view_at_random(uint64_t seed, int32_t width_px, int32_t height_px);

/* Renders width x height bytes without gaps between rows. False when memory runs out. */
bool view_render(const sheet_view *view, const sheet *seen, uint8_t *pixels);

#endif
