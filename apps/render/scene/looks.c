#include "looks.h"

#include <math.h>

#include "patterns.h"
#include "random.h"
#include "sensor.h"

/* ---- Means over a patch -------------------------------------------------------------------------------- */

/* How much of [0, x] is in the first `width` of each period. */
static double striped_length(double x, double period, double width)
{
    double whole = floor(x / period);
    double into = x - whole * period;
    return whole * width + (into < width ? into : width);
}

/* Share of stripes, the first `width` of each period, in what reaches half of `reach` to both sides of x. */
static double stripes_share(double x, double reach, double period, double width)
{
    double half = reach > 1e-9 ? reach / 2 : 1e-9, into = x - floor(x / period) * period;
    if (into - half > width && into + half < period)
        return 0;
    return (striped_length(x + half, period, width) - striped_length(x - half, period, width)) / (2 * half);
}

/* How much of a detail of this size is left of it when it is seen over this reach. */
static double kept(double size, double reach)
{
    double ratio = reach / size;
    return 1 / (1 + ratio * ratio);
}

/* -1 to 1. */
static double random_tone(uint64_t seed, int64_t x, int64_t y)
{
    return (double)(random_at(seed, x, y) >> 11) * 0x1p-52 - 1;
}

static double smooth_step(double x)
{
    return x * x * (3 - 2 * x);
}

/* Smooth noise from -1 to 1 with details of size 1, which repeats after NOISE_SIDE of them. Layers begin at different
 * places of it. */
static double smooth_noise(const noise_table *noise, uint64_t layer, double x, double y)
{
    enum { MASK = NOISE_SIDE - 1 };
    double left = floor(x), top = floor(y), u = smooth_step(x - left), v = smooth_step(y - top);
    uint64_t start = layer * UINT64_C(0x9e3779b97f4a7c15);
    uint64_t column = (uint64_t)(int64_t)left + (start >> 40), row = (uint64_t)(int64_t)top + (start >> 52);
    const float *above = noise->tones[row & MASK], *below = noise->tones[(row + 1) & MASK];
    double upper = (1 - u) * (double)above[column & MASK] + u * (double)above[(column + 1) & MASK];
    double lower = (1 - u) * (double)below[column & MASK] + u * (double)below[(column + 1) & MASK];
    return (1 - v) * upper + v * lower;
}

static double noise_on(const panel_look *look, const patch *seen, uint64_t layer, double along_m, double across_m)
{
    const double a = seen->reach_along_m * across_m, b = seen->reach_across_m * along_m, size = along_m * across_m;
    const double faded = (size * size + a * a) * (size * size + b * b), unfaded = size * size * size * size;
    if (unfaded < 0.05 * faded)
        return 0;
    return unfaded / faded *
           smooth_noise(look->noise, look->seed + layer, seen->along_m / along_m, seen->across_m / across_m);
}

static double mixed(double share_dark, double light, double dark)
{
    return light + share_dark * (dark - light);
}

/* ---- Looks --------------------------------------------------------------------------------------------- */

static double paint(const panel_look *look, const patch *seen)
{
    double tone = 0.04 * noise_on(look, seen, 0, 1.3, 0.9) + 0.015 * noise_on(look, seen, 1, 0.004, 0.004);
    return look->light * (1 + tone);
}

static double tiles(const panel_look *look, const patch *seen)
{
    const double joint_m = 0.004, side_m = look->panel->scale_m;
    double columns = stripes_share(seen->along_m, seen->reach_along_m, side_m, joint_m);
    double rows = stripes_share(seen->across_m, seen->reach_across_m, side_m, joint_m);
    double tone = random_tone(look->seed, (int64_t)floor(seen->along_m / side_m),
                              (int64_t)floor(seen->across_m / side_m));
    tone *= kept(side_m, seen->reach_along_m) * kept(side_m, seen->reach_across_m);
    double tile = look->light * (1 + 0.03 * tone + 0.03 * noise_on(look, seen, 0, 0.05, 0.03));
    return mixed(1 - (1 - columns) * (1 - rows), tile, look->dark);
}

static double bricks(const panel_look *look, const patch *seen)
{
    const double row_m = look->panel->scale_m, brick_m = 3 * row_m, joint_m = 0.12 * row_m;
    int64_t row = (int64_t)floor(seen->across_m / row_m);
    double along_m = seen->along_m + (row & 1 ? 0.5 * brick_m : 0);
    double upright = stripes_share(along_m, seen->reach_along_m, brick_m, joint_m);
    double level = stripes_share(seen->across_m, seen->reach_across_m, row_m, joint_m);
    double tone = random_tone(look->seed, (int64_t)floor(along_m / brick_m), row) * kept(row_m, seen->reach_across_m);
    double brick = look->light * (1 + 0.12 * tone + 0.08 * noise_on(look, seen, 0, 0.01, 0.01));
    return mixed(1 - (1 - upright) * (1 - level), brick, look->dark);
}

