/* Pictures as files hold them and as cameras give them. */
#ifndef RENDER_CAPTURE_H
#define RENDER_CAPTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* How the samples of the first plane lie in memory. */
typedef enum capture_packing { CAPTURE_8, CAPTURE_16LE, CAPTURE_10P, CAPTURE_YUYV, CAPTURE_UYVY } capture_packing;

typedef enum capture_chroma { CAPTURE_NO_CHROMA, CAPTURE_NV12, CAPTURE_YU12 } capture_chroma;

/* PGM: a header a frame; Y4M: one for all and a line a frame; PNG: a whole file a frame. */
typedef enum capture_container { CAPTURE_HEADERLESS, CAPTURE_PGM, CAPTURE_PNG, CAPTURE_Y4M } capture_container;

typedef struct capture_format {
    const char *name;  /* PGM, PNG, Y4M, or as Video4Linux names it */
    capture_packing packing;
    capture_chroma chroma;
    bool bayer;  /* RGGB, without white balance */
    capture_container container;
} capture_format;

/* NULL for an unknown name; upper and lower case are the same. */
const capture_format *capture_format_find(const char *name);

/* The names of all formats, with blanks between them. */
const char *capture_format_names(void);

/* Bits of a sample: 8 or 10. */
unsigned capture_bits(const capture_format *format);

/* Fewest bytes that a row of the first plane takes. */
size_t capture_least_stride(const capture_format *format, int32_t width_px);

/* Whether a picture of this size can be told in this format: packed and subsampled ones come in whole groups. */
bool capture_fits(const capture_format *format, int32_t width_px, int32_t height_px);

/* Writes what comes before the first frame. */
void capture_write_header(FILE *file, const capture_format *format, int32_t width_px, int32_t height_px, double fps);

/* Writes a frame of samples of capture_bits(). False when memory runs out; see ferror() for the file. */
bool capture_write_frame(FILE *file, const capture_format *format, const uint16_t *samples, int32_t width_px,
                         int32_t height_px, size_t stride_bytes);

#endif
