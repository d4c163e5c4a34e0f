#include "marker.h"

#include "least_squares.h"
#include "real.h"

enum {
    PITCH = TAPEMARK_CM_PITCH_MODULES,
    ROWS = TAPEMARK_CELL_ROWS,
    COLUMNS = TAPEMARK_CELL_COLUMNS,
    FIRST_COLUMN = 5 /* u of the coding region's first column */
};

/* Square to quadrilateral, after Heckbert, "Fundamentals of Texture Mapping and Image Warping" (1989). */
void tmi_homography_between(const tmi_finder *left, const tmi_finder *right, tmi_homography *out)
{
    const tmi_point p0 = tmi_at(left, 0, -3.5f), p1 = tmi_at(right, 0, -3.5f);
    const tmi_point p2 = tmi_at(right, 0, 3.5f), p3 = tmi_at(left, 0, 3.5f);
    const float sx = p0.x - p1.x + p2.x - p3.x, sy = p0.y - p1.y + p2.y - p3.y;
    const float dx1 = p1.x - p2.x, dy1 = p1.y - p2.y, dx2 = p3.x - p2.x, dy2 = p3.y - p2.y;
    const float det = dx1 * dy2 - dx2 * dy1;
    const float g = det != 0 ? (sx * dy2 - dx2 * sy) / det : 0, h = det != 0 ? (dx1 * sy - sx * dy1) / det : 0;
    const float s[8] = {p1.x - p0.x + g * p1.x, p3.x - p0.x + h * p3.x, p0.x,
                        p1.y - p0.y + g * p1.y, p3.y - p0.y + h * p3.y, p0.y, g, h};
    /* The square's (s, t) are u / 25 and (v + 3.5) / 7. */
    const float w = 1 + 0.5f * s[7];
    for (int k = 0; k < 8; k += 3) {
        out->h[k] = s[k] / (PITCH * w);
        out->h[k + 1] = s[k + 1] / (7 * w);
    }
    out->h[2] = (s[2] + 0.5f * s[1]) / w;
    out->h[5] = (s[5] + 0.5f * s[4]) / w;
}

tmi_point tmi_project(const tmi_homography *map, float u, float v)
{
    const float *h = map->h;
    const float w = 1 / (h[6] * u + h[7] * v + 1);
    return (tmi_point){(h[0] * u + h[1] * v + h[2]) * w, (h[3] * u + h[4] * v + h[5]) * w};
}

/* ---- Sampling ---------------------------------------------------------------------------------------- */

/* How finely a module is sampled: points a side, and how far from each other, in modules. */
typedef struct raster {
    int points;
    float spacing;
} raster;

static raster raster_for(const tmi_homography *map)
{
    const tmi_point a = tmi_project(map, 12, 0), b = tmi_project(map, 13, 0), c = tmi_project(map, 12, 1);
    const float along = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
    const float across = (c.x - a.x) * (c.x - a.x) + (c.y - a.y) * (c.y - a.y);
    return along < 16 || across < 16 ? (raster){2, 0.4f} : (raster){3, 0.25f};
}

static float sample_module(const tmi_view *view, const tmi_homography *map, raster r, float u, float v,
                           uint32_t *reads)
{
    const float first = -0.5f * r.spacing * (float)(r.points - 1);
    float sum = 0;
    for (int j = 0; j < r.points; j++)
        for (int i = 0; i < r.points; i++) {
            const tmi_point at = tmi_project(map, u + first + r.spacing * (float)i, v + first + r.spacing * (float)j);
            sum += tmi_sample(view, at.x, at.y);
        }
    *reads += (uint32_t)(r.points * r.points);
    return sum / (float)(r.points * r.points);
}

/* ---- Light and blur ---------------------------------------------------------------------------------- */

typedef struct levels {
    float light, depth;            /* gray of a light module, and how much darker a dark one is */
    float leak_along, leak_across; /* times depth */
} levels;

static float finder_module(int u, int v)
{
    const int a = u < 0 ? -u : u, b = v < 0 ? -v : v, ring = a > b ? a : b;
    return ring <= 1 || ring == 3 ? 1.0f : 0.0f;
}

/* Fits what a finder pattern shows by light - depth * (pattern + leaks * second differences of the pattern). */
static bool fit_levels(const tmi_view *view, const tmi_homography *map, raster r, float u0, levels *out,
                       uint32_t *reads)
{
    /* Means over the 49 modules: the pattern has 33 dark ones; each of the second differences moves 14 dark
     * modules' worth across the pattern's border. */
    const float mean_pattern = 33.0f / 49, mean_bend = -14.0f / 49;
    tmi_normal normal = {0};
    float mean = 0;
    for (int v = -3; v <= 3; v++)
        for (int u = -3; u <= 3; u++) {
            const float value = sample_module(view, map, r, u0 + (float)u, (float)v, reads);
            const float here = finder_module(u, v);
            const float along = finder_module(u - 1, v) + finder_module(u + 1, v) - 2 * here;
            const float across = finder_module(u, v - 1) + finder_module(u, v + 1) - 2 * here;
            tmi_normal_add(&normal, mean_pattern - here, mean_bend - along, mean_bend - across, value, 1);
            mean += value * (1.0f / 49);
        }
    float p[3];
    if (!tmi_normal_solve(&normal, p))
        return false;
    out->depth = p[0];
    out->light = mean + p[0] * mean_pattern + (p[1] + p[2]) * mean_bend;
    out->leak_along = p[1];
    out->leak_across = p[2];
    return true;
}

bool tmi_marker_sample(const tmi_view *view, const tmi_homography *map, float contrast_min, tmi_cells *cells,
                       uint32_t *reads)
{
    const raster r = raster_for(map);
    levels left, right;
    if (!fit_levels(view, map, r, 0, &left, reads) || !fit_levels(view, map, r, PITCH, &right, reads))
        return false;
    if (left.depth < contrast_min || right.depth < contrast_min)
        return false;
    const float depth = left.depth + right.depth, leak_max = 0.3f;
    cells->leak_along = real_min(leak_max, real_max(0, (left.leak_along + right.leak_along) / depth));
    cells->leak_across = real_min(leak_max, real_max(0, (left.leak_across + right.leak_across) / depth));
    for (int column = 0; column < COLUMNS; column++) {
        const float u = (float)(FIRST_COLUMN + column), t = u / PITCH;
        const float light = left.light + t * (right.light - left.light);
        const float scale = 1 / (left.depth + t * (right.depth - left.depth));
        for (int row = 0; row < ROWS; row++) {
            const float value = sample_module(view, map, r, u, (float)(row - 3), reads);
            cells->value[row * COLUMNS + column] = (light - value) * scale;
        }
    }
    return true;
}
