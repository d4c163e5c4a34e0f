#include "marker.h"

#include "least_squares.h"
#include "real.h"

enum {
    PITCH = TAPEMARK_CM_PITCH_MODULES,
    ROWS = TAPEMARK_CELL_ROWS,
    COLUMNS = TAPEMARK_CELL_COLUMNS,
    FIRST_COLUMN = 5 /* u of the coding region's first column */
};

/* ---- Location ---------------------------------------------------------------------------------------- */

/* The map that takes (0, -3.5), (length, -3.5), (length, 3.5) and (0, 3.5) to these points. Square to quadrilateral,
 * after Heckbert, "Fundamentals of Texture Mapping and Image Warping" (1989). */
static void map_corners(const tmi_point p[4], float length, tmi_homography *out)
{
    const float sx = p[0].x - p[1].x + p[2].x - p[3].x, sy = p[0].y - p[1].y + p[2].y - p[3].y;
    const float dx1 = p[1].x - p[2].x, dy1 = p[1].y - p[2].y, dx2 = p[3].x - p[2].x, dy2 = p[3].y - p[2].y;
    const float det = dx1 * dy2 - dx2 * dy1;
    const float g = det != 0 ? (sx * dy2 - dx2 * sy) / det : 0, h = det != 0 ? (dx1 * sy - sx * dy1) / det : 0;
    const float s[8] = {p[1].x - p[0].x + g * p[1].x,
                        p[3].x - p[0].x + h * p[3].x,
                        p[0].x,
                        p[1].y - p[0].y + g * p[1].y,
                        p[3].y - p[0].y + h * p[3].y,
                        p[0].y,
                        g,
                        h};
    /* The square's (s, t) are u / length and (v + 3.5) / 7. */
    const float w = 1 + 0.5f * s[7];
    for (int k = 0; k < 8; k += 3) {
        out->h[k] = s[k] / (length * w);
        out->h[k + 1] = s[k + 1] / (7 * w);
    }
    out->h[2] = (s[2] + 0.5f * s[1]) / w;
    out->h[5] = (s[5] + 0.5f * s[4]) / w;
}

/* Where the map's point (u0, v) really is, by what was measured around (u0, 0). */
static tmi_point corrected(const tmi_homography *map, float u0, float v, const tmi_offsets *by)
{
    return tmi_project(map, u0 + by->u[0] + by->u[2] * v, v + by->v[0] + by->v[2] * v);
}

void tmi_marker_map(const tmi_finder *left, const tmi_finder *right, tmi_homography *map)
{
    const tmi_point p[4] = {tmi_at(left, 0, -3.5f), tmi_at(right, 0, -3.5f), tmi_at(right, 0, 3.5f),
                            tmi_at(left, 0, 3.5f)};
    map_corners(p, PITCH, map);
}

/* Modules; where the finders lie this near to where the map has them, it is good. */
static const float settled = 0.1f;

void tmi_marker_refine(const tmi_view *view, const tmi_finder *left, const tmi_finder *right, tmi_homography *map,
                       uint32_t *reads)
{
    const float contrast_min = 0.05f * (left->light - left->dark + right->light - right->dark);
    for (int step = 0; step < 2; step++) {
        tmi_offsets at_left, at_right;
        if (!tmi_finder_offsets(view, map, 0, 0.4f, contrast_min, &at_left, reads) ||
            !tmi_finder_offsets(view, map, PITCH, 0.4f, contrast_min, &at_right, reads))
            return;
        const tmi_point p[4] = {corrected(map, 0, -3.5f, &at_left), corrected(map, PITCH, -3.5f, &at_right),
                                corrected(map, PITCH, 3.5f, &at_right), corrected(map, 0, 3.5f, &at_left)};
        map_corners(p, PITCH, map);
        if (tmi_offsets_size(&at_left) < settled && tmi_offsets_size(&at_right) < settled)
            return;
    }
}

/* How the offsets change along a row: constant, linear and square term of u for the shift, constant and linear
 * one for how the shift grows with v. */
typedef struct row_trend {
    float shift_u[3], shift_v[3], shear_u[3], shear_v[3];
} row_trend;

/* Fits the trend to what each finder shows. Perspective that was taken over wrongly from the two outermost finders
 * is a square term along the row, a straight row stays straight, and so do its edges. False when too few do. */
