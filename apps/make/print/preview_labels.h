/* Text beside the lines of a preview, each only where it covers nothing else. */
#ifndef PRINT_PREVIEW_LABELS_H
#define PRINT_PREVIEW_LABELS_H

#include "drawing.h"

/* Which parts of a page are taken, in cells. */
typedef struct taken_area {
    uint8_t *cells;
    size_t columns, rows;
} taken_area;

/* False when memory runs out. The caller frees the cells. */
bool taken_area_init(taken_area *taken, double width_mm, double height_mm);

/* A line as the axis that things beside it are placed along: u_mm from its start in its direction, v_mm to its right
 * as the plan shows it. */
typedef struct line_axis {
    drawing_point start;
    double along_x, along_y;  /* of length 1 */
    double length_mm;
    double module_mm;         /* as the preview shows it */
} line_axis;

drawing_point axis_point(const line_axis *axis, double u_mm, double v_mm);

/* Of a line, from the smaller u and v to the larger ones. */
typedef struct axis_box {
    double u_begin_mm, u_end_mm, v_begin_mm, v_end_mm;
} axis_box;

void add_axis_box(drawing *page, const line_axis *axis, const axis_box *box);
void take_box(taken_area *taken, const line_axis *axis, const axis_box *box);
bool box_is_free(const taken_area *taken, const line_axis *axis, const axis_box *box);

#define LABEL_HEIGHT 0.78  /* of capitals and figures, in sizes of the font, with a little white */

/* Writes along the line where it is free, and takes the place; as seen upright when turned by less than half a turn.
 * `u_mm` is the middle. Returns whether it did. */
bool label_along(drawing *page, taken_area *taken, const line_axis *axis, const char *text, double u_mm,
                 double v_mm, const drawing_font *font);

#endif
