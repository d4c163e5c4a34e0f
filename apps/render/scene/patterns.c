#include "patterns.h"

#include <stdlib.h>

#include "random.h"

static int32_t floor_div(int32_t a, int32_t b)
{
    return a / b - (a % b < 0);
}

static int32_t floor_mod(int32_t a, int32_t b)
{
    return a - b * floor_div(a, b);
}

static bool random_module(uint64_t seed, int32_t column, int32_t row, double share_dark)
{
    return (double)(random_at(seed, column, row) >> 11) * 0x1p-53 < share_dark;
}

/* A finder pattern around (0, 0); light outside. */
static bool finder_pattern(int32_t column, int32_t row)
{
    int32_t ring = abs(column) > abs(row) ? abs(column) : abs(row);
    return ring < 2 || ring == 3;
}

static bool blinds(uint64_t seed, int32_t column, int32_t row)
{
    (void)seed, (void)row;
    return column & 1;
}

static bool checkerboard(uint64_t seed, int32_t column, int32_t row)
{
    (void)seed;
    return (column ^ row) & 1;
}

static bool stripes(uint64_t seed, int32_t column, int32_t row)
{
    enum { ROW_MODULES = 18, BAR_MODULES = 15 };
    return floor_mod(row, ROW_MODULES) < BAR_MODULES &&
           random_module(seed, column, floor_div(row, ROW_MODULES), 0.5);
}

static bool text(uint64_t seed, int32_t column, int32_t row)
{
    enum { GLYPH_COLUMNS = 5, GLYPH_ROWS = 7, GLYPH_PITCH = 6, LINE_PITCH = 10, GLYPHS = 16, BLANKS = 3 };
    static const uint8_t glyphs[GLYPHS][GLYPH_ROWS] = {
        {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}, {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11},
        {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}, {0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11},
        {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e}, {0x1e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1e},
        {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}, {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f},
        {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}, {0x11, 0x19, 0x15, 0x13, 0x11, 0x11, 0x11},
        {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11}, {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e},
        {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04}, {0x00, 0x00, 0x1f, 0x00, 0x1f, 0x00, 0x00},
        {0x0e, 0x08, 0x08, 0x08, 0x08, 0x08, 0x0e}, {0x0e, 0x11, 0x11, 0x15, 0x11, 0x11, 0x0e},
    };
    int32_t x = floor_mod(column, GLYPH_PITCH), y = floor_mod(row, LINE_PITCH);
    uint64_t glyph = random_at(seed, floor_div(column, GLYPH_PITCH), floor_div(row, LINE_PITCH)) % (GLYPHS + BLANKS);
    return x < GLYPH_COLUMNS && y < GLYPH_ROWS && glyph < GLYPHS && glyphs[glyph][y] >> (GLYPH_COLUMNS - 1 - x) & 1;
}

/* Every other set of rings is a finder pattern, the rest are anything. */
static bool squares(uint64_t seed, int32_t column, int32_t row)
{
    enum { PITCH = 13, RINGS = 6 };
    uint64_t bits = random_at(seed, floor_div(column, PITCH), floor_div(row, PITCH));
    int32_t x = floor_mod(column, PITCH) - RINGS, y = floor_mod(row, PITCH) - RINGS;
    int32_t ring = abs(x) > abs(y) ? abs(x) : abs(y);
    if (bits & 1)
        return finder_pattern(x, y);
    return ring < RINGS && bits >> (ring + 1) & 1;
}

static bool grid_codes(uint64_t seed, int32_t column, int32_t row)
{
    enum { SIDE = 25, PITCH = 30, FINDER = 7 };
    int32_t x = floor_mod(column, PITCH), y = floor_mod(row, PITCH);
    if (x >= SIDE || y >= SIDE)
        return false;
    bool near_right = x >= SIDE - FINDER - 1, near_bottom = y >= SIDE - FINDER - 1;
    bool left = x <= FINDER, top = y <= FINDER;
    if ((left && top) || (left && near_bottom) || (near_right && top))
        return finder_pattern(left ? x - 3 : x - (SIDE - 4), top ? y - 3 : y - (SIDE - 4));
    return random_module(seed, column, row, 0.5);
}

/* Each CM's place has cells of its own density, from nearly light to nearly dark. */
static bool finder_rows(uint64_t seed, int32_t column, int32_t row)
{
    enum { ROW_PITCH = 12, FINDER = 7 };
    int32_t line = floor_div(row, ROW_PITCH), y = floor_mod(row, ROW_PITCH);
    if (y >= TAPEMARK_HEIGHT_MODULES)
        return false;
    int32_t shifted = column + (int32_t)(random_at(seed, -1, line) % TAPEMARK_CM_PITCH_MODULES);
    int32_t x = floor_mod(shifted, TAPEMARK_CM_PITCH_MODULES);
    if (x <= FINDER || x == TAPEMARK_CM_PITCH_MODULES - 1)
        return x < FINDER && finder_pattern(x - 3, y - 3);
    double density = (double)(random_at(seed + 1, floor_div(shifted, TAPEMARK_CM_PITCH_MODULES), line) % 16) / 15;
    return random_module(seed, column, row, density);
}

static module_pattern *const patterns[SCENE_CLUTTER_COUNT] = {
    [SCENE_BLINDS] = blinds,         [SCENE_CHECKERBOARD] = checkerboard, [SCENE_STRIPES] = stripes,
    [SCENE_TEXT] = text,             [SCENE_SQUARES] = squares,           [SCENE_GRID_CODES] = grid_codes,
    [SCENE_FINDER_ROWS] = finder_rows,
};

module_pattern *module_pattern_of(scene_clutter kind)
{
    return kind >= 0 && kind < SCENE_CLUTTER_COUNT ? patterns[kind] : NULL;
}
