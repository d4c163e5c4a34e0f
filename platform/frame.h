/*
 * A frame as a camera or a file gives it: pixels in one of the formats below, with size, stride, sequence
 * number and time stamp. gray.h turns any of them into the 8-bit gray view that the decoder reads.
 */
#ifndef PLATFORM_FRAME_H
#define PLATFORM_FRAME_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The largest width and height of a frame, in px, and the most bytes that one takes: more is a mistake in a header or
 * in a layout, and would take all memory there is. */
enum { FRAME_SIDE_MAX_PX = 65535, FRAME_BYTES_MAX = 1 << 30 };

/* Named as Video4Linux names them. Only the luma is used of those with colour. */
typedef enum pixel_format {
    PIXEL_GREY,      /* 8 bits */
    PIXEL_Y10,       /* 10 bits in the low end of 16, little-endian; Y12 and Y16 likewise */
    PIXEL_Y12,
    PIXEL_Y16,
    PIXEL_Y10P,      /* 10 bits, packed: four pixels in five bytes, the fifth holds the low two bits of each */
    PIXEL_YUYV,      /* 4:2:2, luma in the even bytes */
    PIXEL_UYVY,      /* 4:2:2, luma in the odd bytes */
    PIXEL_NV12,      /* 4:2:0, a luma plane, then one plane of both chroma samples */
    PIXEL_YU12,      /* 4:2:0, a luma plane, then two chroma planes of half the stride */
    PIXEL_SRGGB8,    /* Bayer, 8 bits; named by the order of the first four pixels */
    PIXEL_SGRBG8,
    PIXEL_SGBRG8,
    PIXEL_SBGGR8,
    PIXEL_SRGGB10,   /* Bayer, 10 bits in the low end of 16, little-endian */
    PIXEL_SGRBG10,
    PIXEL_SGBRG10,
    PIXEL_SBGGR10,
    PIXEL_SRGGB10P,  /* Bayer, 10 bits, packed as Y10P */
    PIXEL_SGRBG10P,
    PIXEL_SGBRG10P,
    PIXEL_SBGGR10P,
    PIXEL_FORMAT_COUNT
} pixel_format;

/* How the samples of the first plane lie in memory. */
typedef enum pixel_packing {
    PACKING_8,
    PACKING_16LE,
    PACKING_10P,
    PACKING_YUYV,
    PACKING_UYVY
} pixel_packing;

typedef enum chroma_planes { CHROMA_NONE, CHROMA_NV12, CHROMA_YU12 } chroma_planes;

typedef struct pixel_format_info {
    const char *name;
    pixel_packing packing;
    uint8_t bits;  /* of a sample */
    chroma_planes chroma;
    bool bayer;
} pixel_format_info;

/* NULL for values that are not in pixel_format. */
const pixel_format_info *pixel_format_describe(pixel_format format);

typedef struct frame_layout {
    pixel_format format;
    int32_t width_px;
    int32_t height_px;
    size_t stride_bytes;  /* of the first plane */
} frame_layout;

/* Fewest bytes that a row of the first plane takes. */
size_t frame_layout_least_stride(pixel_format format, int32_t width_px);

/* Bytes of a whole frame, chroma planes included; 0 when a side is outside 1 to FRAME_SIDE_MAX_PX, the stride is
 * shorter than a row, or they are more than FRAME_BYTES_MAX. */
size_t frame_layout_size_bytes(const frame_layout *layout);

/* Reads "FORMAT:WIDTHxHEIGHT" or "FORMAT:WIDTHxHEIGHT:STRIDE", for instance "Y10P:640x480:832". */
bool frame_layout_parse(const char *text, frame_layout *layout, error_text *error);

#define FRAME_TIME_UNKNOWN INT64_MIN

typedef struct frame {
    frame_layout layout;
    const uint8_t *data;  /* of the source, until its next frame is asked for; first plane first */
    uint64_t sequence;    /* counts what the source gave, from 0; gaps are frames that were dropped */
    int64_t time_ns;      /* on the source's own clock, or FRAME_TIME_UNKNOWN */
} frame;

#ifdef __cplusplus
}
#endif

#endif
