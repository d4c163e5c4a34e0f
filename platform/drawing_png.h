/* Pixels as PNG, with their size on paper. */
#ifndef PLATFORM_DRAWING_PNG_H
#define PLATFORM_DRAWING_PNG_H

#include "error_text.h"

#include <cairo.h>
#include <stdbool.h>

bool drawing_png_write(cairo_surface_t *surface, const char *path, double dpi, error_text *error);

#endif
