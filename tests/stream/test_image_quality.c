/* Light and sharpness of pictures whose light and sharpness are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "image_quality.h"

enum { WIDTH_PX = 320, HEIGHT_PX = 240, STRIDE_BYTES = 352 };

static uint8_t pixels[STRIDE_BYTES * HEIGHT_PX];
static const gray_view view = {pixels, WIDTH_PX, HEIGHT_PX, STRIDE_BYTES};

/* A checkerboard of 13 px, blurred by the mean over so many pixels in each direction, with light and noise. */
static image_quality measure(int blur_x_px, int blur_y_px, int dark, int light)
{
    const int square_px = 13;
    uint32_t dice = 1;
    for (int y = 0; y < HEIGHT_PX; y++) {
        for (int x = 0; x < WIDTH_PX; x++) {
            int sum = 0;
            for (int dy = 0; dy < blur_y_px; dy++)
                for (int dx = 0; dx < blur_x_px; dx++)
                    sum += ((x + dx) / square_px + (y + dy) / square_px) % 2 != 0 ? light : dark;
            dice = dice * 1664525 + 1013904223;
            int level = sum / (blur_x_px * blur_y_px) + (int)(dice >> 30) - 2;
            pixels[y * STRIDE_BYTES + x] = (uint8_t)(level < 0 ? 0 : level > 255 ? 255 : level);
        }
    }
    return image_quality_measure(&view);
}

static void sharp_picture_is_sharp(void **state)
{
    (void)state;
    for (int blur_px = 1; blur_px <= 3; blur_px++) {
        image_quality quality = measure(blur_px, blur_px, 40, 180);
        assert_false(image_quality_blurred(&quality));
        assert_false(image_quality_too_dark(&quality));
        assert_false(image_quality_too_bright(&quality));
        assert_in_range(quality.light, 178, 182);
    }
}

static void blur_in_one_direction_is_enough(void **state)
{
    (void)state;
    image_quality quality = measure(9, 1, 40, 180);
    assert_true(image_quality_blurred(&quality));
    assert_true(quality.sharpness_along_x < 40 && quality.sharpness_along_y > 80);
    quality = measure(1, 9, 40, 180);
    assert_true(image_quality_blurred(&quality));
    assert_true(quality.sharpness_along_y < 40 && quality.sharpness_along_x > 80);
}

static void sharpness_falls_with_blur(void **state)
{
    (void)state;
    int last = 101;
    for (int blur_px = 2; blur_px <= 10; blur_px += 2) {
        image_quality quality = measure(blur_px, blur_px, 40, 180);
        assert_true(quality.sharpness_along_x < last);
        last = quality.sharpness_along_x;
    }
}

static void nothing_to_see_is_not_blurred(void **state)
{
    (void)state;
    image_quality quality = measure(1, 1, 100, 110);
    assert_int_equal(quality.sharpness_along_x, SHARPNESS_UNKNOWN);
    assert_false(image_quality_blurred(&quality));
}

static void darkness_and_glare_are_told(void **state)
{
    (void)state;
    image_quality quality = measure(1, 1, 5, 30);
    assert_true(image_quality_too_dark(&quality));
    quality = measure(1, 1, 80, 258);
    assert_true(image_quality_too_bright(&quality));
    assert_in_range(quality.saturated_percent, 45, 55);
}

/* Nothing beyond the picture is looked at, which is what the sanitizers are for. */
static void small_pictures_are_measured(void **state)
{
    (void)state;
    for (int32_t side_px = 1; side_px < 40; side_px++) {
        uint8_t *small = malloc((size_t)side_px * (size_t)side_px);
        assert_non_null(small);
        memset(small, 200, (size_t)side_px * (size_t)side_px);
        const gray_view small_view = {small, side_px, side_px, side_px};
        image_quality quality = image_quality_measure(&small_view);
        assert_int_equal(quality.light, side_px >= 17 ? 200 : 255);
        assert_int_equal(quality.saturated_percent, 0);
        free(small);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sharp_picture_is_sharp),
        cmocka_unit_test(blur_in_one_direction_is_enough),
        cmocka_unit_test(sharpness_falls_with_blur),
        cmocka_unit_test(nothing_to_see_is_not_blurred),
        cmocka_unit_test(darkness_and_glare_are_told),
        cmocka_unit_test(small_pictures_are_measured),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
