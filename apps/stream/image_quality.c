#include "image_quality.h"

enum { GRAY_LEVELS = 256, PERCENT = 100 };

/* Pixels are looked at in blocks this far apart, of a middle row and a middle column each. */
enum { BLOCK_STEP_PX = 16, LINE_PX = 17 };

/* An edge lower than that may be noise or shade. */
enum { EDGE_LEVELS = 32, EDGES_MIN = 8 };

typedef struct sample {
    uint32_t levels[GRAY_LEVELS];
    uint32_t pixels;
    uint32_t edges_along_x[PERCENT + 1];  /* by their sharpness */
    uint32_t edges_along_y[PERCENT + 1];
} sample;

static void add_line(sample *drawn, const uint8_t *pixels, ptrdiff_t step, uint32_t edges[PERCENT + 1])
{
    int least = GRAY_LEVELS, most = -1, steepest = 0;
    for (int i = 0; i < LINE_PX; i++) {
        int level = pixels[i * step];
        drawn->levels[level]++;
        least = level < least ? level : least;
        most = level > most ? level : most;
        int rise = i >= 2 ? level - pixels[(i - 2) * step] : 0;
        rise = rise < 0 ? -rise : rise;
        steepest = rise > steepest ? rise : steepest;
    }
    drawn->pixels += LINE_PX;
    if (most - least >= EDGE_LEVELS)
        edges[steepest * PERCENT / (most - least)]++;
}

static uint8_t light_of(const sample *drawn)
{
    uint32_t lighter = 0;
    int level = GRAY_LEVELS - 1;
    while (drawn->pixels > 0 && level > 0 && (lighter + drawn->levels[level]) * PERCENT <= drawn->pixels)
        lighter += drawn->levels[level--];
    return (uint8_t)level;
}

static uint8_t saturation_of(const sample *drawn)
{
    const int nearly_white = 252;
    uint32_t white = 0;
    for (int level = nearly_white; level < GRAY_LEVELS; level++)
        white += drawn->levels[level];
    return (uint8_t)(drawn->pixels > 0 ? (uint64_t)white * PERCENT / drawn->pixels : 0);
}

static uint8_t sharpness_of(const uint32_t edges[PERCENT + 1])
{
    uint32_t count = 0, sharper = 0;
    for (int i = 0; i <= PERCENT; i++)
        count += edges[i];
    if (count < EDGES_MIN)
        return SHARPNESS_UNKNOWN;
    int sharpness = PERCENT;
    while (sharpness > 0 && (sharper + edges[sharpness]) * 10 <= count)
        sharper += edges[sharpness--];
    return (uint8_t)sharpness;
}

image_quality image_quality_measure(const gray_view *view)
{
    sample drawn = {0};
    const int32_t middle = LINE_PX / 2;
    for (int32_t y = 0; y + LINE_PX <= view->height_px; y += BLOCK_STEP_PX) {
        for (int32_t x = 0; x + LINE_PX <= view->width_px; x += BLOCK_STEP_PX) {
            const uint8_t *block = view->pixels + y * view->stride_bytes + x;
            add_line(&drawn, block + middle * view->stride_bytes, 1, drawn.edges_along_x);
            add_line(&drawn, block + middle, view->stride_bytes, drawn.edges_along_y);
        }
    }
    return (image_quality){light_of(&drawn), saturation_of(&drawn), sharpness_of(drawn.edges_along_x),
                           sharpness_of(drawn.edges_along_y)};
}

bool image_quality_too_dark(const image_quality *quality)
{
    return quality->light < 40;
}

bool image_quality_too_bright(const image_quality *quality)
{
    return quality->saturated_percent >= 33;
}

bool image_quality_blurred(const image_quality *quality)
{
    const uint8_t sharp = 40;
    return quality->sharpness_along_x < sharp || quality->sharpness_along_y < sharp;
}
