/*
 * Runs in the virtual machine: a recording in which a tape comes and goes, and what was saved of it.
 *
 *     gpio_clip write FILE.y4m FRAMES    of five frames, the first three show the tape
 *     gpio_clip read FILE.pgm            prints the number of the frame that this is, pixel for pixel
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"

enum { WIDTH_PX = 640, HEIGHT_PX = 480, PIXELS = WIDTH_PX * HEIGHT_PX, CYCLE = 5, WITH_TAPE = 3, WALL = 140 };

static uint8_t expected[PIXELS], pixels[PIXELS + 1];

static void draw(uint32_t number)
{
    if (number % CYCLE < WITH_TAPE)
        picture_draw(expected, WIDTH_PX, HEIGHT_PX, number);
    else
        memset(expected, WALL, sizeof expected);
}

static int write_clip(const char *path, uint32_t frames)
{
    FILE *file = fopen(path, "wb");
    bool good = file != NULL && fprintf(file, "YUV4MPEG2 W%d H%d F8:1 Ip A1:1 Cmono\n", WIDTH_PX, HEIGHT_PX) > 0;
    for (uint32_t number = 0; good && number < frames; number++) {
        draw(number);
        good = fputs("FRAME\n", file) >= 0 && fwrite(expected, sizeof expected, 1, file) == 1;
    }
    good = file != NULL && fclose(file) == 0 && good;
    if (!good)
        fprintf(stderr, "gpio_clip: %s cannot be written\n", path);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

static bool read_pixels(const char *path)
{
    static const char head[] = "P5\n640 480\n255\n";
    char begin[sizeof head] = "";
    FILE *file = fopen(path, "rb");
    const bool good = file != NULL && fread(begin, sizeof head - 1, 1, file) == 1 && strcmp(begin, head) == 0 &&
                      fread(pixels, 1, sizeof pixels, file) == PIXELS;
    if (file != NULL)
        fclose(file);
    return good;
}

static int read_saved(const char *path)
{
    uint32_t number;
    if (!read_pixels(path)) {
        fprintf(stderr, "gpio_clip: %s is no PGM picture of %d x %d px\n", path, WIDTH_PX, HEIGHT_PX);
        return EXIT_FAILURE;
    }
    if (!picture_number(pixels, WIDTH_PX, &number)) {
        fprintf(stderr, "gpio_clip: %s has no number in it\n", path);
        return EXIT_FAILURE;
    }
    draw(number);
    if (memcmp(expected, pixels, PIXELS) != 0) {
        fprintf(stderr, "gpio_clip: %s is not frame %u as it was\n", path, (unsigned)number);
        return EXIT_FAILURE;
    }
    printf("%u\n", (unsigned)number);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    if (argc == 4 && strcmp(argv[1], "write") == 0)
        return write_clip(argv[2], (uint32_t)strtoul(argv[3], NULL, 10));
    if (argc == 3 && strcmp(argv[1], "read") == 0)
        return read_saved(argv[2]);
    fprintf(stderr, "gpio_clip: expected write FILE.y4m FRAMES, or read FILE.pgm\n");
    return 2;
}