static bool fit_trend(const tmi_view *view, const tmi_homography *map, const tmi_finder *finders, int count,
                      row_trend *trend, uint32_t *reads)
{
    tmi_normal shift_u = {0}, shift_v = {0}, shear_u = {0}, shear_v = {0};
    const float no_square = 1e-3f; /* holds an unknown at zero that is not to be fitted */
    tmi_normal_add(&shift_v, 0, 0, 1, 0, no_square);
    tmi_normal_add(&shear_u, 0, 0, 1, 0, no_square);
    tmi_normal_add(&shear_v, 0, 0, 1, 0, no_square);
    int good = 0;
    for (int i = 0; i < count; i++) {
        tmi_offsets by;
        const float contrast_min = 0.1f * (finders[i].light - finders[i].dark),
                    u = 2 * (float)i / (float)(count - 1) - 1;
        if (!tmi_finder_offsets(view, map, (float)(PITCH * i), 0.5f, contrast_min, &by, reads) ||
            tmi_offsets_size(&by) > 1)
            continue;
        const float weight = finders[i].score * finders[i].score;
        tmi_normal_add(&shift_u, 1, u, u * u, by.u[0], weight);
        tmi_normal_add(&shift_v, 1, u, 0, by.v[0], weight);
        tmi_normal_add(&shear_u, 1, u, 0, by.u[2], weight);
        tmi_normal_add(&shear_v, 1, u, 0, by.v[2], weight);
        good++;
    }
    return good > 3 && tmi_normal_solve(&shift_u, trend->shift_u) && tmi_normal_solve(&shift_v, trend->shift_v) &&
           tmi_normal_solve(&shear_u, trend->shear_u) && tmi_normal_solve(&shear_v, trend->shear_v);
}

/* By how much the trend moves what the map of the row has around finder i. */
static tmi_offsets trend_at(const row_trend *trend, int i, int count)
{
    const float u = 2 * (float)i / (float)(count - 1) - 1, uu = u * u;
    const float *p = trend->shift_u, *q = trend->shift_v, *r = trend->shear_u, *s = trend->shear_v;
    return (tmi_offsets){{p[0] + p[1] * u + p[2] * uu, 0, r[0] + r[1] * u + r[2] * uu},
                         {q[0] + q[1] * u + q[2] * uu, 0, s[0] + s[1] * u + s[2] * uu}};
}

/* Modules that a finder's centre, and the middles of its upper and lower edge, may lie off from where its row has
 * them. A centre that is off by more tells that the row is not straight, or not flat. */
static const float astray = 0.4f, edge_astray = 0.6f;

/* How far from this point of the finder another one is, in its modules. */
static float apart(const tmi_finder *f, float v, tmi_point other)
{
    const tmi_point at = tmi_at(f, 0, v);
    const float x = other.x - at.x, y = other.y - at.y;
    const float along = real_abs(x * f->down.y - y * f->down.x), across = real_abs(y * f->right.x - x * f->right.y);
    return real_max(along, across) / real_abs(f->right.x * f->down.y - f->right.y * f->down.x);
}

/* Whether all finders lie where the row has them, and lean with it, but for one in four. */
static bool meets_finders(const tmi_homography *row, const row_trend *trend, const tmi_finder *finders, int count)
{
    int leaning = 0;
    for (int i = 0; i < count; i++) {
        const tmi_offsets by = trend_at(trend, i, count);
        const float u = (float)(PITCH * i);
        if (!(apart(&finders[i], 0, corrected(row, u, 0, &by)) < astray))
            return false;
        if (!(apart(&finders[i], -3.5f, corrected(row, u, -3.5f, &by)) < edge_astray &&
              apart(&finders[i], 3.5f, corrected(row, u, 3.5f, &by)) < edge_astray))
            leaning++;
    }
    return 4 * leaning <= count;
}

bool tmi_row_maps(const tmi_view *view, const tmi_finder *finders, int count, tmi_homography *maps, uint32_t *reads)
{
    const tmi_finder *last = &finders[count - 1];
    const tmi_point ends[4] = {tmi_at(finders, 0, -3.5f), tmi_at(last, 0, -3.5f), tmi_at(last, 0, 3.5f),
                               tmi_at(finders, 0, 3.5f)};
    tmi_homography row;
    row_trend trend;
    map_corners(ends, (float)(PITCH * (count - 1)), &row);
    if (count < 4 || !fit_trend(view, &row, finders, count, &trend, reads) ||
        !meets_finders(&row, &trend, finders, count))
        return false;
    tmi_point p[4];
    for (int i = 0; i < count; i++) {
        const tmi_offsets by = trend_at(&trend, i, count);
        p[1] = corrected(&row, (float)(PITCH * i), -3.5f, &by);
        p[2] = corrected(&row, (float)(PITCH * i), 3.5f, &by);
        if (i > 0)
            map_corners(p, PITCH, &maps[i - 1]);
        p[0] = p[1];
        p[3] = p[2];
    }
    return true;
}

