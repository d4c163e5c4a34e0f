/*
 * draw_tape [-i] KIND FRAMES ID...
 *
 * Writes so many equal frames of 640 x 480 px with one segment of tape to standard output. KIND is pgm, y4m or a
 * layout of headerless frames, as in Y10P:640x480:832. Three ids and more make a tape marker. -i: light on dark.
 */
#include "frame.h"
#include "tapemark.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH_PX = 640, HEIGHT_PX = 480, MODULE_PX = 6, PAPER = 200, INK = 30, MOST_IDS = 3 };

static uint8_t picture[HEIGHT_PX][WIDTH_PX];

static bool draw_picture(const int32_t *ids, size_t count, bool inverted)
{
    uint8_t modules[TAPEMARK_HEIGHT_MODULES * (WIDTH_PX / MODULE_PX)];
    bool with_bars = count >= TAPEMARK_TM_MIN_CMS;
    size_t width = tapemark_segment_width_modules(count, with_bars);
    size_t left_px = (WIDTH_PX - width * MODULE_PX) / 2;
    size_t top_px = (HEIGHT_PX - TAPEMARK_HEIGHT_MODULES * MODULE_PX) / 2;
    if (tapemark_segment_draw(ids, count, with_bars, modules, sizeof modules) != TAPEMARK_OK)
        return false;
    memset(picture, inverted ? INK : PAPER, sizeof picture);
    for (size_t y = 0; y < TAPEMARK_HEIGHT_MODULES * MODULE_PX; y++)
        for (size_t x = 0; x < width * MODULE_PX; x++)
            if (modules[y / MODULE_PX * width + x / MODULE_PX])
                picture[top_px + y][left_px + x] = inverted ? PAPER : INK;
    return true;
}

static void pack_row(const pixel_format_info *info, const uint8_t *gray, uint8_t *row)
{
    for (size_t x = 0; x < WIDTH_PX; x++) {
        unsigned deep = (unsigned)gray[x] << (info->bits - 8);
        switch (info->packing) {
        case PACKING_8:
            row[x] = gray[x];
            break;
        case PACKING_16LE:
            row[2 * x] = (uint8_t)(deep & 0xff);
            row[2 * x + 1] = (uint8_t)(deep >> 8);
            break;
        case PACKING_10P:
            row[x / 4 * 5 + x % 4] = gray[x];
            break;
        case PACKING_YUYV:
            row[2 * x] = gray[x];
            break;
        case PACKING_UYVY:
            row[2 * x + 1] = gray[x];
            break;
        }
    }
}

static bool write_raw(const char *text)
{
    frame_layout layout;
    error_text error;
    if (!frame_layout_parse(text, &layout, &error) || layout.width_px != WIDTH_PX || layout.height_px != HEIGHT_PX)
        return false;
    size_t size = frame_layout_size_bytes(&layout);
    uint8_t *bytes = malloc(size);
    if (bytes == NULL)
        return false;
    /* Gray chroma, and padding that would show. */
    memset(bytes, 128, size);
    for (size_t y = 0; y < HEIGHT_PX; y++)
        pack_row(pixel_format_describe(layout.format), picture[y], bytes + y * layout.stride_bytes);
    bool written = fwrite(bytes, 1, size, stdout) == size;
    free(bytes);
    return written;
}

static bool write_frame(const char *kind, int number)
{
    if (strcmp(kind, "pgm") == 0)
        printf("P5\n%d %d\n255\n", WIDTH_PX, HEIGHT_PX);
    else if (strcmp(kind, "y4m") == 0)
        printf("%sFRAME\n", number == 0 ? "YUV4MPEG2 W640 H480 F25:1 Ip A1:1 Cmono\n" : "");
    else
        return write_raw(kind);
    return fwrite(picture, 1, sizeof picture, stdout) == sizeof picture;
}

int main(int argc, char *argv[])
{
    int32_t ids[MOST_IDS];
    size_t count = 0;
    bool inverted = argc > 1 && strcmp(argv[1], "-i") == 0;
    argv += inverted;
    argc -= inverted;
    for (int i = 3; i < argc && count < MOST_IDS; i++)
        ids[count++] = (int32_t)strtol(argv[i], NULL, 10);
    bool done = count > 0 && draw_picture(ids, count, inverted);
    for (int i = 0; done && i < atoi(argv[2]); i++)
        done = write_frame(argv[1], i);
    if (!done || fflush(stdout) != 0) {
        fprintf(stderr, "usage: draw_tape [-i] pgm|y4m|LAYOUT FRAMES ID...\n");
        return 1;
    }
    return 0;
}
