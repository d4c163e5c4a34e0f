#include "tiles.h"

#include <string.h>

enum { TILE = TAPEMARK_TILE_PX };

static int32_t tiles_across(int32_t pixels)
{
    return (pixels + TILE - 1) / TILE;
}

size_t tmi_tiles_bytes(int32_t width, int32_t height)
{
    return 3 * ((size_t)tiles_across(width) + 2) * ((size_t)tiles_across(height) + 2);
}

/* Darkest and lightest pixel of each column over one row of tiles. Kept free of branches and of calls: the
 * compiler turns it into a few vector instructions, and it runs over every pixel of the frame. */
static void column_extremes(const uint8_t *restrict pixels, ptrdiff_t stride, int32_t rows, int32_t width,
                            uint8_t *restrict low, uint8_t *restrict high)
{
    memcpy(low, pixels, (size_t)width);
    memcpy(high, pixels, (size_t)width);
    for (int32_t y = 1; y < rows; y++) {
        const uint8_t *restrict line = pixels + y * stride;
        for (int32_t x = 0; x < width; x++) {
            low[x] = line[x] < low[x] ? line[x] : low[x];
            high[x] = line[x] > high[x] ? line[x] : high[x];
        }
    }
}

enum { STRIP = 32 * TILE };

static void tile_row_extremes(const tmi_view *view, int32_t tile_y, uint8_t *low, uint8_t *high)
{
    const uint8_t *pixels = view->pixels + (ptrdiff_t)tile_y * TILE * view->stride;
    const int32_t rows = view->height - tile_y * TILE < TILE ? view->height - tile_y * TILE : TILE;
    for (int32_t x0 = 0; x0 < view->width; x0 += STRIP) {
        uint8_t strip_low[STRIP], strip_high[STRIP];
        const int32_t width = view->width - x0 < STRIP ? view->width - x0 : STRIP;
        column_extremes(pixels + x0, view->stride, rows, width, strip_low, strip_high);
        for (int32_t x = 0; x < width; x += TILE) {
            const int32_t end = width - x < TILE ? width : x + TILE;
            uint8_t darkest = 255, lightest = 0;
            for (int32_t i = x; i < end; i++) {
                darkest = strip_low[i] < darkest ? strip_low[i] : darkest;
                lightest = strip_high[i] > lightest ? strip_high[i] : lightest;
            }
            low[(x0 + x) / TILE] = darkest;
            high[(x0 + x) / TILE] = lightest;
        }
    }
}

/* The contrast that leaves at most `active_max` tiles, and at least contrast_min. */
static uint8_t contrast_bar(const tmi_tiles *tiles, uint8_t contrast_min, uint32_t active_max)
{
    uint32_t histogram[256] = {0};
    for (int32_t y = 0; y < tiles->rows; y++)
        for (int32_t x = 0; x < tiles->columns; x++) {
            const ptrdiff_t i = y * tiles->pitch + x;
            histogram[tiles->high[i] - tiles->low[i]]++;
        }
    uint32_t above = 0;
    uint8_t bar = 255;
    for (int contrast = 255; contrast >= contrast_min; contrast--) {
        above += histogram[contrast];
        if (above > active_max)
            break;
        bar = (uint8_t)contrast;
    }
    return bar;
}

/* An edge has to change by a part of what light and dark differ by around it: enough to pass over noise and
 * the ripples that compression leaves, little enough for a ring one pixel wide. */
static uint8_t edge_swing(const uint8_t *low, const uint8_t *high, ptrdiff_t pitch, uint8_t bar)
{
    if (high[0] - low[0] < bar)
        return 0;
    int darkest = 255, lightest = 0;
    for (ptrdiff_t dy = -pitch; dy <= pitch; dy += pitch)
        for (ptrdiff_t i = dy - 1; i <= dy + 1; i++) {
            darkest = low[i] < darkest ? low[i] : darkest;
            lightest = high[i] > lightest ? high[i] : lightest;
        }
    const int swing = (lightest - darkest) / 6;
    return (uint8_t)(swing > 4 ? swing : 4);
}

bool tmi_tiles_build(tmi_tiles *tiles, const tmi_view *view, uint8_t contrast_min, uint32_t active_max,
                     uint8_t *memory)
{
    tiles->columns = tiles_across(view->width);
    tiles->rows = tiles_across(view->height);
    tiles->pitch = tiles->columns + 2;
    const size_t plane = tmi_tiles_bytes(view->width, view->height) / 3;
    memset(memory, 255, plane); /* the border's darkest and lightest pixel never win */
    memset(memory + plane, 0, 2 * plane);
    tiles->low = memory + tiles->pitch + 1;
    tiles->high = tiles->low + plane;
    tiles->swing = tiles->high + plane;
    for (int32_t y = 0; y < tiles->rows; y++)
        tile_row_extremes(view, y, tiles->low + y * tiles->pitch, tiles->high + y * tiles->pitch);

    const uint8_t bar = contrast_bar(tiles, contrast_min, active_max);
    tiles->active = 0;
    for (int32_t y = 0; y < tiles->rows; y++)
        for (int32_t x = 0; x < tiles->columns; x++) {
            const ptrdiff_t i = y * tiles->pitch + x;
            tiles->swing[i] = edge_swing(tiles->low + i, tiles->high + i, tiles->pitch, bar);
            tiles->active += tiles->swing[i] != 0;
        }
    return bar > contrast_min;
}
