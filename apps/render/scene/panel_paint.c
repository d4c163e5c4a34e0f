#include "panel_paint.h"

#include <math.h>

patch patch_at(const thing *part, double x_px, double y_px)
{
    const matrix *m = &part->to_plane;
    const scene_vector p = matrix_times(m, (scene_vector){x_px, y_px, 1});
    const double depth_m = 1 / p.z, along_m = p.x * depth_m, across_m = p.y * depth_m;
    double along = fabs(m->at[0][0] - along_m * m->at[2][0]) + fabs(m->at[0][1] - along_m * m->at[2][1]);
    double across = fabs(m->at[1][0] - across_m * m->at[2][0]) + fabs(m->at[1][1] - across_m * m->at[2][1]);
    return (patch){along_m, across_m, along * depth_m, across * depth_m};
}

static void paint_panel(const world *seen, int32_t index, const panel_look *look, canvas *picture)
{
    const thing *part = &seen->things[index];
    for (int32_t y = part->box.top; y < part->box.bottom; y++) {
        const int32_t *front = seen->front + pixel_index(seen, 0, y);
        float *row = canvas_row(picture, y);
        const pixel_span span = centres_in_row(part, y);
        for (int32_t x = span.left; x < span.right; x++) {
            if (front[x] != index)
                continue;
            const patch here = patch_at(part, x, y);
            row[x] = (float)look_at(look, &here);
        }
    }
}

static void paint_shadow(const world *seen, int32_t index, const panel_look *look, canvas *picture)
{
    const thing *part = &seen->things[index];
    for (int32_t y = part->box.top; y < part->box.bottom; y++) {
        float *row = canvas_row(picture, y);
        const pixel_span span = centres_in_row(part, y);
        for (int32_t x = span.left; x < span.right; x++) {
            if (is_hidden(seen, part, x, y))
                continue;
            const patch here = patch_at(part, x, y);
            row[x] *= (float)look_at(look, &here);
        }
    }
}

void paint_panels(const world *seen, const prints *all, canvas *picture)
{
    for (size_t i = 0; i < seen->count && seen->things[i].kind == THING_PANEL; i++) {
        if (!is_shadow(seen->view, &seen->things[i]))
            paint_panel(seen, (int32_t)i, &all->looks[seen->things[i].index], picture);
    }
    for (size_t i = 0; i < seen->count && seen->things[i].kind == THING_PANEL; i++) {
        if (is_shadow(seen->view, &seen->things[i]))
            paint_shadow(seen, (int32_t)i, &all->looks[seen->things[i].index], picture);
    }
}
