#include "frame.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* A stride above this is a typing error; the bound keeps the product with the height far inside 64 bits. */
#define STRIDE_MAX_BYTES (UINT64_C(1) << 24)

static const pixel_format_info formats[PIXEL_FORMAT_COUNT] = {
    [PIXEL_GREY] = {"GREY", PACKING_8, 8, CHROMA_NONE, false},
    [PIXEL_Y10] = {"Y10", PACKING_16LE, 10, CHROMA_NONE, false},
    [PIXEL_Y12] = {"Y12", PACKING_16LE, 12, CHROMA_NONE, false},
    [PIXEL_Y16] = {"Y16", PACKING_16LE, 16, CHROMA_NONE, false},
    [PIXEL_Y10P] = {"Y10P", PACKING_10P, 10, CHROMA_NONE, false},
    [PIXEL_YUYV] = {"YUYV", PACKING_YUYV, 8, CHROMA_NONE, false},
    [PIXEL_UYVY] = {"UYVY", PACKING_UYVY, 8, CHROMA_NONE, false},
    [PIXEL_NV12] = {"NV12", PACKING_8, 8, CHROMA_NV12, false},
    [PIXEL_YU12] = {"YU12", PACKING_8, 8, CHROMA_YU12, false},
    [PIXEL_SRGGB8] = {"SRGGB8", PACKING_8, 8, CHROMA_NONE, true},
    [PIXEL_SGRBG8] = {"SGRBG8", PACKING_8, 8, CHROMA_NONE, true},
    [PIXEL_SGBRG8] = {"SGBRG8", PACKING_8, 8, CHROMA_NONE, true},
    [PIXEL_SBGGR8] = {"SBGGR8", PACKING_8, 8, CHROMA_NONE, true},
    [PIXEL_SRGGB10] = {"SRGGB10", PACKING_16LE, 10, CHROMA_NONE, true},
    [PIXEL_SGRBG10] = {"SGRBG10", PACKING_16LE, 10, CHROMA_NONE, true},
    [PIXEL_SGBRG10] = {"SGBRG10", PACKING_16LE, 10, CHROMA_NONE, true},
    [PIXEL_SBGGR10] = {"SBGGR10", PACKING_16LE, 10, CHROMA_NONE, true},
    [PIXEL_SRGGB10P] = {"SRGGB10P", PACKING_10P, 10, CHROMA_NONE, true},
    [PIXEL_SGRBG10P] = {"SGRBG10P", PACKING_10P, 10, CHROMA_NONE, true},
    [PIXEL_SGBRG10P] = {"SGBRG10P", PACKING_10P, 10, CHROMA_NONE, true},
    [PIXEL_SBGGR10P] = {"SBGGR10P", PACKING_10P, 10, CHROMA_NONE, true},
};

const pixel_format_info *pixel_format_describe(pixel_format format)
{
    return (unsigned)format < PIXEL_FORMAT_COUNT ? &formats[format] : NULL;
}

size_t frame_layout_least_stride(pixel_format format, int32_t width_px)
{
    size_t width = (size_t)width_px;
    switch (formats[format].packing) {
    case PACKING_16LE:
        return 2 * width;
    case PACKING_10P:
        return (width + 3) / 4 * 5;
    case PACKING_YUYV:
    case PACKING_UYVY:
        return (width + 1) / 2 * 4;
    case PACKING_8:
        break;
    }
    return width;
}

static bool side_is_valid(int32_t side_px)
{
    return side_px >= 1 && side_px <= FRAME_SIDE_MAX_PX;
}

size_t frame_layout_size_bytes(const frame_layout *layout)
{
    const pixel_format_info *info = pixel_format_describe(layout->format);
    if (info == NULL || !side_is_valid(layout->width_px) || !side_is_valid(layout->height_px) ||
        layout->stride_bytes < frame_layout_least_stride(layout->format, layout->width_px) ||
        layout->stride_bytes > STRIDE_MAX_BYTES)
        return 0;

    uint64_t stride = layout->stride_bytes;
    uint64_t rows = (uint64_t)layout->height_px;
    uint64_t chroma_rows = (rows + 1) / 2;
    uint64_t bytes = stride * rows;
    if (info->chroma == CHROMA_NV12)
        bytes += (stride + 1) / 2 * 2 * chroma_rows;
    else if (info->chroma == CHROMA_YU12)
        bytes += (stride + 1) / 2 * chroma_rows * 2;
    return bytes <= FRAME_BYTES_MAX ? (size_t)bytes : 0;
}

static bool find_format(const char *name, size_t length, pixel_format *format)
{
    for (unsigned i = 0; i < PIXEL_FORMAT_COUNT; i++) {
        if (strlen(formats[i].name) == length && strncasecmp(name, formats[i].name, length) == 0) {
            *format = (pixel_format)i;
            return true;
        }
    }
    return false;
}

static void list_formats(error_text *error, const char *name, size_t length)
{
    char names[256] = "";
    for (size_t i = 0, used = 0; i < PIXEL_FORMAT_COUNT && used < sizeof names; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, " %s", formats[i].name);
    error_text_set(error, "unknown pixel format '%.*s'; known:%s", (int)(length < 40 ? length : 40), name, names);
}

/* Digits only, so that no sign, blank or hexadecimal slips through. Returns where the number ended, or NULL. */
static const char *parse_number(const char *text, unsigned long *value)
{
    if (*text < '0' || *text > '9')
        return NULL;
    char *end;
    errno = 0;
    *value = strtoul(text, &end, 10);
    return errno == 0 ? end : NULL;
}

bool frame_layout_parse(const char *text, frame_layout *layout, error_text *error)
{
    size_t name_length = strcspn(text, ":");
    unsigned long width, height, stride;

    if (!find_format(text, name_length, &layout->format)) {
        list_formats(error, text, name_length);
        return false;
    }
    const char *rest = text[name_length] == ':' ? parse_number(text + name_length + 1, &width) : NULL;
    rest = rest != NULL && (*rest == 'x' || *rest == 'X') ? parse_number(rest + 1, &height) : NULL;
    if (rest == NULL || (*rest != '\0' && *rest != ':')) {
        error_text_set(error, "expected FORMAT:WIDTHxHEIGHT[:STRIDE], as in GREY:640x480, not '%.80s'", text);
        return false;
    }
    if (width < 1 || width > FRAME_SIDE_MAX_PX || height < 1 || height > FRAME_SIDE_MAX_PX) {
        error_text_set(error, "width and height are 1 to %d px, not %lux%lu", FRAME_SIDE_MAX_PX, width, height);
        return false;
    }
    layout->width_px = (int32_t)width;
    layout->height_px = (int32_t)height;

    size_t least = frame_layout_least_stride(layout->format, layout->width_px);
    stride = least;
    if (*rest == ':') {
        rest = parse_number(rest + 1, &stride);
        if (rest == NULL || *rest != '\0' || stride < least || stride > STRIDE_MAX_BYTES) {
            error_text_set(error, "the stride of %s rows of %lu px is a number of bytes from %zu to %llu",
                           formats[layout->format].name, width, least, (unsigned long long)STRIDE_MAX_BYTES);
            return false;
        }
    }
    layout->stride_bytes = stride;
    if (frame_layout_size_bytes(layout) == 0) {
        error_text_set(error, "a frame of %.80s is too large: at most %d MiB are possible", text,
                       FRAME_BYTES_MAX >> 20);
        return false;
    }
    return true;
}
