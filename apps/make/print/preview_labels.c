#include "preview_labels.h"

#include <math.h>
#include <stdlib.h>

static const double CELL_MM = 0.4;

bool taken_area_init(taken_area *taken, double width_mm, double height_mm)
{
    taken->columns = (size_t)(width_mm / CELL_MM) + 1;
    taken->rows = (size_t)(height_mm / CELL_MM) + 1;
    taken->cells = calloc(taken->columns, taken->rows);
    return taken->cells != NULL;
}

drawing_point axis_point(const line_axis *axis, double u_mm, double v_mm)
{
    return (drawing_point){axis->start.x_mm + u_mm * axis->along_x - v_mm * axis->along_y,
                           axis->start.y_mm + u_mm * axis->along_y + v_mm * axis->along_x};
}

void add_axis_box(drawing *page, const line_axis *axis, const axis_box *box)
{
    const drawing_point corners[4] = {axis_point(axis, box->u_begin_mm, box->v_begin_mm),
                                      axis_point(axis, box->u_end_mm, box->v_begin_mm),
                                      axis_point(axis, box->u_end_mm, box->v_end_mm),
                                      axis_point(axis, box->u_begin_mm, box->v_end_mm)};
    drawing_add_polygon(page, corners, 4);
}

/* NULL outside of the page. */
static uint8_t *cell_at(const taken_area *taken, drawing_point point)
{
    double column = floor(point.x_mm / CELL_MM), row = floor(point.y_mm / CELL_MM);
    if (!(column >= 0 && row >= 0 && column < (double)taken->columns && row < (double)taken->rows))
        return NULL;
    return &taken->cells[(size_t)row * taken->columns + (size_t)column];
}

static size_t steps_along(double begin_mm, double end_mm)
{
    return (size_t)ceil((end_mm - begin_mm) / (0.7 * CELL_MM));
}

/* The point of a box's grid, dense enough to touch each cell that the box covers. */
static drawing_point grid_point(const line_axis *axis, const axis_box *box, size_t i, size_t count_u, size_t k,
                                size_t count_v)
{
    double u_mm = box->u_begin_mm + (box->u_end_mm - box->u_begin_mm) * (double)i / (double)count_u;
    double v_mm = box->v_begin_mm + (box->v_end_mm - box->v_begin_mm) * (double)k / (double)count_v;
    return axis_point(axis, u_mm, v_mm);
}

void take_box(taken_area *taken, const line_axis *axis, const axis_box *box)
{
    size_t count_u = steps_along(box->u_begin_mm, box->u_end_mm);
    size_t count_v = steps_along(box->v_begin_mm, box->v_end_mm);
    for (size_t i = 0; i <= count_u; i++) {
        for (size_t k = 0; k <= count_v; k++) {
            uint8_t *cell = cell_at(taken, grid_point(axis, box, i, count_u, k, count_v));
            if (cell != NULL)
                *cell = 1;
        }
    }
}

bool box_is_free(const taken_area *taken, const line_axis *axis, const axis_box *box)
{
    size_t count_u = steps_along(box->u_begin_mm, box->u_end_mm);
    size_t count_v = steps_along(box->v_begin_mm, box->v_end_mm);
    for (size_t i = 0; i <= count_u; i++) {
        for (size_t k = 0; k <= count_v; k++) {
            const uint8_t *cell = cell_at(taken, grid_point(axis, box, i, count_u, k, count_v));
            if (cell == NULL || *cell != 0)
                return false;
        }
    }
    return true;
}

bool label_along(drawing *page, taken_area *taken, const line_axis *axis, const char *text, double u_mm,
                 double v_mm, const drawing_font *font)
{
    const double degrees_per_radian = 57.29577951308232;
    drawing_font turned = *font;
    double height_mm = LABEL_HEIGHT * font->size_mm, half_mm = drawing_text_width_mm(page, text, font) / 2;
    const axis_box box = {u_mm - half_mm - 0.2 * font->size_mm, u_mm + half_mm + 0.2 * font->size_mm, v_mm,
                           v_mm + height_mm};
    if (!box_is_free(taken, axis, &box))
        return false;
    take_box(taken, axis, &box);
    bool upside_down = axis->along_x < -1e-9 || (fabs(axis->along_x) <= 1e-9 && axis->along_y > 0);
    turned.anchor = DRAWING_MIDDLE;
    turned.angle_deg = atan2(axis->along_y, axis->along_x) * degrees_per_radian + (upside_down ? 180 : 0);
    drawing_text(page, text, axis_point(axis, u_mm, upside_down ? v_mm : v_mm + height_mm), &turned);
    return true;
}