/* ---- Sampling ---------------------------------------------------------------------------------------- */

/* A module is sampled at four points, as far from each other as this, in modules; and whether all that is sampled of
 * a CM lies well within the image. */
typedef struct raster {
    float spacing;
    bool inside;
} raster;

/* Square of a module's narrower side, px, in the middle between the finders. */
static float narrow_side_squared(const tmi_homography *map)
{
    const tmi_point a = tmi_project(map, 12, 0), b = tmi_project(map, 13, 0), c = tmi_project(map, 12, 1);
    const float along = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
    const float across = (c.x - a.x) * (c.x - a.x) + (c.y - a.y) * (c.y - a.y);
    return real_min(along, across);
}

static raster raster_for(const tmi_view *view, const tmi_homography *map)
{
    return (raster){narrow_side_squared(map) < 16 ? 0.4f : 0.45f,
                    tmi_rectangle_is_within(view, map, -4, -4, PITCH + 4, 4)};
}

/* Modules that words need to be told from each other, px. */
static const float words_px = 0.95f;

/* Steps of 1/256 px, negative ones as what they are modulo 2^32. */
static uint32_t steps_of(float px)
{
    return (uint32_t)(int32_t)(px * TMI_STEPS_PER_PX);
}

/* Mean gray of four points, all within the image: from the first one on, and from one to the next. */
static float mean_inside(const tmi_view *view, tmi_point first, tmi_point along, tmi_point across)
{
    const uint32_t x = steps_of(first.x), y = steps_of(first.y);
    const uint32_t along_x = steps_of(along.x), along_y = steps_of(along.y);
    const uint32_t across_x = steps_of(across.x), across_y = steps_of(across.y);
    return tmi_gray(view,
                    tmi_interpolate(view, (tmi_place){x, y}) +
                        tmi_interpolate(view, (tmi_place){x + along_x, y + along_y}) +
                        tmi_interpolate(view, (tmi_place){x + across_x, y + across_y}) +
                        tmi_interpolate(view, (tmi_place){x + along_x + across_x, y + along_y + across_y}),
                    4);
}

static float mean_anywhere(const tmi_view *view, tmi_point first, tmi_point along, tmi_point across)
{
    const tmi_point last = {first.x + across.x, first.y + across.y};
    return 0.25f * (tmi_sample(view, first.x, first.y) + tmi_sample(view, first.x + along.x, first.y + along.y) +
                    tmi_sample(view, last.x, last.y) + tmi_sample(view, last.x + along.x, last.y + along.y));
}

/* Mean gray of a module. Within it, perspective says nothing. */
TMI_ONCE static float sample_module(const tmi_view *view, const tmi_homography *map, raster r, float u, float v,
                                    uint32_t *reads)
{
    const float *h = map->h;
    const float w = 1 / (h[6] * u + h[7] * v + 1), step = r.spacing * w;
    const tmi_point middle = {(h[0] * u + h[1] * v + h[2]) * w, (h[3] * u + h[4] * v + h[5]) * w};
    const tmi_point along = {(h[0] - middle.x * h[6]) * step, (h[3] - middle.y * h[6]) * step};
    const tmi_point across = {(h[1] - middle.x * h[7]) * step, (h[4] - middle.y * h[7]) * step};
    const tmi_point first = {middle.x - 0.5f * (along.x + across.x), middle.y - 0.5f * (along.y + across.y)};
    *reads += 4;
    return r.inside ? mean_inside(view, first, along, across) : mean_anywhere(view, first, along, across);
}

/* ---- Light and blur ---------------------------------------------------------------------------------- */

typedef struct levels {
    float light, depth;            /* gray of a light module, and how much darker a dark one is */
    float leak_along, leak_across; /* times depth */
} levels;

