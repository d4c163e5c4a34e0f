#include "capture.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "opencv_media.h"

static const capture_format formats[] = {
    {.name = "PGM", .container = CAPTURE_PGM},
    {.name = "PNG", .container = CAPTURE_PNG},
    {.name = "Y4M", .container = CAPTURE_Y4M},
    {.name = "GREY"},
    {.name = "Y10", .packing = CAPTURE_16LE},
    {.name = "Y10P", .packing = CAPTURE_10P},
    {.name = "YUYV", .packing = CAPTURE_YUYV},
    {.name = "UYVY", .packing = CAPTURE_UYVY},
    {.name = "NV12", .chroma = CAPTURE_NV12},
    {.name = "YU12", .chroma = CAPTURE_YU12},
    {.name = "SRGGB8", .bayer = true},
    {.name = "SRGGB10", .packing = CAPTURE_16LE, .bayer = true},
    {.name = "SRGGB10P", .packing = CAPTURE_10P, .bayer = true},
};

/* Not 128, so that readers of the wrong bytes notice. */
enum { CHROMA_BLUE = 117, CHROMA_RED = 138 };

static bool same_name(const char *a, const char *b)
{
    while (*a != '\0' && toupper((unsigned char)*a) == toupper((unsigned char)*b))
        a++, b++;
    return *a == *b;
}

const capture_format *capture_format_find(const char *name)
{
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        if (same_name(formats[i].name, name))
            return &formats[i];
    }
    return NULL;
}

const char *capture_format_names(void)
{
    return "PGM PNG Y4M GREY Y10 Y10P YUYV UYVY NV12 YU12 SRGGB8 SRGGB10 SRGGB10P";
}

unsigned capture_bits(const capture_format *format)
{
    return format->packing == CAPTURE_16LE || format->packing == CAPTURE_10P ? 10 : 8;
}

size_t capture_least_stride(const capture_format *format, int32_t width_px)
{
    size_t width = (size_t)width_px;
    if (format->packing == CAPTURE_10P)
        return (width + 3) / 4 * 5;
    return format->packing == CAPTURE_8 ? width : 2 * width;
}

bool capture_fits(const capture_format *format, int32_t width_px, int32_t height_px)
{
    int32_t columns = format->packing == CAPTURE_10P ? 4 : 2;
    bool grouped = format->packing != CAPTURE_8 && format->packing != CAPTURE_16LE;
    bool square = format->chroma != CAPTURE_NO_CHROMA || format->bayer;
    return (!grouped || width_px % columns == 0) && (!square || (width_px % 2 == 0 && height_px % 2 == 0));
}

void capture_write_header(FILE *file, const capture_format *format, int32_t width_px, int32_t height_px, double fps)
{
    if (format->container != CAPTURE_Y4M)
        return;
    bool whole = fps == floor(fps);
    fprintf(file, "YUV4MPEG2 W%d H%d F%.0f:%d Ip A1:1 Cmono\n", (int)width_px, (int)height_px,
            whole ? fps : 1000 * fps, whole ? 1 : 1000);
}

/* ---- Frames -------------------------------------------------------------------------------------------- */

/* What a sensor without white balance gives for gray: less red and still less blue than green. */
static uint16_t mosaic(uint16_t sample, int32_t x, int32_t y)
{
    static const unsigned share_of_256[2][2] = {{150, 256}, {256, 118}};
    return (uint16_t)(sample * share_of_256[y & 1][x & 1] >> 8);
}

static void pack_10p(const uint16_t *samples, int32_t width_px, uint8_t *row)
{
    for (int32_t x = 0; x < width_px; x++) {
        row[x / 4 * 5 + x % 4] = (uint8_t)(samples[x] >> 2);
        row[x / 4 * 5 + 4] = (uint8_t)(row[x / 4 * 5 + 4] | (samples[x] & 3) << 2 * (x % 4));
    }
}

