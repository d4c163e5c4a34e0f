#include "finder.h"

#include "least_squares.h"
#include "real.h"

/* ---- Rays from the core outwards -------------------------------------------------------------------- */

enum { RAYS = 16, RAY_SAMPLES = 72, MISSING_MAX = 5 };

static const tmi_point ray_direction[RAYS] = {
    {1, 0},  {.923880f, .382683f},   {.707107f, .707107f},   {.382683f, .923880f},
    {0, 1},  {-.382683f, .923880f},  {-.707107f, .707107f},  {-.923880f, .382683f},
    {-1, 0}, {-.923880f, -.382683f}, {-.707107f, -.707107f}, {-.382683f, -.923880f},
    {0, -1}, {.382683f, -.923880f},  {.707107f, -.707107f},  {.923880f, -.382683f},
};

/* Index at which the samples from..to pass the middle between those two, between samples. */
static float middle_passed(const float *value, int from, int to)
{
    const float level = 0.5f * (value[from] + value[to]);
    const bool rising = value[to] > value[from];
    int i = from + 1;
    while (i < to && (rising ? value[i] < level : value[i] > level))
        i++;
    const float change = value[i] - value[i - 1];
    return (float)(i - 1) + (change != 0 ? (level - value[i - 1]) / change : 0.5f);
}

/* An edge may lie off its place, 1.5, 2.5 or 3.5 modules from the start, by this part of a module and so many
 * samples. */
static const float slack_modules = 0.55f, slack_samples = 0.4f;

/* Samples after which the ray must have passed the edge `k` of those, when the first one is here: two more, for an
 * edge is noticed behind it. */
static int samples_to_edge(int k, float first_edge)
{
    const float module_max = (first_edge + slack_samples) / (1.5f - slack_modules);
    const float latest = (1.5f + slack_modules + (float)k) * module_max + slack_samples + 2;
    return latest < RAY_SAMPLES ? (int)latest : RAY_SAMPLES;
}

/* The first edge, behind blur, lies no further than this many samples behind where it is noticed. */
static const float blurred_samples = 4;

/* Follows one ray over core, light ring and dark ring. Returns the distance to the dark ring's outer edge, in
 * samples, put together from all three edges; 0 where they are not there or not in proportion. */
static float cast_ray(const tmi_view *view, tmi_point start, tmi_point step, float swing, uint32_t *reads)
{
    const tmi_point end = {start.x + (RAY_SAMPLES - 1) * step.x, start.y + (RAY_SAMPLES - 1) * step.y};
    const bool within = tmi_is_within(view, start) && tmi_is_within(view, end);
    float value[RAY_SAMPLES], edge[3] = {0};
    int extreme_at[4], found = 0, at = 0, last = RAY_SAMPLES; /* core, light ring, dark ring, light margin */
    int i = 0;
    for (; i < last && found < 4; i++) {
        const float x = start.x + (float)i * step.x, y = start.y + (float)i * step.y;
        const float v = value[i] = tmi_sample_at(view, (tmi_point){x, y}, within);
        const bool seeking_light = found & 1;
        if (seeking_light ? v >= value[at] : v <= value[at]) {
            at = i;
        } else if (seeking_light ? v < value[at] - swing : v > value[at] + swing) {
            extreme_at[found++] = at;
            at = i;
            if (found == 2)
                edge[0] = middle_passed(value, extreme_at[0], extreme_at[1]);
            last = found == 1   ? samples_to_edge(1, (float)i + blurred_samples)
                   : found == 2 ? samples_to_edge(2, edge[0])
                                : RAY_SAMPLES;
        }
        /* The margin need not end: three more modules of it are enough. */
        if (found == 3 && 2.33f * (float)(i - extreme_at[2]) > (float)extreme_at[2])
            extreme_at[found++] = at;
    }
    *reads += (uint32_t)i;
    if (found < 4)
        return 0;
    edge[1] = middle_passed(value, extreme_at[1], extreme_at[2]);
    edge[2] = middle_passed(value, extreme_at[2], extreme_at[3]);
    const float module = (1.5f * edge[0] + 2.5f * edge[1] + 3.5f * edge[2]) * (1 / (2.25f + 6.25f + 12.25f));
    const float slack = slack_modules * module + slack_samples;
    for (int k = 0; k < 3; k++)
        if (real_abs(edge[k] - (1.5f + (float)k) * module) > slack)
            return 0;
    return 3.5f * module;
}

