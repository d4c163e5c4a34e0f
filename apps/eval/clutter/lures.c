#include "lures.h"

#include <stdlib.h>

#include "random.h"
#include "tapemark.h"

enum { FINDER = TAPEMARK_HEIGHT_MODULES, PITCH = TAPEMARK_CM_PITCH_MODULES };

static int32_t floor_div(int32_t a, int32_t b)
{
    return a / b - (a % b < 0);
}

static int32_t floor_mod(int32_t a, int32_t b)
{
    return a - b * floor_div(a, b);
}

static bool is_dark_with(uint64_t bits, double share)
{
    return (double)(bits >> 11) * 0x1p-53 < share;
}

/* A number of a whole sheet, of `count`; each `which` is another one. */
static int32_t choice_of(uint64_t seed, int64_t which, int32_t count)
{
    return (int32_t)(random_at(seed, which, INT32_MIN) % (uint64_t)count);
}

/* From its top left corner; light outside. */
static bool finder_at(int32_t x, int32_t y)
{
    const int32_t ring = abs(x - FINDER / 2) > abs(y - FINDER / 2) ? abs(x - FINDER / 2) : abs(y - FINDER / 2);
    return ring < 2 || ring == FINDER / 2;
}

static bool runs(int32_t at, int32_t gap)
{
    const int32_t i = floor_mod(at, FINDER + gap);
    return i == 0 || (i >= 2 && i <= 4) || i == FINDER - 1;
}

bool carpet_lure(uint64_t seed, int32_t column, int32_t row)
{
    const bool across = runs(column, 1 + choice_of(seed, 1, 3)), down = runs(row, 1 + choice_of(seed, 2, 3));
    switch (choice_of(seed, 3, 4)) {
    case 0:
        return across;
    case 1:
        return across && down;
    case 2:
        return across || down;
    default:
        return across != down;
    }
}

bool finder_carpet_lure(uint64_t seed, int32_t column, int32_t row)
{
    const int32_t pitch_x = FINDER + 1 + choice_of(seed, 1, 6), pitch_y = FINDER + 1 + choice_of(seed, 2, 6);
    const int32_t shift = floor_div(row, pitch_y) % 2 * choice_of(seed, 3, 8);
    const int32_t x = floor_mod(column + shift, pitch_x), y = floor_mod(row, pitch_y);
    return x < FINDER && y < FINDER && finder_at(x, y);
}

/* What is between two finder patterns; each gap has its own. */
static bool filling(uint64_t seed, int64_t gap, int32_t column, int32_t row)
{
    const uint64_t bits = random_at(seed, gap, row);
    switch (random_at(seed, gap, INT32_MAX) % 6) {
    case 0:
        return false;
    case 1:
        return true;
    case 2:
        return (column ^ row) & 1;
    case 3:
        return column & 1;
    case 4:
        return is_dark_with(random_at(seed, gap, 0), 0.5);
    default:
        return is_dark_with(random_at(bits, column, row), (double)(random_at(seed, gap, 1) % 9) / 8);
    }
}

bool finder_lattice_lure(uint64_t seed, int32_t column, int32_t row)
{
    const int32_t x = floor_mod(column, PITCH), y = floor_mod(row, PITCH);
    if (x < FINDER && y < FINDER)
        return finder_at(x, y);
    const bool beside = y < FINDER && x > FINDER && x < PITCH - 1, below = x < FINDER && y > FINDER && y < PITCH - 1;
    const int64_t gap = 4 * ((int64_t)floor_div(column, PITCH) * 4096 + floor_div(row, PITCH)) + 2 * beside + 1;
    const bool crowded = choice_of(seed, 1, 2) == 1;
    if (beside || below)
        return filling(seed, gap, column, row);
    return crowded && x > FINDER && y > FINDER && random_at(seed, column, row) % 3 == 0;
}

