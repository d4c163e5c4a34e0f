/* The first pass: contrast of tiles, counted again the plain way. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "random.h"
#include "tapemark.h"
#include "tiles.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { TILE = TAPEMARK_TILE_PX, ALL = 1000000 };

/* An image of exactly its size, and what was built of it. */
typedef struct test_image {
    tmi_view view;
    uint8_t *pixels;
    void *memory;
    tmi_tiles tiles;
    bool raised;
} test_image;

static test_image image_of(int32_t width, int32_t height, ptrdiff_t stride)
{
    const size_t bytes = (size_t)stride * ((size_t)height - 1) + (size_t)width;
    test_image image = {.pixels = malloc(bytes)};
    assert_non_null(image.pixels);
    memset(image.pixels, 100, bytes);
    image.view = (tmi_view){.pixels = image.pixels, .width = width, .height = height, .stride = stride, .sign = 1};
    return image;
}

static void build(test_image *image, uint8_t contrast_min, uint32_t active_max)
{
    /* Planes and bits, as the public macro has them beyond its fixed part. */
    const size_t bytes =
        TAPEMARK_WORKSPACE_BYTES(image->view.width, image->view.height) - TAPEMARK_WORKSPACE_FIXED_BYTES;
    free(image->memory);
    image->memory = malloc(bytes);
    assert_non_null(image->memory);
    image->raised = tmi_tiles_build(&image->tiles, &image->view, contrast_min, active_max, image->memory);
}

static void drop(test_image *image)
{
    free(image->memory);
    free(image->pixels);
}

static void fill_with_noise(test_image *image, uint64_t seed, int most)
{
    random_source source = {seed};
    for (int32_t y = 0; y < image->view.height; y++)
        for (int32_t x = 0; x < image->view.width; x++)
            image->pixels[y * image->view.stride + x] = (uint8_t)(random_bits(&source) % (uint64_t)(most + 1));
}

static uint8_t *pixel(test_image *image, int32_t x, int32_t y)
{
    return &image->pixels[y * image->view.stride + x];
}

/* ---- Against a plain count ----------------------------------------------------------------------------------- */

/* The first pass may skip every other row, so that its extremes lie between those of the even rows and of all. */
static void assert_extremes(const test_image *image, int32_t column, int32_t row)
{
    int low[2] = {255, 255}, high[2] = {0, 0};
    for (int32_t y = row * TILE; y < (row + 1) * TILE && y < image->view.height; y++)
        for (int32_t x = column * TILE; x < (column + 1) * TILE && x < image->view.width; x++) {
            const int value = image->pixels[y * image->view.stride + x];
            for (int all = y % 2; all < 2; all++) {
                low[all] = value < low[all] ? value : low[all];
                high[all] = value > high[all] ? value : high[all];
            }
        }
    const ptrdiff_t i = row * image->tiles.pitch + column;
    assert_in_range(image->tiles.low[i], low[1], low[0]);
    assert_in_range(image->tiles.high[i], high[0], high[1]);
}

/* Both sets of bits name the tiles that have a swing, and `active` counts them. */
static void assert_bits_agree(const tmi_tiles *tiles)
{
    uint32_t active = 0;
    for (int32_t y = 0; y < tiles->rows; y++)
        for (int32_t x = 0; x < tiles->columns; x++) {
            const bool swings = tiles->swing[y * tiles->pitch + x] > 0;
            assert_int_equal(tiles->row_bits[y * tiles->row_words + x / 32] >> x % 32 & 1, swings);
            assert_int_equal(tiles->column_bits[x * tiles->column_words + y / 32] >> y % 32 & 1, swings);
            active += swings;
        }
    assert_int_equal(tiles->active, active);
}

static void assert_no_bits_beyond(const tmi_tiles *tiles)
{
    for (int32_t y = 0; y < tiles->rows; y++)
        for (int32_t x = tiles->columns; x < 32 * tiles->row_words; x++)
            assert_int_equal(tiles->row_bits[y * tiles->row_words + x / 32] >> x % 32 & 1, 0);
    for (int32_t x = 0; x < tiles->columns; x++)
        for (int32_t y = tiles->rows; y < 32 * tiles->column_words; y++)
            assert_int_equal(tiles->column_bits[x * tiles->column_words + y / 32] >> y % 32 & 1, 0);
}

static void extremes_are_those_of_each_tile(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {15, 15}, {16, 16}, {17, 16}, {16, 17}, {33, 17},
                                       {31, 100}, {100, 31}, {511, 18}, {512, 33}, {513, 20}, {700, 48}, {1030, 7}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++)
        for (ptrdiff_t wider = 0; wider <= 13; wider += 13) {
            test_image image = image_of(sizes[i][0], sizes[i][1], sizes[i][0] + wider);
            fill_with_noise(&image, i, 255);
            build(&image, 10, ALL);
            assert_int_equal(image.tiles.columns, TAPEMARK_TILES(sizes[i][0]));
            assert_int_equal(image.tiles.rows, TAPEMARK_TILES(sizes[i][1]));
            for (int32_t row = 0; row < image.tiles.rows; row++)
                for (int32_t column = 0; column < image.tiles.columns; column++)
                    assert_extremes(&image, column, row);
            assert_bits_agree(&image.tiles);
            assert_no_bits_beyond(&image.tiles);
            drop(&image);
        }
}

