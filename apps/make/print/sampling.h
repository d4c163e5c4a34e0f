/* A piece of tape in pixels, each as dark as the share of it that ink covers. */
#ifndef PRINT_SAMPLING_H
#define PRINT_SAMPLING_H

#include "strip.h"

/* Ink and quiet zone of a piece, from the top left corner of `pixels` on; what lies beyond stays as it is. Exact, and
 * without a gray pixel where module_px is whole. False when memory runs out. */
bool sample_piece(const tape_piece *piece, const tape_columns *drawn, double module_px, uint8_t *pixels,
                  size_t width_px, size_t height_px);

#endif