bool qr_row_lure(uint64_t seed, int32_t column, int32_t row)
{
    const int32_t side = 21 + 4 * choice_of(seed, 1, 5);
    const int32_t gap = choice_of(seed, 2, 2) == 0 ? PITCH - FINDER : 4 + choice_of(seed, 3, 20);
    const int32_t x = floor_mod(column, side + gap), y = floor_mod(row, side + gap);
    if (x >= side || y >= side)
        return false;
    const int32_t finder_x = x <= FINDER ? x : x - (side - FINDER), finder_y = y <= FINDER ? y : y - (side - FINDER);
    const bool near_x = x <= FINDER || finder_x >= -1, near_y = y <= FINDER || finder_y >= -1;
    const bool empty_corner = x > FINDER && y > FINDER;
    if (near_x && near_y && !empty_corner)
        return finder_x >= 0 && finder_y >= 0 && finder_x < FINDER && finder_y < FINDER &&
               finder_at(finder_x, finder_y);
    if (x == FINDER - 1 || y == FINDER - 1)
        return !((x == FINDER - 1 ? y : x) & 1);
    return random_at(seed, column, row) & 1;
}

/* A row's bars, blocks and their number; a TM has four bars and blocks PITCH apart, and here not both. */
bool bar_block_lure(uint64_t seed, int32_t column, int32_t row)
{
    const int32_t row_pitch = 12 + choice_of(seed, 1, 8), line = floor_div(row, row_pitch);
    const uint64_t bits = random_at(seed, line, INT32_MIN);
    const int32_t height = 5 + (int32_t)(bits % 5), bars = 2 + (int32_t)(bits >> 8 & 3);
    const int32_t other = bars == 4 ? (int32_t)(bits >> 16 & 1) * 12 - 6 : 0, pitch = PITCH + other;
    const int32_t blocks = 3 + (int32_t)(bits >> 24 & 3), end = 2 * bars;
    const int32_t inner = blocks * pitch + FINDER, whole = 2 * end + inner + 2 + (int32_t)(bits >> 32 & 15);
    const int32_t at = floor_mod(column + (int32_t)(bits >> 40 & 63), whole);
    if (floor_mod(row, row_pitch) >= height || at >= 2 * end + inner)
        return false;
    if (at < end)
        return (at & 1) == 0;
    if (at >= end + inner)
        return (at - end - inner) & 1;
    const int32_t x = (at - end) % pitch, block = (at - end) / pitch;
    if (x < FINDER)
        return x != 1 && x != FINDER - 2;
    return x > FINDER && x < pitch - 1 && (bits >> (48 + block) & 1);
}

bool square_code_lure(uint64_t seed, int32_t column, int32_t row)
{
    const int32_t side = 6 + choice_of(seed, 1, 5), pitch = side + 1 + choice_of(seed, 2, 4);
    const int32_t x = floor_mod(column, pitch), y = floor_mod(row, pitch);
    if (x >= side || y >= side)
        return false;
    return x == 0 || y == 0 || x == side - 1 || y == side - 1 || (random_at(seed, column, row) & 1);
}

bool random_cells_lure(uint64_t seed, int32_t column, int32_t row)
{
    enum { ROW_PITCH = 11, LAST_COLUMN = TAPEMARK_CELL_COLUMNS - 1, LAST_ROW = TAPEMARK_CELL_ROWS - 1 };
    const int32_t line = floor_div(row, ROW_PITCH), y = floor_mod(row, ROW_PITCH);
    const int32_t shifted = column + choice_of(seed, line, PITCH), x = floor_mod(shifted, PITCH);
    if (y >= FINDER)
        return false;
    if (x < FINDER)
        return finder_at(x, y);
    const int32_t cell = x - FINDER - 1;
    if (cell < 0 || cell > LAST_COLUMN)
        return false;
    if (cell == 0 || y == LAST_ROW || (cell == LAST_COLUMN && y == 0))
        return true;
    if ((cell >= LAST_COLUMN - 1 && y <= 1))
        return false;
    const double least_share = 0.2, most_share = 0.8;
    const uint64_t bits = random_at(seed + 1, floor_div(shifted, PITCH), line);
    const double share = least_share + (most_share - least_share) * (double)(bits % 13) / 12;
    return is_dark_with(random_at(seed, column, row), share);
}