/* How far the core goes on from `start`, up to where it has become lighter by `swing`; negative where it does not
 * end. */
static float core_reach(const tmi_view *view, tmi_point start, tmi_point direction, float step_px, float swing,
                        uint32_t *reads)
{
    const float end_px = (RAY_SAMPLES - 1) * step_px;
    const bool within =
        tmi_is_within(view, start) &&
        tmi_is_within(view, (tmi_point){start.x + end_px * direction.x, start.y + end_px * direction.y});
    const float core = tmi_sample(view, start.x, start.y) + swing;
    int i = 1;
    float before = core - swing, now = before;
    for (; i < RAY_SAMPLES; i++, before = now) {
        const float go_px = (float)i * step_px;
        now = tmi_sample_at(view, (tmi_point){start.x + go_px * direction.x, start.y + go_px * direction.y}, within);
        if (now > core)
            break;
    }
    *reads += (uint32_t)i;
    return i < RAY_SAMPLES ? step_px * ((float)i - (now - core) / (now - before)) : -1;
}

/* Width or height of the core at `start`, which is moved halfway between its two edges; negative where there is no
 * core around. */
static float centre_along(const tmi_view *view, tmi_point *start, bool vertical, float step_px, float swing,
                          uint32_t *reads)
{
    const tmi_point d = vertical ? (tmi_point){0, 1} : (tmi_point){1, 0};
    const float ahead = core_reach(view, *start, d, step_px, swing, reads);
    const float behind = ahead < 0 ? -1 : core_reach(view, *start, (tmi_point){-d.x, -d.y}, step_px, swing, reads);
    if (behind < 0)
        return -1;
    start->x += 0.5f * (ahead - behind) * d.x;
    start->y += 0.5f * (ahead - behind) * d.y;
    return ahead + behind;
}

/* The middle between the core's two edges up and down, then left and right: from anywhere within the core this
 * lands near its centre. False when there is no core around. */
static bool centre_in_core(const tmi_view *view, tmi_point *start, float step_px, float swing, tmi_point *size,
                           uint32_t *reads)
{
    for (int k = 0; k < 2; k++) {
        size->y = centre_along(view, start, true, step_px, swing, reads);
        size->x = size->y < 0 ? -1 : centre_along(view, start, false, step_px, swing, reads);
        if (size->x < 0)
            return false;
    }
    return true;
}

/* A core that is this many times as long as it is wide is seen at an angle. */
static const float steep = 2.5f;

/* Steps of rays along x and y. At an angle they are as much longer one way than the other, a part of a module either
 * way, so that rays are spread over the square as over one that is seen head-on. Then the core's middle, which may
 * have been looked for in steps too wide for its narrow side, is found once more. */
static tmi_point ray_step(const tmi_view *view, tmi_point *start, float step_px, float swing, tmi_point size,
                          uint32_t *reads)
{
    const bool upright = size.x < size.y;
    const float longer = upright ? size.y : size.x, shorter = upright ? size.x : size.y;
    if (longer < steep * shorter)
        return (tmi_point){step_px, step_px};
    const float fine_px = real_max(0.4f, real_min(step_px, 0.08f * shorter));
    const float width = real_max(1, centre_along(view, start, !upright, fine_px, swing, reads));
    const float length =
        real_max(width, centre_along(view, start, upright, real_min(step_px, 0.08f * longer), swing, reads));
    const float step = real_max(0.25f, 1.2f / width) * (1.0f / 3);
    return upright ? (tmi_point){step * width, step * length} : (tmi_point){step * length, step * width};
}

/* ---- From the rays to a square ----------------------------------------------------------------------- */

typedef struct outline {
    float x[RAYS], y[RAYS]; /* of the dark ring's outer edge, from the start point, in steps of the rays */
} outline;