static void what_lies_between_rows_does_not_count(void **state)
{
    (void)state;
    test_image image = image_of(50, 40, 90);
    memset(image.pixels, 255, (size_t)(90 * 39 + 50));
    for (int32_t y = 0; y < 40; y++)
        memset(pixel(&image, 0, y), 100, 50);
    build(&image, 1, ALL);
    assert_int_equal(image.tiles.active, 0);
    drop(&image);
}

/* ---- Swing ---------------------------------------------------------------------------------------------------- */

static void tiles_below_the_least_contrast_are_flat(void **state)
{
    (void)state;
    for (int contrast = 1; contrast <= 60; contrast += 7) {
        test_image image = image_of(80, 80, 80);
        *pixel(&image, 40, 40) = (uint8_t)(100 + contrast);
        for (int least = 1; least <= 80; least += 3) {
            build(&image, (uint8_t)least, ALL);
            assert_int_equal(image.tiles.active, contrast >= least ? 1 : 0);
            assert_int_equal(image.tiles.swing[2 * image.tiles.pitch + 2] > 0, contrast >= least);
            assert_bits_agree(&image.tiles);
            assert_false(image.raised);
        }
        drop(&image);
    }
}

/* Next to stronger contrast the same change counts for less. */
static void the_swing_follows_the_contrast_around(void **state)
{
    (void)state;
    test_image image = image_of(160, 80, 160);
    *pixel(&image, 40, 40) = 140;
    build(&image, 10, ALL);
    const ptrdiff_t at = 2 * image.tiles.pitch + 2;
    const uint8_t alone = image.tiles.swing[at];
    assert_in_range(alone, 1, 20);
    *pixel(&image, 60, 40) = 250; /* in the next tile */
    build(&image, 10, ALL);
    const uint8_t beside = image.tiles.swing[at];
    assert_true(beside > alone && beside < 75);
    *pixel(&image, 60, 40) = 100;
    *pixel(&image, 130, 40) = 250; /* far away */
    build(&image, 10, ALL);
    assert_int_equal(image.tiles.swing[at], alone);
    drop(&image);
}

static void tiles_at_the_border_are_as_others(void **state)
{
    (void)state;
    static const int32_t places[][2] = {{24, 24}, {0, 0}, {63, 0}, {0, 62}, {63, 62}};
    uint8_t swing = 0;
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        test_image image = image_of(64, 64, 64);
        *pixel(&image, places[i][0], places[i][1]) = 200;
        build(&image, 10, ALL);
        assert_int_equal(image.tiles.active, 1);
        const uint8_t here = image.tiles.swing[places[i][1] / TILE * image.tiles.pitch + places[i][0] / TILE];
        assert_true(here > 0 && (i == 0 || here == swing));
        swing = here;
        drop(&image);
    }
}

/* ---- Too much contrast -------------------------------------------------------------------------------------- */

/* Tile number i has a contrast of 10 + i, and as many are flat: the bar leaves those with the most. */
static void the_bar_rises_where_too_many_are_active(void **state)
{
    (void)state;
    enum { TILES = 100 };
    test_image image = image_of(2 * TILES * TILE, TILE, 2 * TILES * TILE);
    for (int32_t i = 0; i < TILES; i++)
        *pixel(&image, i * TILE + 5, 4) = (uint8_t)(110 + i);
    for (uint32_t most = 1; most <= 120; most += 17) {
        build(&image, 10, most);
        assert_int_equal(image.raised, most < TILES);
        assert_int_equal(image.tiles.active, most < TILES ? most : TILES);
        for (int32_t i = 0; i < TILES; i++)
            assert_int_equal(image.tiles.swing[i] > 0, i >= TILES - (int32_t)image.tiles.active);
        assert_bits_agree(&image.tiles);
    }
    drop(&image);
}

/* All tiles but two have the contrast of noise: they are left out, and that is no limit. Where they fit in, as in a
 * small picture, they are scanned. */
static void noise_is_left_out_where_there_is_much(void **state)
{
    (void)state;
    enum { TILES = 100 };
    test_image image = image_of(TILES * TILE, TILE, TILES * TILE);
    for (int32_t i = 0; i < TILES; i++)
        *pixel(&image, i * TILE + 5, 4) = (uint8_t)(100 + (i % 50 == 7 ? 20 : 8 + i % 5));
    build(&image, 5, 60);
    assert_int_equal(image.tiles.active, 2);
    assert_true(image.tiles.swing[7] > 0 && image.tiles.swing[57] > 0);
    assert_false(image.raised);
    build(&image, 5, 2 * TILES);
    assert_int_equal(image.tiles.active, TILES);
    drop(&image);
}

static void all_alike_does_not_mean_none(void **state)
{
    (void)state;
    test_image image = image_of(320, 320, 320);
    fill_with_noise(&image, 3, 1);
    for (int32_t i = 0; i < 320 * 320; i++)
        image.pixels[i] = image.pixels[i] ? 220 : 20;
    build(&image, 10, 400);
    assert_int_equal(image.tiles.active, 400);
    build(&image, 10, 200);
    assert_true(image.tiles.active > 0);
    assert_bits_agree(&image.tiles);
    drop(&image);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(extremes_are_those_of_each_tile),
        cmocka_unit_test(what_lies_between_rows_does_not_count),
        cmocka_unit_test(tiles_below_the_least_contrast_are_flat),
        cmocka_unit_test(the_swing_follows_the_contrast_around),
        cmocka_unit_test(tiles_at_the_border_are_as_others),
        cmocka_unit_test(the_bar_rises_where_too_many_are_active),
        cmocka_unit_test(noise_is_left_out_where_there_is_much),
        cmocka_unit_test(all_alike_does_not_mean_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
