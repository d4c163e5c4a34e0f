#include "drawing_png.h"
#include "drawing_file.h"

#include <math.h>
#include <stdint.h>

static const double MM_PER_INCH = 25.4;

/* cairo's PNG knows no size on paper: a chunk with the pixels a metre is put in behind the header. */
typedef struct png_file {
    drawing_file file;
    size_t offset_bytes;
    uint8_t pixel_size[21];
} png_file;

enum { PNG_HEADER_BYTES = 33 };

static uint32_t crc32_of(const uint8_t *bytes, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

static void put_be32(uint8_t *target, uint32_t number)
{
    for (int i = 0; i < 4; i++)
        target[i] = (uint8_t)(number >> (24 - 8 * i));
}

static void make_pixel_size_chunk(uint8_t chunk[21], double dpi)
{
    enum { DATA_BYTES = 9, UNIT_METRE = 1 };
    static const uint8_t type[4] = {'p', 'H', 'Y', 's'};
    uint32_t px_per_m = (uint32_t)lround(dpi / MM_PER_INCH * 1000);
    put_be32(chunk, DATA_BYTES);
    for (int i = 0; i < 4; i++)
        chunk[4 + i] = type[i];
    put_be32(chunk + 8, px_per_m);
    put_be32(chunk + 12, px_per_m);
    chunk[16] = UNIT_METRE;
    put_be32(chunk + 17, crc32_of(chunk + 4, 4 + DATA_BYTES));
}

static cairo_status_t write_png_bytes(void *closure, const unsigned char *bytes, unsigned int size)
{
    png_file *png = closure;
    size_t header_left = png->offset_bytes < PNG_HEADER_BYTES ? PNG_HEADER_BYTES - png->offset_bytes : 0;
    size_t before = header_left < size ? header_left : size;
    bool written = drawing_file_write(&png->file, bytes, before);
    if (written && header_left > 0 && before == header_left)
        written = drawing_file_write(&png->file, png->pixel_size, sizeof png->pixel_size);
    if (written)
        written = drawing_file_write(&png->file, bytes + before, size - before);
    png->offset_bytes += size;
    return written ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

bool drawing_png_write(cairo_surface_t *surface, const char *path, double dpi, error_text *error)
{
    png_file png = {0};
    make_pixel_size_chunk(png.pixel_size, dpi);
    if (!drawing_file_open(&png.file, path, error))
        return false;
    cairo_status_t status = cairo_surface_write_to_png_stream(surface, write_png_bytes, &png);
    if (status == CAIRO_STATUS_SUCCESS || status == CAIRO_STATUS_WRITE_ERROR)
        return drawing_file_publish(&png.file, error);
    error_text_set(error, "%.300s: cannot be made: %s", path, cairo_status_to_string(status));
    drawing_file_discard(&png.file);
    return false;
}
