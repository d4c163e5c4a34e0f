/* Paints what the panels in front look like. */
#ifndef SCENE_PANEL_PAINT_H
#define SCENE_PANEL_PAINT_H

#include "canvas.h"
#include "prints.h"
#include "world.h"

/* Where a pixel falls on a panel, at a place of it that is before the camera. */
patch patch_at(const thing *part, double x_px, double y_px);

/* All pixels that a panel is in front of at their centre, then the shadows on them. */
void paint_panels(const world *seen, const prints *all, canvas *picture);

#endif