static float finder_module(int u, int v)
{
    return tmi_finder_is_dark(u, v) ? 1.0f : 0.0f;
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

/* ---- Shadow edges ------------------------------------------------------------------------------------ */

/* Light in the quiet zone above and below, from the left finder's centre to the right one's, where a shadow's edge
 * runs across both. */
typedef struct shade {
    float light[2][PITCH + 1];
    float edge[2]; /* where it passes the middle between what the finders show; u, modules */
} shade;

/* From this ratio of the finders' light on there is a shadow between them; less is as well taken for a slope. */
static const float shade_min = 1.4f;

/* The quiet zone is seen apart from what is around it, in modules of this many px at least. */
static const float quiet_px = 3;

static bool find_shade_edge(const float light[PITCH + 1], float middle, float *edge)
{
    int i = 1;
    while (i <= PITCH && (light[i] < middle) == (light[0] < middle))
        i++;
    if (i > PITCH)
        return false;
    *edge = (float)(i - 1) + (middle - light[i - 1]) / (light[i] - light[i - 1]);
    return true;
}

static bool find_shade(const tmi_view *view, const tmi_homography *map, const levels *left, const levels *right,
                       shade *out, uint32_t *reads)
{
    const float least = real_min(left->light, right->light), most = real_max(left->light, right->light);
    const tmi_point middle = tmi_project(map, 12, 0), below = tmi_project(map, 12, 1);
    const float x = below.x - middle.x, y = below.y - middle.y;
    if (!(least > 0 && most > shade_min * least) || x * x + y * y < quiet_px * quiet_px)
        return false;
    for (int side = 0; side < 2; side++) {
        for (int u = 0; u <= PITCH; u++) {
            const tmi_point at = tmi_project(map, (float)u, side ? 4 : -4);
            out->light[side][u] = tmi_sample(view, at.x, at.y);
        }
        *reads += PITCH + 1;
        if (!find_shade_edge(out->light[side], 0.5f * (least + most), &out->edge[side]))
            return false;
    }
    return true;
}

static float shade_along(const float light[PITCH + 1], float u)
{
    const float at = real_max(0, real_min(PITCH - 0.001f, u));
    const int i = (int)at;
    return light[i] + (at - (float)i) * (light[i + 1] - light[i]);
}

/* Light at (u, v): what it is above and below at that distance from the edge, which is a straight line. */
static float shade_at(const shade *s, float u, float v)
{
    const float down = (v + 4) * 0.125f, from_edge = u - s->edge[0] - down * (s->edge[1] - s->edge[0]);
    const float above = shade_along(s->light[0], s->edge[0] + from_edge);
    const float below = shade_along(s->light[1], s->edge[1] + from_edge);
    return above + down * (below - above);
}

/* ---- Cells ------------------------------------------------------------------------------------------- */

void tmi_marker_glance(const tmi_view *view, const tmi_homography *map, const tmi_finder *left,
                       const tmi_finder *right, tmi_cells *cells, uint32_t *reads)
{
    const float light = 0.5f * (left->light + right->light), dark = 0.5f * (left->dark + right->dark);
    const float scale = 1 / real_max(1, light - dark);
    cells->leak_along = cells->leak_across = 0.1f;
    cells->narrow = false;
    for (int i = 0; i < TAPEMARK_CELLS; i++) {
        const tmi_point at = tmi_project(map, (float)(FIRST_COLUMN + i % COLUMNS), (float)(i / COLUMNS - 3));
        cells->value[i] = (light - tmi_sample(view, at.x, at.y)) * scale;
    }
    *reads += TAPEMARK_CELLS;
}

bool tmi_marker_sample(const tmi_view *view, const tmi_homography *map, float contrast_min, tmi_cells *cells,
                       uint32_t *reads)
{
    const raster r = raster_for(view, map);
    levels left, right;
    if (!fit_levels(view, map, r, 0, &left, reads) || !fit_levels(view, map, r, PITCH, &right, reads))
        return false;
    if (left.depth < contrast_min || right.depth < contrast_min)
        return false;
    const float depth = left.depth + right.depth, leak_max = 0.3f;
    cells->leak_along = real_min(leak_max, real_max(0, (left.leak_along + right.leak_along) / depth));
    cells->leak_across = real_min(leak_max, real_max(0, (left.leak_across + right.leak_across) / depth));
    cells->narrow = narrow_side_squared(map) < words_px * words_px;
    shade edge;
    const bool shaded = find_shade(view, map, &left, &right, &edge, reads);
    const float ink = depth / (left.light + right.light); /* the part of the light that it takes */
    for (int column = 0; column < COLUMNS; column++) {
        const float u = (float)(FIRST_COLUMN + column), t = u / PITCH;
        const float light = left.light + t * (right.light - left.light);
        const float scale = 1 / (left.depth + t * (right.depth - left.depth));
        for (int row = 0; row < ROWS; row++) {
            const float value = sample_module(view, map, r, u, (float)(row - 3), reads);
            const float here = shaded ? shade_at(&edge, u, (float)(row - 3)) : light;
            cells->value[row * COLUMNS + column] =
                shaded ? (here - value) / real_max(1, here * ink) : (light - value) * scale;
        }
    }
    return true;
}