/* Puts the rays together to an outline. Opposite rays reach about as far as each other: where one is missing, or
 * reaches much further because it passed over a ring, the other stands for both. Where both are missing they take
 * the mean of the next ones. More than five missing is no finder. */
static bool close_outline(float reach[RAYS], outline *out)
{
    int missing = 0;
    for (int i = 0; i < RAYS; i++) {
        const float opposite = reach[(i + RAYS / 2) % RAYS];
        if (opposite > 0 && (reach[i] == 0 || reach[i] > 1.5f * opposite)) {
            reach[i] = opposite;
            missing++;
        }
    }
    for (int i = 0; i < RAYS; i++)
        missing += reach[i] == 0;
    if (missing > MISSING_MAX)
        return false;
    for (int i = 0; i < RAYS; i++) {
        float r = reach[i];
        if (r == 0) {
            int before = i, after = i;
            while (reach[before] == 0)
                before = (before + RAYS - 1) % RAYS;
            while (reach[after] == 0)
                after = (after + 1) % RAYS;
            r = 0.5f * (reach[before] + reach[after]);
        }
        out->x[i] = r * ray_direction[i].x;
        out->y[i] = r * ray_direction[i].y;
    }
    return true;
}

typedef struct moments {
    float x, y;       /* centroid */
    float xx, xy, yy; /* covariance */
} moments;

/* Area moments of the outline as a polygon. They follow an affine map exactly, so that a sheared square can be
 * told from them: its covariance is (side)^2 / 12 times the identity, mapped. */
static bool outline_moments(const outline *out, moments *m)
{
    float area = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < RAYS; i++) {
        const float x0 = out->x[i], y0 = out->y[i], x1 = out->x[(i + 1) % RAYS], y1 = out->y[(i + 1) % RAYS];
        const float w = x0 * y1 - x1 * y0;
        area += w;
        x += w * (x0 + x1);
        y += w * (y0 + y1);
        xx += w * (x0 * x0 + x0 * x1 + x1 * x1);
        yy += w * (y0 * y0 + y0 * y1 + y1 * y1);
        xy += w * (x0 * y0 + 0.5f * (x0 * y1 + x1 * y0) + x1 * y1);
    }
    if (!(area > 0))
        return false;
    m->x = x / (3 * area);
    m->y = y / (3 * area);
    m->xx = xx / (6 * area) - m->x * m->x;
    m->yy = yy / (6 * area) - m->y * m->y;
    m->xy = xy / (6 * area) - m->x * m->y;
    return m->xx * m->yy - m->xy * m->xy > 1e-3f;
}

/* The turn of the square within its whitened outline: the distance from the centre varies four times around, and
 * is largest at the corners. Each point stands for the angle between its neighbours, for rays that are evenly
 * spread in the image are not so once it is whitened. Returns the unit vector of the side's normal. */
static tmi_point square_turn(const outline *out, const moments *m, const float inverse[3])
{
    float x[RAYS + 2], y[RAYS + 2], r[RAYS + 2]; /* whitened; the first two again at the end */
    for (int i = 0; i < RAYS + 2; i++) {
        const float px = out->x[i % RAYS] - m->x, py = out->y[i % RAYS] - m->y;
        x[i] = inverse[0] * px + inverse[1] * py;
        y[i] = inverse[1] * px + inverse[2] * py;
        r[i] = real_max(1e-3f, real_sqrt(x[i] * x[i] + y[i] * y[i]));
    }
    float re = 0, im = 0;
    for (int i = 1; i <= RAYS; i++) {
        const float weight = (x[i - 1] * y[i + 1] - x[i + 1] * y[i - 1]) / (r[i - 1] * r[i + 1]);
        const float c2 = (x[i] * x[i] - y[i] * y[i]) / (r[i] * r[i]), s2 = 2 * x[i] * y[i] / (r[i] * r[i]);
        re += weight * r[i] * (c2 * c2 - s2 * s2);
        im += weight * r[i] * 2 * s2 * c2;
    }
    /* Sides lie opposite to corners: the angle of (-re, -im), divided by four. */
    tmi_point turn = {-re, -im};
    for (int halving = 0; halving < 2; halving++) {
        const float length = real_sqrt(turn.x * turn.x + turn.y * turn.y);
        if (!(length > 0))
            return (tmi_point){1, 0};
        const float c = real_sqrt(real_max(0, 0.5f * (1 + turn.x / length)));
        const float s = real_sqrt(real_max(0, 0.5f * (1 - turn.x / length)));
        turn = (tmi_point){c, turn.y < 0 ? -s : s};
    }
    return turn;
}

