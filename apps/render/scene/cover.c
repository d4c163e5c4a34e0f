#include "cover.h"

#include <math.h>

#include "elementary.h"
#include "random.h"
#include "sensor.h"

static bool is_under(const scene_cover *cover, direction axis, double x_px, double y_px)
{
    double dx = x_px - cover->x_px, dy = y_px - cover->y_px;
    return fabs(axis.x * dx + axis.y * dy) <= cover->width_px / 2 &&
           fabs(axis.x * dy - axis.y * dx) <= cover->height_px / 2;
}

bool covered_at(const scene *view, double x_px, double y_px)
{
    for (size_t i = 0; i < view->cover_count; i++) {
        if (is_under(&view->covers[i], direction_of(view->covers[i].angle_deg), x_px, y_px))
            return true;
    }
    return false;
}

static void paint_cover(const scene *view, size_t index, canvas *picture)
{
    const scene_cover *cover = &view->covers[index];
    const direction axis = direction_of(cover->angle_deg);
    random_source source = {view->seed + index + UINT64_C(0x636f766572)};
    for (int32_t y = 0; y < picture->height_px; y++) {
        float *row = canvas_row(picture, y);
        for (int32_t x = 0; x < picture->width_px; x++) {
            if (!is_under(cover, axis, x, y))
                continue;
            double shade = cover->shade + cover->texture * (double)random_normal(&source);
            row[x] = (float)light_of_shade(shade, view->sensor.gamma);
        }
    }
}

void paint_covers(const scene *view, canvas *picture)
{
    for (size_t i = 0; i < view->cover_count; i++)
        paint_cover(view, i, picture);
}
