#include "picture.h"

#include <stdlib.h>
#include <string.h>

#include "tapemark.h"

enum { NUMBER_BITS = 24, BLOCK_PX = 8, DARK = 50, LIGHT = 190 };

static const uint32_t number_mask = (1u << NUMBER_BITS) - 1;

picture_segment picture_tape(int32_t width_px, int32_t height_px, uint32_t number)
{
    /* Codes that read differently from either end, each a light CM a bit. */
    static const unsigned codes[PICTURE_KINDS] = {0xd, 0x1, 0xc, 0x7};
    int32_t kind = (int32_t)(number % PICTURE_KINDS);
    picture_segment tape = {.cm_count = PICTURE_CMS, .bars = true,
                            .left_px = (28 + 30 * kind) * width_px / 640, .top_px = height_px / 3 + 20 * kind};
    for (int32_t i = 0; i < PICTURE_CMS; i++)
        tape.ids[i] = (100 * kind + i + 1) * (codes[kind] >> (PICTURE_CMS - 1 - i) & 1 ? 1 : -1);
    return tape;
}

picture_segment picture_number_tape(int32_t width_px, uint32_t number)
{
    int32_t kind = (int32_t)(number % PICTURE_KINDS);
    return (picture_segment){.ids = {PICTURE_NUMBER_ID + (int32_t)(number & number_mask)}, .cm_count = 1,
                             .left_px = width_px - 150 - 20 * kind, .top_px = 44};
}

/* A wall that gets lighter to the right, with grain in it. */
static void draw_wall(uint8_t *pixels, int32_t width_px, int32_t height_px, uint32_t seed)
{
    for (int32_t y = 0; y < height_px; y++)
        for (int32_t x = 0; x < width_px; x++) {
            seed = seed * 1664525u + 1013904223u;
            pixels[(size_t)y * (size_t)width_px + (size_t)x] = (uint8_t)(120 + 60 * x / width_px + (int)(seed >> 29));
        }
}

/* With a light margin of two modules. */
static void draw_segment(uint8_t *pixels, int32_t width_px, const picture_segment *segment)
{
    enum { MARGIN = 2, WIDTH_MAX_MODULES = 200 };
    uint8_t modules[TAPEMARK_HEIGHT_MODULES * WIDTH_MAX_MODULES];
    size_t width_modules = tapemark_segment_width_modules(segment->cm_count, segment->bars);
    tapemark_segment_draw(segment->ids, segment->cm_count, segment->bars, modules, sizeof modules);
    size_t left_px = (size_t)segment->left_px - MARGIN * PICTURE_MODULE_PX;
    size_t top_px = (size_t)segment->top_px - MARGIN * PICTURE_MODULE_PX;
    for (size_t y = 0; y < (TAPEMARK_HEIGHT_MODULES + 2 * MARGIN) * PICTURE_MODULE_PX; y++)
        for (size_t x = 0; x < (width_modules + 2 * MARGIN) * PICTURE_MODULE_PX; x++) {
            size_t column = x / PICTURE_MODULE_PX - MARGIN, row = y / PICTURE_MODULE_PX - MARGIN;
            bool printed = column < width_modules && row < TAPEMARK_HEIGHT_MODULES;
            bool dark = printed && modules[row * width_modules + column] != 0;
            pixels[(top_px + y) * (size_t)width_px + left_px + x] = dark ? DARK : LIGHT;
        }
}

void picture_set_number(uint8_t *pixels, int32_t width_px, uint32_t number)
{
    for (size_t y = 0; y < 3 * BLOCK_PX; y++)
        for (size_t x = 0; x < NUMBER_BITS * BLOCK_PX; x++)
            pixels[y * (size_t)width_px + x] = number >> (x / BLOCK_PX) & 1 ? LIGHT : DARK;
    picture_segment in_words = picture_number_tape(width_px, number);
    draw_segment(pixels, width_px, &in_words);
}

void picture_draw(uint8_t *pixels, int32_t width_px, int32_t height_px, uint32_t number)
{
    picture_segment tape = picture_tape(width_px, height_px, number);
    draw_wall(pixels, width_px, height_px, number % PICTURE_KINDS + 1);
    draw_segment(pixels, width_px, &tape);
    picture_set_number(pixels, width_px, number);
}

uint8_t *picture_draw_kinds(int32_t width_px, int32_t height_px)
{
    size_t pixels = (size_t)width_px * (size_t)height_px;
    uint8_t *kinds = malloc(PICTURE_KINDS * pixels);
    for (uint32_t kind = 0; kinds != NULL && kind < PICTURE_KINDS; kind++)
        picture_draw(kinds + kind * pixels, width_px, height_px, kind);
    return kinds;
}

uint8_t *picture_of_number(uint8_t *kinds, int32_t width_px, int32_t height_px, uint32_t number)
{
    uint8_t *picture = kinds + number % PICTURE_KINDS * (size_t)width_px * (size_t)height_px;
    picture_set_number(picture, width_px, number);
    return picture;
}

bool picture_number(const uint8_t *pixels, ptrdiff_t stride_bytes, uint32_t *number)
{
    uint32_t copies[3] = {0};
    for (int copy = 0; copy < 3; copy++)
        for (int bit = 0; bit < NUMBER_BITS; bit++) {
            uint8_t level = pixels[(copy * BLOCK_PX + BLOCK_PX / 2) * stride_bytes + bit * BLOCK_PX + BLOCK_PX / 2];
            copies[copy] |= (uint32_t)(level > (DARK + LIGHT) / 2) << bit;
        }
    *number = copies[0] & number_mask;
    return copies[0] == copies[1] && copies[1] == copies[2];
}

/* Bytes that luma is not are as of a gray picture, or of none: nobody looks at them. */
void picture_encode(const uint8_t *pixels, const frame_layout *layout, uint8_t *bytes)
{
    const pixel_format_info *info = pixel_format_describe(layout->format);
    size_t width = (size_t)layout->width_px;
    memset(bytes, 128, frame_layout_size_bytes(layout));
    for (size_t y = 0; y < (size_t)layout->height_px; y++) {
        const uint8_t *from = pixels + y * width;
        uint8_t *row = bytes + y * layout->stride_bytes;
        for (size_t x = 0; x < width; x++) {
            if (info->packing == PACKING_8) {
                row[x] = from[x];
            } else if (info->packing == PACKING_YUYV) {
                row[2 * x] = from[x];
            } else if (info->packing == PACKING_16LE) {
                unsigned sample = (unsigned)from[x] << (info->bits - 8);
                row[2 * x] = (uint8_t)(sample & 0xff);
                row[2 * x + 1] = (uint8_t)(sample >> 8);
            }
        }
    }
}
