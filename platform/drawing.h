/*
 * Drawing with cairo, in millimetres: PDF, SVG and pixels. x goes to the right, y down, from the top left corner of
 * a page. What fails while something is drawn (memory, a full disk) is kept and told by drawing_close().
 */
#ifndef PLATFORM_DRAWING_H
#define PLATFORM_DRAWING_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct drawing drawing;

typedef struct drawing_point {
    double x_mm, y_mm;
} drawing_point;

/* Each from 0 to 1. */
typedef struct drawing_colour {
    double red, green, blue, opacity;
} drawing_colour;

typedef enum drawing_anchor { DRAWING_LEFT, DRAWING_MIDDLE, DRAWING_RIGHT } drawing_anchor;

typedef struct drawing_font {
    double size_mm;         /* of the em; capitals are 0.73 of it high */
    bool bold;
    drawing_anchor anchor;  /* which end of the text's baseline the given point is */
    double angle_deg;       /* clockwise */
} drawing_font;

/* The longest side of a page of a PDF, and of a picture. */
#define DRAWING_PDF_SIDE_MAX_MM (14400.0 / 72.0 * 25.4)
enum { DRAWING_SIDE_MAX_PX = 32767 };

/* ---- Opening and closing ------------------------------------------------------------------------------- */

/* The same calls make the same bytes: no date is written. NULL on failure. */
drawing *drawing_open_pdf(const char *path, const char *title, error_text *error);

/* One page. NULL on failure. */
drawing *drawing_open_svg(const char *path, double width_mm, double height_mm, error_text *error);

typedef enum drawing_pixels {
    DRAWING_COLOUR,
    DRAWING_GRAY  /* of colours, the green counts; what is lighter does not cover what is darker */
} drawing_pixels;

/* White pixels in memory; both sides are 1 to DRAWING_SIDE_MAX_PX. NULL on failure. */
drawing *drawing_open_pixels(drawing_pixels kind, int32_t width_px, int32_t height_px, double px_per_mm,
                             error_text *error);

/* Each page of a PDF begins so. The lengths that follow are multiplied by scale_x and scale_y, and start at
 * `origin`, which is not scaled. */
void drawing_begin_page(drawing *page, double width_mm, double height_mm, drawing_point origin, double scale_x,
                        double scale_y);
void drawing_end_page(drawing *page);

/* A whole file, or an error and no file. NULL is fine, and an error that was told before. */
bool drawing_close(drawing *page, error_text *error);

/* Gives up: no file is left behind. NULL is fine. */
void drawing_discard(drawing *page);

/* Pixels as they are drawn so far, as PNG; `dpi` is noted in the file. */
bool drawing_write_png(drawing *page, const char *path, double dpi, error_text *error);

/* One gray byte a pixel of DRAWING_GRAY, rows without gaps. */
void drawing_copy_gray(drawing *page, uint8_t *pixels);

/* A gray picture as PNG, without drawing. Both sides are 1 to DRAWING_SIDE_MAX_PX. */
bool drawing_write_gray_png(const uint8_t *pixels, int32_t width_px, int32_t height_px, const char *path, double dpi,
                            error_text *error);

/* ---- Shapes -------------------------------------------------------------------------------------------- */

/* Black at first, and at the beginning of a page. */
void drawing_set_colour(drawing *page, drawing_colour colour);

/* Shapes are added to one path, which the next fill or stroke uses up. Filled at once, neighbours leave no seam. */
void drawing_add_rectangle(drawing *page, drawing_point from, drawing_point to);
void drawing_add_polygon(drawing *page, const drawing_point *corners, size_t count);
void drawing_add_line(drawing *page, drawing_point from, drawing_point to);
void drawing_fill(drawing *page);

/* dash_mm: of dashes and the gaps between them; 0 for a line without. */
void drawing_stroke(drawing *page, double width_mm, double dash_mm);

void drawing_text(drawing *page, const char *text, drawing_point at, const drawing_font *font);
double drawing_text_width_mm(drawing *page, const char *text, const drawing_font *font);

/* A gray picture, as large as the rectangle between two corners. */
void drawing_picture(drawing *page, const uint8_t *pixels, int32_t width_px, int32_t height_px,
                     ptrdiff_t stride_bytes, drawing_point from, drawing_point to, double opacity);

#endif
