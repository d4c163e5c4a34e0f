/* Things in front of the tapes. */
#ifndef SCENE_COVER_H
#define SCENE_COVER_H

#include "canvas.h"
#include "scene.h"

bool covered_at(const scene *view, double x_px, double y_px);

void paint_covers(const scene *view, canvas *picture);

#endif