static void square_from_moments(const moments *m, const outline *out, tmi_point start, tmi_point step_px,
                                tmi_finder *finder)
{
    /* Symmetric square root of covariance * 12 / 7^2: the shape of one module, up to its turn. */
    const float k = 12.0f / 49;
    const float a = k * m->xx, b = k * m->xy, d = k * m->yy;
    const float root_det = real_sqrt(a * d - b * b), t = 1 / real_sqrt(a + d + 2 * root_det);
    const float sa = t * (a + root_det), sb = t * b, sd = t * (d + root_det);
    const float inverse[3] = {sd / root_det, -sb / root_det, sa / root_det};
    const tmi_point turn = square_turn(out, m, inverse);
    finder->centre = (tmi_point){start.x + step_px.x * m->x, start.y + step_px.y * m->y};
    finder->right = (tmi_point){step_px.x * (sa * turn.x + sb * turn.y), step_px.y * (sb * turn.x + sd * turn.y)};
    finder->down = (tmi_point){step_px.x * (-sa * turn.y + sb * turn.x), step_px.y * (-sb * turn.y + sd * turn.x)};
}

/* ---- Fine location ------------------------------------------------------------------------------------ */

/* Over less than this, in steps of the interpolation, the image of an edge is one slope. */
enum { FINE_STEPS = 5 * TMI_STEPS_PER_PX / 2 };

static tmi_place halfway(tmi_place a, tmi_place b)
{
    return (tmi_place){(a.x + b.x) / 2, (a.y + b.y) / 2};
}

/* Along the axis in which it is more. */
static uint32_t steps_apart(tmi_place a, tmi_place b)
{
    const uint32_t x = a.x > b.x ? a.x - b.x : b.x - a.x, y = a.y > b.y ? a.y - b.y : b.y - a.y;
    return x > y ? x : y;
}

/* Where the gray value between two places passes the middle of what it is at both ends: -1 at `in`, 1 at `out`. Blur
 * is symmetric, so that this holds for blurred edges. Where that is more than the blur can be, the place is halved
 * in first. */
static float middle_between(const tmi_view *view, tmi_place in, tmi_place out, int32_t inside, int32_t outside,
                            uint32_t *reads)
{
    const int32_t middle = (inside + outside) / 2;
    const uint32_t wide = steps_apart(in, out);
    const bool rises = outside > inside;
    float from = -1, length = 2;
    ++*reads;
    if (wide < FINE_STEPS) {
        const float bend = (float)(middle - tmi_interpolate(view, halfway(in, out)));
        return real_max(-1, real_min(1, 2 * bend / (float)(outside - inside)));
    }
    for (uint32_t left = wide; left > FINE_STEPS / 2; left /= 2) {
        const tmi_place at = halfway(in, out);
        const int32_t value = tmi_interpolate(view, at);
        ++*reads;
        length *= 0.5f;
        if (rises ? value > middle : value < middle) {
            out = at;
            outside = value;
        } else {
            in = at;
            inside = value;
            from += length;
        }
    }
    return outside != inside ? from + length * (float)(middle - inside) / (float)(outside - inside) : 0;
}

/* One side of a ring as the map has it, in steps of the interpolation times w: its middle, one module along it, and
 * as far outwards as is looked for its edge. */
typedef struct ring_side {
    float middle[3], along[3], outwards[3];
} ring_side;

static ring_side side_of(const tmi_homography *map, float u, float v, bool upright, float outwards)
{
    const float scale[3] = {TMI_STEPS_PER_PX, TMI_STEPS_PER_PX, 1};
    ring_side side;
    for (int k = 0; k < 3; k++) {
        const float *h = &map->h[3 * k];
        const float here = k < 2 ? h[2] : 1;
        side.middle[k] = scale[k] * (h[0] * u + h[1] * v + here);
        side.along[k] = scale[k] * (upright ? h[1] : h[0]);
        side.outwards[k] = scale[k] * outwards * (upright ? h[0] : h[1]);
    }
    return side;
}