static double wood(const panel_look *look, const patch *seen)
{
    const double board_m = look->panel->scale_m, joint_m = 0.0025, length_m = 1.2;
    int64_t board = (int64_t)floor(seen->across_m / board_m);
    double along_m = seen->along_m + length_m * (0.5 + 0.5 * random_tone(look->seed, board, -1));
    double between = stripes_share(seen->across_m, seen->reach_across_m, board_m, joint_m);
    double ends = stripes_share(along_m, seen->reach_along_m, length_m, joint_m);
    double tone = random_tone(look->seed, (int64_t)floor(along_m / length_m), board) *
                  kept(board_m, seen->reach_across_m);
    double grain = 0.5 + 0.5 * noise_on(look, seen, (uint64_t)board, 0.3, 0.005);
    double plank = mixed(0.35 * grain, look->light, look->dark) * (1 + 0.08 * tone);
    return mixed(1 - (1 - between) * (1 - ends), plank, 0.6 * look->dark);
}

static double stone(const panel_look *look, const patch *seen)
{
    const double size_m = look->panel->scale_m;
    double share = 0.4 + 0.25 * noise_on(look, seen, 0, 8 * size_m, 8 * size_m) +
                   0.35 * noise_on(look, seen, 1, size_m, size_m);
    return mixed(fmin(fmax(share, 0), 1), look->light, look->dark);
}

/* Modules by points, as many as it takes to miss none that is in the patch; beyond that, all modules alike. */
static double pattern(const panel_look *look, const patch *seen)
{
    enum { POINTS_MAX = 6 };
    module_pattern *dark_at = module_pattern_of(look->panel->pattern);
    double scale_m = look->panel->scale_m;
    double columns = seen->reach_along_m / scale_m, rows = seen->reach_across_m / scale_m;
    if (columns > POINTS_MAX || rows > POINTS_MAX)
        return mixed(look->pattern_share, look->light, look->dark);
    int across = 2 + (int)fmin(2 * rows, POINTS_MAX), along = 2 + (int)fmin(2 * columns, POINTS_MAX), dark = 0;
    for (int i = 0; i < along * across; i++) {
        double u = seen->along_m / scale_m + columns * ((i % along + 0.5) / along - 0.5);
        double v = seen->across_m / scale_m + rows * ((i / along + 0.5) / across - 0.5);
        dark += dark_at(look->seed, (int32_t)floor(u), (int32_t)floor(v));
    }
    return mixed((double)dark / (along * across), look->light, look->dark);
}

static double shadow(const panel_look *look, const patch *seen)
{
    double depth = fmin(fmax(seen->across_m / look->panel->height_m, 0), 1);
    double darkest = look->light > 0 ? fmin(look->dark / look->light, 1) : 0;
    return mixed((1 - depth) * (1 - depth), 1, darkest);
}

double look_at(const panel_look *look, const patch *seen)
{
    switch (look->panel->look) {
    case SCENE_LOOK_TILES: return tiles(look, seen);
    case SCENE_LOOK_BRICKS: return bricks(look, seen);
    case SCENE_LOOK_WOOD: return wood(look, seen);
    case SCENE_LOOK_STONE: return stone(look, seen);
    case SCENE_LOOK_PATTERN: return pattern(look, seen);
    case SCENE_LOOK_SHADOW: return shadow(look, seen);
    default: return paint(look, seen);
    }
}

static double share_of_dark_modules(module_pattern *dark_at, uint64_t seed)
{
    enum { SIDE = 96 };
    int dark = 0;
    for (int32_t i = 0; i < SIDE * SIDE; i++)
        dark += dark_at(seed, i % SIDE, i / SIDE);
    return (double)dark / (SIDE * SIDE);
}

void fill_noise_table(uint64_t seed, noise_table *noise)
{
    for (int32_t i = 0; i < NOISE_SIDE * NOISE_SIDE; i++)
        noise->tones[i / NOISE_SIDE][i % NOISE_SIDE] = (float)random_tone(seed, i % NOISE_SIDE, i / NOISE_SIDE);
}

panel_look panel_look_of(const scene *view, const noise_table *noise, size_t panel_index)
{
    const scene_panel *panel = &view->panels[panel_index];
    panel_look look = {panel, random_at(view->seed, 0x70616e656c, (int64_t)panel_index),
                       light_of_shade(panel->light, view->sensor.gamma),
                       light_of_shade(panel->dark, view->sensor.gamma), 0, noise};
    if (panel->look == SCENE_LOOK_PATTERN)
        look.pattern_share = share_of_dark_modules(module_pattern_of(panel->pattern), look.seed);
    return look;
}