/* `luma` is the place of the luma sample in its pair of bytes. */
static void pack_422(const uint16_t *samples, int32_t width_px, int luma, uint8_t *row)
{
    for (int32_t x = 0; x < width_px; x++) {
        row[2 * x + luma] = (uint8_t)samples[x];
        row[2 * x + 1 - luma] = x & 1 ? CHROMA_RED : CHROMA_BLUE;
    }
}

static void pack_row(const capture_format *format, const uint16_t *samples, int32_t width_px, uint8_t *row)
{
    switch (format->packing) {
    case CAPTURE_8:
        for (int32_t x = 0; x < width_px; x++)
            row[x] = (uint8_t)samples[x];
        break;
    case CAPTURE_16LE:
        for (int32_t x = 0; x < width_px; x++) {
            row[2 * x] = (uint8_t)samples[x];
            row[2 * x + 1] = (uint8_t)(samples[x] >> 8);
        }
        break;
    case CAPTURE_10P:
        pack_10p(samples, width_px, row);
        break;
    case CAPTURE_YUYV:
        pack_422(samples, width_px, 0, row);
        break;
    case CAPTURE_UYVY:
        pack_422(samples, width_px, 1, row);
        break;
    }
}

static void write_first_plane(FILE *file, const capture_format *format, const uint16_t *samples, int32_t width_px,
                              int32_t height_px, size_t stride_bytes, uint8_t *row, uint16_t *line)
{
    for (int32_t y = 0; y < height_px; y++) {
        for (size_t i = 0; i < stride_bytes; i++)
            row[i] = 0;
        for (int32_t x = 0; x < width_px; x++) {
            uint16_t sample = samples[(size_t)y * (size_t)width_px + (size_t)x];
            line[x] = format->bayer ? mosaic(sample, x, y) : sample;
        }
        pack_row(format, line, width_px, row);
        fwrite(row, 1, stride_bytes, file);
    }
}

static void write_chroma(FILE *file, capture_chroma chroma, int32_t height_px, size_t stride_bytes)
{
    size_t pairs = (size_t)(height_px / 2) * (stride_bytes / 2);
    for (size_t i = 0; chroma == CAPTURE_NV12 && i < pairs; i++) {
        putc(CHROMA_BLUE, file);
        putc(CHROMA_RED, file);
    }
    for (size_t i = 0; chroma == CAPTURE_YU12 && i < 2 * pairs; i++)
        putc(i < pairs ? CHROMA_BLUE : CHROMA_RED, file);
}

/* Samples of 8 bits. */
static bool write_png(FILE *file, const uint16_t *samples, int32_t width_px, int32_t height_px)
{
    size_t count = (size_t)width_px * (size_t)height_px, size = 0;
    uint8_t *pixels = malloc(count), *png = NULL;
    error_text only_memory;
    for (size_t i = 0; pixels != NULL && i < count; i++)
        pixels[i] = (uint8_t)samples[i];
    bool done = pixels != NULL && opencv_encode_png(pixels, width_px, height_px, &png, &size, &only_memory);
    if (done)
        fwrite(png, 1, size, file);
    free(png);
    free(pixels);
    return done;
}

bool capture_write_frame(FILE *file, const capture_format *format, const uint16_t *samples, int32_t width_px,
                         int32_t height_px, size_t stride_bytes)
{
    if (format->container == CAPTURE_PNG)
        return write_png(file, samples, width_px, height_px);
    uint8_t *row = malloc(stride_bytes);
    uint16_t *line = malloc((size_t)width_px * sizeof *line);
    bool done = row != NULL && line != NULL;
    if (done) {
        if (format->container == CAPTURE_PGM)
            fprintf(file, "P5\n%d %d\n255\n", (int)width_px, (int)height_px);
        else if (format->container == CAPTURE_Y4M)
            fputs("FRAME\n", file);
        write_first_plane(file, format, samples, width_px, height_px, stride_bytes, row, line);
        write_chroma(file, format->chroma, height_px, stride_bytes);
    }
    free(row);
    free(line);
    return done;
}