static tmi_place place_at(const tmi_view *view, float x_steps, float y_steps, bool within)
{
    return within ? tmi_place_within(x_steps, y_steps) : tmi_nearest_place(view, x_steps, y_steps);
}

/* Weighted sums over places x on a line at which y was measured. */
typedef struct line_sums {
    float n, x, xx, y, xy;
} line_sums;

/* Gathers how far outwards the edge lies from where the map has it, 1 being as far as is looked, all along a side of
 * that many modules to both sides of its middle. What lies outside of it has to be lighter (sign: 1) or darker (-1)
 * by contrast_min, in which edges are weighed. */
TMI_ONCE static line_sums measure_side(const tmi_view *view, const ring_side *side, int half_length, bool within,
                                       float sign, float contrast_min, uint32_t *reads)
{
    const float *m = side->middle, *a = side->along, *o = side->outwards;
    const float per_gray = sign * view->sign / TMI_ONE_GRAY;
    line_sums sums = {0};
    for (int k = -half_length; k <= half_length; k++) {
        const float x = (float)k, w = 1 / (m[2] + x * a[2]);
        const float at_x = (m[0] + x * a[0]) * w, at_y = (m[1] + x * a[1]) * w;
        const float go_x = (o[0] - at_x * o[2]) * w, go_y = (o[1] - at_y * o[2]) * w;
        const tmi_place in = place_at(view, at_x - go_x, at_y - go_y, within);
        const tmi_place out = place_at(view, at_x + go_x, at_y + go_y, within);
        const int32_t inside = tmi_interpolate(view, in), outside = tmi_interpolate(view, out);
        const float contrast = per_gray * (float)(outside - inside);
        *reads += 2;
        if (!(contrast > contrast_min))
            continue;
        const float weighted = contrast * middle_between(view, in, out, inside, outside, reads);
        sums.n += contrast;
        sums.x += contrast * x;
        sums.xx += contrast * x * x;
        sums.y += weighted;
        sums.xy += weighted * x;
    }
    return sums;
}

/* The equations y = p0 + p1 * distance + p2 * x of a side's edges. */
static void add_side(tmi_normal *n, const line_sums *s, float distance)
{
    n->a00 += s->n;
    n->a01 += s->n * distance;
    n->a02 += s->x;
    n->a11 += s->n * distance * distance;
    n->a12 += s->x * distance;
    n->a22 += s->xx;
    n->b0 += s->y;
    n->b1 += s->y * distance;
    n->b2 += s->xy;
}

bool tmi_finder_offsets(const tmi_view *view, const tmi_homography *map, float u0, float span, float contrast_min,
                        tmi_offsets *out, uint32_t *reads)
{
    const float most = 3.5f + span;
    const bool within = tmi_rectangle_is_within(view, map, u0 - most, -most, u0 + most, most);
    tmi_normal shift[2] = {0}; /* of v, by upper and lower sides; and of u, by upright ones */
    for (int ring = 0; ring < 3; ring++)
        for (int k = 0; k < 4; k++) {
            const bool upright = k & 1;
            const float outwards = k & 2 ? -1.0f : 1.0f, distance = outwards * (1.5f + (float)ring);
            const ring_side side = upright ? side_of(map, u0 + distance, 0, true, outwards * span)
                                           : side_of(map, u0, distance, false, outwards * span);
            const line_sums sums =
                measure_side(view, &side, 1 + ring, within, ring == 1 ? -1.0f : 1.0f, contrast_min, reads);
            const float unit = outwards * span;
            const line_sums signed_sums = {sums.n, sums.x, sums.xx, unit * sums.y, unit * sums.xy};
            add_side(&shift[upright], &signed_sums, distance);
        }
    float by_v[3], by_u[3];
    if (!tmi_normal_solve(&shift[0], by_v) || !tmi_normal_solve(&shift[1], by_u))
        return false;
    *out = (tmi_offsets){{by_u[0], by_u[1], by_u[2]}, {by_v[0], by_v[2], by_v[1]}};
    return true;
}

