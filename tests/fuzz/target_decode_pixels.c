/* tapemark_decode() over images of any size and stride, of which the bytes are the pixels. */
#include "decode_call.h"

enum { PIXELS_MAX = 1 << 16 };

/* Sizes out of range come with few pixels: they are not to be looked at. */
static tapemark_image read_size(byte_script *script)
{
    tapemark_image image = {.width_px = 1 + script_byte(script), .height_px = 1 + script_byte(script)};
    const uint8_t kind = script_byte(script);
    if (kind >= 250)
        image.width_px = script_i32(script);
    if (kind >= 253)
        image.height_px = script_i32(script);
    if (kind == 248)
        image.width_px = 65535;
    if (kind == 249)
        image.height_px = 65535;
    image.stride_bytes = image.width_px;
    if (kind % 4 == 1)
        image.stride_bytes += script_byte(script);
    if (kind % 16 == 2)
        image.stride_bytes = script_i32(script);
    return image;
}

/* How many bytes the image takes, the last row without its gap; 0 where it is not valid, or too large for here. */
static size_t bytes_of(const tapemark_image *image)
{
    if (image->width_px < 1 || image->width_px > 65535 || image->height_px < 1 || image->height_px > 65535 ||
        image->stride_bytes < image->width_px || image->stride_bytes > PIXELS_MAX)
        return 0;
    const size_t bytes = (size_t)(image->height_px - 1) * (size_t)image->stride_bytes + (size_t)image->width_px;
    return bytes <= 16 * PIXELS_MAX ? bytes : 0;
}

/* The script's bytes over and over, each for some pixels in a row, so that few of them make structure. */
static void fill(byte_script script, uint8_t *pixels, size_t size)
{
    const size_t run = 1 + script_byte(&script) % 32;
    for (size_t i = 0; i < size; i++)
        pixels[i] = script.left > 0 ? script.at[i / run % script.left] : (uint8_t)(i * i >> 3);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    byte_script script = {bytes, size};
    tapemark_image image = read_size(&script);
    const bool out_of_range = image.width_px < 1 || image.width_px > 65535 || image.height_px < 1 ||
                              image.height_px > 65535 || image.stride_bytes < image.width_px;
    const size_t image_bytes = bytes_of(&image);
    if (image_bytes == 0 && !out_of_range)
        return 0;
    uint8_t *pixels = exact_memory(image_bytes);
    image.pixels = pixels;
    decode_call call = decode_call_read(&script);
    fill(script, pixels, image_bytes);
    decode_call_run(&call, &image);
    decode_call_release(&call);
    free(pixels);
    return 0;
}
