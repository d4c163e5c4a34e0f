/* Surfaces of rooms and warehouses, painted by the seed. */
#ifndef CLUTTER_SURFACES_H
#define CLUTTER_SURFACES_H

#include "sheet.h"

/* Fills the full size of a sheet. */
typedef void surface_painter(uint64_t seed, sheet *painted);

/* Noise of one to many texels, faint or strong, or two shades of it: gravel, plaster, a popcorn ceiling. */
surface_painter paint_noise_surface;

/* Tiles and bricks with joints, each of its own shade. */
surface_painter paint_tiles;

/* Boards with grain. */
surface_painter paint_boards;

/* Shelves of books, boxes and folders, with labels on them. */
surface_painter paint_shelves;

/* Rings around centres, many of them 1:1:3:1:1. */
surface_painter paint_bullseyes;

#endif