float tmi_offsets_size(const tmi_offsets *by)
{
    return real_max(real_abs(by->u[0]), real_abs(by->v[0])) +
           3.5f * real_max(real_max(real_abs(by->u[1]), real_abs(by->v[1])),
                           real_max(real_abs(by->u[2]), real_abs(by->v[2])));
}

/* One step of fitting the square to the edges of its three rings. `span` is how far to look, in modules. */
static bool fit_step(const tmi_view *view, tmi_finder *f, float span, float *moved, uint32_t *reads)
{
    const tmi_homography map = tmi_finder_map(f);
    tmi_offsets by;
    if (!tmi_finder_offsets(view, &map, 0, span, 0.1f * (f->light - f->dark), &by, reads))
        return false;
    const tmi_finder old = *f;
    f->centre = tmi_at(&old, by.u[0], by.v[0]);
    f->right = (tmi_point){(1 + by.u[1]) * old.right.x + by.v[1] * old.down.x,
                           (1 + by.u[1]) * old.right.y + by.v[1] * old.down.y};
    f->down = (tmi_point){by.u[2] * old.right.x + (1 + by.v[2]) * old.down.x,
                          by.u[2] * old.right.y + (1 + by.v[2]) * old.down.y};
    *moved = tmi_offsets_size(&by);
    return real_abs(by.u[0]) < 1 && real_abs(by.v[0]) < 1;
}

/* ---- Score --------------------------------------------------------------------------------------------- */

/* Sums over samples of the pattern, of which so many should be dark and light; 65536 times the gray. */
typedef struct pattern_sums {
    float darks, lights, dark, light, squares;
} pattern_sums;

TMI_ONCE static void set_score(const tmi_view *view, const pattern_sums *s, tmi_finder *finder)
{
    const float n = s->darks + s->lights, sum = s->dark + s->light, per_gray = view->sign / TMI_ONE_GRAY;
    const float variance = (s->squares - sum * sum / n) * (per_gray * per_gray);
    finder->dark = s->dark / s->darks * per_gray + view->offset;
    finder->light = s->light / s->lights * per_gray + view->offset;
    const float explained = (finder->light - finder->dark) * real_sqrt(s->darks * s->lights / n);
    finder->score = variance > 1 ? explained / real_sqrt(variance) : 0;
}

/* Samples the modules up to so many from the finder's centre along and across, row by row. */
TMI_ONCE static void sample_modules(const tmi_view *view, const tmi_finder *f, int along, int across, float *out,
                                    uint32_t *reads)
{
    const tmi_homography map = tmi_finder_map(f);
    const bool within =
        tmi_rectangle_is_within(view, &map, (float)-along, (float)-across, (float)along, (float)across);
    const float go_x = TMI_STEPS_PER_PX * f->right.x, go_y = TMI_STEPS_PER_PX * f->right.y;
    for (int v = -across; v <= across; v++) {
        const tmi_point middle = tmi_at(f, 0, (float)v);
        const float x = TMI_STEPS_PER_PX * middle.x, y = TMI_STEPS_PER_PX * middle.y;
        for (int u = -along; u <= along; u++) {
            const tmi_place at = place_at(view, x + (float)u * go_x, y + (float)u * go_y, within);
            *out++ = (float)tmi_interpolate(view, at);
        }
    }
    *reads += (uint32_t)((2 * along + 1) * (2 * across + 1));
}

void tmi_finder_score(const tmi_view *view, tmi_finder *finder, uint32_t *reads)
{
    float value[9 * 9], ring[5] = {0}, squares = 0; /* sums over the modules that many from the centre */
    sample_modules(view, finder, 4, 4, value, reads);
    for (int i = 0; i < 9 * 9; i++) {
        const int u = i % 9 - 4, v = i / 9 - 4, column = u < 0 ? -u : u, row = v < 0 ? -v : v;
        ring[row > column ? row : column] += value[i];
        squares += value[i] * value[i];
    }
    const pattern_sums sums = {33, 48, ring[0] + ring[1] + ring[3], ring[2] + ring[4], squares};
    set_score(view, &sums, finder);
}

