#include "gray.h"

#include <stdlib.h>

static uint8_t clamp_to_byte(unsigned value)
{
    return value < 255 ? (uint8_t)value : 255;
}

static unsigned sample_16le(const uint8_t *row, int32_t x)
{
    return row[2 * x] | (unsigned)row[2 * x + 1] << 8;
}

static void gray_row(const pixel_format_info *info, const uint8_t *row, int32_t width_px, uint8_t *gray)
{
    switch (info->packing) {
    case PACKING_8:
        break;
    case PACKING_16LE:
        for (int32_t x = 0; x < width_px; x++)
            gray[x] = clamp_to_byte(sample_16le(row, x) >> (info->bits - 8));
        break;
    case PACKING_10P:
        for (int32_t x = 0; x < width_px; x++)
            gray[x] = row[x / 4 * 5 + x % 4];
        break;
    case PACKING_YUYV:
        for (int32_t x = 0; x < width_px; x++)
            gray[x] = row[2 * x];
        break;
    case PACKING_UYVY:
        for (int32_t x = 0; x < width_px; x++)
            gray[x] = row[2 * x + 1];
        break;
    }
}

static void unpack_bayer_row(const pixel_format_info *info, const uint8_t *row, int32_t width_px, uint16_t *samples)
{
    unsigned white = (1u << info->bits) - 1;
    for (int32_t x = 0; x < width_px; x++) {
        unsigned value;
        if (info->packing == PACKING_10P)
            value = (unsigned)row[x / 4 * 5 + x % 4] << 2 | (row[x / 4 * 5 + 4] >> (2 * (x % 4)) & 3);
        else if (info->packing == PACKING_16LE)
            value = sample_16le(row, x);
        else
            value = row[x];
        samples[x] = (uint16_t)(value < white ? value : white);
    }
}

/* The neighbour beyond an edge is the one mirrored at the edge pixel: it has the same colour. */
static int32_t mirror(int32_t i, int32_t count)
{
    if (i < 0)
        i = 1;
    else if (i >= count)
        i = count - 2;
    return i >= 0 && i < count ? i : 0;
}

/* The kernel [1 2 1; 2 4 2; 1 2 1] / 16 weighs red : green : blue as 1 : 2 : 1 whichever pixel it is centred on,
 * so one pass serves all four Bayer orders, keeps full resolution and does not shift the picture, as averages
 * of 2 x 2 px would by half a pixel. */
static void gray_from_bayer(const pixel_format_info *info, const frame *input, uint16_t *rows, uint8_t *gray)
{
    int32_t width = input->layout.width_px;
    int32_t height = input->layout.height_px;
    size_t row_size = (size_t)width;
    uint16_t *sums = rows + 3 * row_size + 1;  /* with room for the neighbours beyond both edges */
    unsigned shift = 4u + info->bits - 8u;

    for (int32_t y = 0; y < height; y++) {
        /* Row y + 1 goes where row y - 2 was; the first time round, rows 0 and 1 are both missing. */
        for (int32_t fresh = y == 0 ? 0 : y + 1; fresh <= y + 1 && fresh < height; fresh++)
            unpack_bayer_row(info, input->data + (size_t)fresh * input->layout.stride_bytes, width,
                             rows + (size_t)(fresh % 3) * row_size);
        const uint16_t *above = rows + (size_t)(mirror(y - 1, height) % 3) * row_size;
        const uint16_t *here = rows + (size_t)(y % 3) * row_size;
        const uint16_t *below = rows + (size_t)(mirror(y + 1, height) % 3) * row_size;
        for (int32_t x = 0; x < width; x++)
            sums[x] = (uint16_t)(above[x] + 2 * here[x] + below[x]);
        sums[-1] = sums[mirror(-1, width)];
        sums[width] = sums[mirror(width, width)];
        for (int32_t x = 0; x < width; x++) {
            unsigned sum = sums[x - 1] + 2u * sums[x] + sums[x + 1];
            gray[x] = clamp_to_byte((sum + (1u << (shift - 1))) >> shift);
        }
        gray += width;
    }
}

static void *grow(void *memory, size_t *size, size_t wanted)
{
    if (memory != NULL && *size >= wanted)
        return memory;
    free(memory);
    *size = wanted;
    return malloc(wanted);
}

bool gray_from_frame(gray_converter *converter, const frame *input, gray_view *view, error_text *error)
{
    const frame_layout *layout = &input->layout;
    const pixel_format_info *info = pixel_format_describe(layout->format);
    size_t width = (size_t)layout->width_px;

    *view = (gray_view){input->data, layout->width_px, layout->height_px, (ptrdiff_t)layout->stride_bytes};
    if (info->packing == PACKING_8 && !info->bayer)
        return true;

    converter->pixels = grow(converter->pixels, &converter->pixels_size, width * (size_t)layout->height_px);
    if (info->bayer)
        converter->rows = grow(converter->rows, &converter->rows_size,
                               (4 * width + 2) * sizeof *converter->rows);
    if (converter->pixels == NULL || (info->bayer && converter->rows == NULL)) {
        error_text_set(error, "not enough memory for a frame of %d x %d px", layout->width_px, layout->height_px);
        return false;
    }
    if (info->bayer) {
        gray_from_bayer(info, input, converter->rows, converter->pixels);
    } else {
        for (size_t y = 0; y < (size_t)layout->height_px; y++)
            gray_row(info, input->data + y * layout->stride_bytes, layout->width_px, converter->pixels + y * width);
    }
    view->pixels = converter->pixels;
    view->stride_bytes = (ptrdiff_t)width;
    return true;
}

void gray_converter_release(gray_converter *converter)
{
    free(converter->pixels);
    free(converter->rows);
    *converter = (gray_converter){0};
}
