#include "tiles.h"

#include "real.h"

#include <string.h>

enum { TILE = TAPEMARK_TILE_PX };

static int32_t tiles_across(int32_t pixels)
{
    return (pixels + TILE - 1) / TILE;
}

/* Every other row is read: the first pass runs over the whole frame, and what it must not miss, a finder pattern,
 * is seven rows high at least. */
enum { ROW_STEP = 2, ROWS_READ = TILE / ROW_STEP, STRIP = 32 * TILE };

static inline uint8_t lesser(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

static inline uint8_t greater(uint8_t a, uint8_t b)
{
    return a > b ? a : b;
}

/* Darkest pixel of each column over one row of tiles, and what the lightest one lacks to white, so that the least of
 * either counts. The eight rows are spelled out so that each vector of columns is loaded once and stored once; where
 * the image cuts the tiles off, the last row that there is stands for those that are missing. */
static void column_extremes(const uint8_t *restrict p, ptrdiff_t stride, int32_t rows, int32_t width,
                            uint8_t *restrict low, uint8_t *restrict lack)
{
    _Static_assert(ROWS_READ == 8, "eight rows are spelled out below");
    ptrdiff_t at[ROWS_READ];
    for (int32_t i = 0; i < ROWS_READ; i++)
        at[i] = ROW_STEP * stride * (ROW_STEP * i < rows ? i : (rows - 1) / ROW_STEP);
    const uint8_t *p0 = p, *p1 = p + at[1], *p2 = p + at[2], *p3 = p + at[3];
    const uint8_t *p4 = p + at[4], *p5 = p + at[5], *p6 = p + at[6], *p7 = p + at[7];
    for (int32_t x = 0; x < width; x++) {
        const uint8_t a = p0[x], b = p1[x], c = p2[x], d = p3[x], e = p4[x], f = p5[x], g = p6[x], h = p7[x];
        low[x] = lesser(lesser(lesser(a, b), lesser(c, d)), lesser(lesser(e, f), lesser(g, h)));
        lack[x] = (uint8_t)~greater(greater(greater(a, b), greater(c, d)), greater(greater(e, f), greater(g, h)));
    }
}

/* Joins values two by two. */
TMI_ONCE static void join_pairs(const uint8_t *restrict from, int32_t pairs, uint8_t *restrict to)
{
    for (int32_t i = 0; i < pairs; i++)
        to[i] = lesser(from[2 * i], from[2 * i + 1]);
}

/* Joins the columns of each tile, the last of which may be cut off. */
static void join_tiles(uint8_t columns[STRIP + TILE], int32_t width, uint8_t *joined)
{
    _Static_assert(TILE == 16, "sixteen columns become one in four steps");
    uint8_t half[STRIP / 2];
    const int32_t tiles = tiles_across(width);
    memset(columns + width, 255, TILE);
    join_pairs(columns, 8 * tiles, half);
    join_pairs(half, 4 * tiles, columns);
    join_pairs(columns, 2 * tiles, half);
    join_pairs(half, tiles, joined);
}

static void tile_row_extremes(const tmi_view *view, int32_t tile_y, uint8_t *low, uint8_t *high)
{
    const uint8_t *pixels = view->pixels + (ptrdiff_t)tile_y * TILE * view->stride;
    const int32_t rows = view->height - tile_y * TILE;
    for (int32_t x0 = 0; x0 < view->width; x0 += STRIP) {
        uint8_t strip_low[STRIP + TILE], strip_lack[STRIP + TILE];
        const int32_t width = view->width - x0 < STRIP ? view->width - x0 : STRIP;
        column_extremes(pixels + x0, view->stride, rows, width, strip_low, strip_lack);
        join_tiles(strip_low, width, low + x0 / TILE);
        join_tiles(strip_lack, width, high + x0 / TILE);
    }
    for (int32_t x = 0; x < tiles_across(view->width); x++)
        high[x] = (uint8_t)~high[x];
}

/* A tile has to have this part, in percent, of the contrast of the one with most: sensor noise grows with the light
 * as contrast does, and it is everywhere. */
enum { BAR_PERCENT = 8 };

static void usual_bar(tmi_tiles *tiles, uint8_t contrast_min)
{
    uint8_t most = 0, lightest = 1;
    for (int32_t y = 0; y < tiles->rows; y++)
        for (ptrdiff_t i = y * tiles->pitch; i < y * tiles->pitch + tiles->columns; i++) {
            most = greater(most, (uint8_t)(tiles->high[i] - tiles->low[i]));
            lightest = greater(lightest, tiles->high[i]);
        }
    const int bar = most * BAR_PERCENT / 100;
    tiles->contrast_min = contrast_min;
    tiles->bar = (uint8_t)(bar > contrast_min ? bar : contrast_min);
    tiles->lightest = lightest;
}

/* What a quarter of the tiles have at most is the contrast of noise: the extremes of 128 pixels are some five times
 * its standard deviation apart, seldom eight, and what differs by less than that cannot be read in it. In dim light,
 * where everything has texture, that may be a tape's contrast: no more than CALM_MAX is taken for noise's. */
static const float noise_part = 1.6f;
enum { CALM_MAX = 16 };

TMI_ONCE uint8_t tmi_tiles_noise(const tmi_tiles *tiles)
{
    uint32_t histogram[256] = {0}, calm = 0;
    for (int32_t y = 0; y < tiles->rows; y++)
        for (ptrdiff_t i = y * tiles->pitch; i < y * tiles->pitch + tiles->columns; i++)
            histogram[tiles->high[i] - tiles->low[i]]++;
    int contrast = 0;
    while (contrast < CALM_MAX && 4 * (calm += histogram[contrast]) < (uint32_t)(tiles->rows * tiles->columns))
        contrast++;
    return (uint8_t)(noise_part * (float)contrast);
}

/* The contrast from which tiles are scanned where those of at least `least` are many more than `active_max`; 0 where
 * they are not. */
TMI_ONCE static int raised_bar(const tmi_tiles *tiles, int least, uint32_t active_max)
{
    uint32_t histogram[256] = {0}, above = 0;
    for (int32_t y = 0; y < tiles->rows; y++)
        for (ptrdiff_t i = y * tiles->pitch; i < y * tiles->pitch + tiles->columns; i++) {
            const int contrast = tiles->high[i] - tiles->low[i];
            if (contrast >= least && tmi_is_contrast(tiles, i, contrast))
                histogram[contrast]++;
        }
    int bar = 256;
    while (bar > 0) {
        const uint32_t next = histogram[bar - 1];
        /* Tiles of equal contrast go in together or not at all; without them there may be next to nothing. */
        if (above + next > active_max && above > active_max / 2)
            break;
        above += next;
        bar--;
    }
    return bar;
}

/* An edge has to change by a part of what light and dark differ by around it: enough to pass over noise and
 * the ripples that compression leaves, little enough for a ring one pixel wide. */
static uint8_t edge_swing(const uint8_t *low, const uint8_t *high, ptrdiff_t pitch)
{
    int darkest = 255, lightest = 0;
    for (ptrdiff_t dy = -pitch; dy <= pitch; dy += pitch)
        for (ptrdiff_t i = dy - 1; i <= dy + 1; i++) {
            darkest = low[i] < darkest ? low[i] : darkest;
            lightest = high[i] > lightest ? high[i] : lightest;
        }
    const int swing = (lightest - darkest) / 6;
    return (uint8_t)(swing > 2 ? swing : 2);
}

static void lay_out(tmi_tiles *tiles, const tmi_view *view, void *memory)
{
    tiles->columns = tiles_across(view->width);
    tiles->rows = tiles_across(view->height);
    tiles->pitch = tiles->columns + 2;
    tiles->row_words = (tiles->columns + 31) / 32;
    tiles->column_words = (tiles->rows + 31) / 32;
    const size_t bit_words =
        (size_t)tiles->rows * (size_t)tiles->row_words + (size_t)tiles->columns * (size_t)tiles->column_words;
    const size_t plane = (size_t)tiles->pitch * ((size_t)tiles->rows + 2);
    tiles->row_bits = memory;
    tiles->column_bits = tiles->row_bits + (size_t)tiles->rows * (size_t)tiles->row_words;
    uint8_t *planes = (uint8_t *)(tiles->row_bits + bit_words);
    memset(memory, 0, bit_words * sizeof(uint32_t));
    memset(planes, 255, plane); /* the border's darkest and lightest pixel never win */
    memset(planes + plane, 0, 2 * plane);
    tiles->low = planes + tiles->pitch + 1;
    tiles->high = tiles->low + plane;
    tiles->swing = tiles->high + plane;
}

bool tmi_tiles_build(tmi_tiles *tiles, const tmi_view *view, uint8_t contrast_min, uint32_t active_max, void *memory)
{
    lay_out(tiles, view, memory);
    for (int32_t y = 0; y < tiles->rows; y++)
        tile_row_extremes(view, y, tiles->low + y * tiles->pitch, tiles->high + y * tiles->pitch);

    usual_bar(tiles, contrast_min);
    const bool many = raised_bar(tiles, 0, active_max / 2) > 0;
    const int noise = many ? tmi_tiles_noise(tiles) : 0;
    const int raised = many ? raised_bar(tiles, noise, active_max) : 0;
    const int least = raised > noise ? raised : noise;
    tiles->active = 0;
    for (int32_t y = 0; y < tiles->rows; y++) {
        const uint8_t *low = tiles->low + y * tiles->pitch, *high = tiles->high + y * tiles->pitch;
        for (int32_t x = 0; x < tiles->columns; x++) {
            const int contrast = high[x] - low[x];
            if (contrast < least || !tmi_is_contrast(tiles, y * tiles->pitch + x, contrast))
                continue;
            tiles->swing[y * tiles->pitch + x] = edge_swing(low + x, high + x, tiles->pitch);
            tiles->active++;
            tiles->row_bits[y * tiles->row_words + x / 32] |= 1u << (x % 32);
            tiles->column_bits[x * tiles->column_words + y / 32] |= 1u << (y % 32);
        }
    }
    return raised > 0;
}