/* How far from a guess a finder is looked for, modules; and the samples that takes. */
enum { SEEK_ALONG = 4, SEEK_ACROSS = 1, WIDE = 2 * (SEEK_ALONG + 3) + 1, HIGH = 2 * (SEEK_ACROSS + 3) + 1 };

/* Sums over 25 modules of a finder whose centre is there among the samples: of its core one, eight and sixteen of the
 * rings around. */
TMI_ONCE static pattern_sums quick_sums(const float *centre)
{
    static const int8_t few[5] = {-3, -2, 0, 2, 3};
    float light = 0, sum = 0, squares = 0;
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 5; i++) {
            const float value = centre[few[j] * WIDE + few[i]];
            sum += value;
            squares += value * value;
            if (!tmi_finder_is_dark(few[i], few[j]))
                light += value;
        }
    return (pattern_sums){17, 8, sum - light, light, squares};
}

void tmi_finder_seek(const tmi_view *view, tmi_finder *finder, uint32_t *reads)
{
    float value[WIDE * HIGH];
    sample_modules(view, finder, SEEK_ALONG + 3, SEEK_ACROSS + 3, value, reads);
    const tmi_finder guess = *finder;
    finder->score = -1;
    for (int v = -SEEK_ACROSS; v <= SEEK_ACROSS; v++)
        for (int u = -SEEK_ALONG; u <= SEEK_ALONG; u++) {
            tmi_finder tried = guess;
            tried.centre = tmi_at(&guess, (float)u, (float)v);
            const pattern_sums sums = quick_sums(&value[(HIGH / 2 + v) * WIDE + WIDE / 2 + u]);
            set_score(view, &sums, &tried);
            if (tried.score > finder->score && tried.light > tried.dark)
                *finder = tried;
        }
}

/* ---- Entrances ----------------------------------------------------------------------------------------- */

/* Modules; a fit that moved less is done. */
static const float settled = 0.09f;

/* Correlation that a square told from its outline has to have before it is fitted: well below what it needs then. */
static const float outline_score = 0.36f;

static float module_area(const tmi_finder *f)
{
    return f->right.x * f->down.y - f->right.y * f->down.x;
}

bool tmi_finder_refine(const tmi_view *view, tmi_finder *finder, uint32_t *reads)
{
    static const float span[4] = {0.5f, 0.5f, 0.4f, 0.4f};
    float moved = 1;
    for (int step = 0; step < 4 && moved > settled; step++)
        if (!fit_step(view, finder, span[step], &moved, reads) || !(module_area(finder) > 0.3f))
            return false;
    tmi_finder_score(view, finder, reads);
    return true;
}

bool tmi_finder_locate(const tmi_view *view, tmi_point start, float module_px, float contrast, tmi_finder *finder,
                       uint32_t *reads)
{
    const float step_px = real_max(0.4f, 0.25f * module_px), swing = 0.5f * contrast;
    /* Modules may be a pixel the other way: no light ring must be stepped over. */
    const float core_step_px = real_max(0.25f * step_px, real_min(1, step_px));
    tmi_point core;
    if (!centre_in_core(view, &start, core_step_px, swing, &core, reads))
        return false;
    const tmi_point step = ray_step(view, &start, step_px, swing, core, reads);
    float reach[RAYS];
    int missing = 0;
    for (int i = 0; i < RAYS && missing <= MISSING_MAX; i++) {
        const tmi_point along = {ray_direction[i].x * step.x, ray_direction[i].y * step.y};
        reach[i] = cast_ray(view, start, along, 0.2f * contrast, reads);
        missing += reach[i] == 0;
    }
    outline out;
    moments m;
    if (missing > MISSING_MAX || !close_outline(reach, &out) || !outline_moments(&out, &m))
        return false;
    square_from_moments(&m, &out, start, step, finder);
    tmi_finder_score(view, finder, reads);
    return finder->score >= outline_score && tmi_finder_refine(view, finder, reads);
}
