/* Pictures that stand still, and such that nearly do. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "stillness.h"

enum { WIDTH = 101, HEIGHT = 64, STRIDE = 128 };

static const int64_t frame_ns = 33000000;

static uint8_t pixels[HEIGHT * STRIDE];
static const gray_view view = {pixels, WIDTH, HEIGHT, STRIDE};
static stillness seen;
static int64_t now_ns;

static int begin(void **state)
{
    (void)state;
    memset(&seen, 0, sizeof seen);
    now_ns = 1000 * frame_ns;
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i * 7);
    return 0;
}

/* How many of the next frames count as still; `touch` is changed in each. */
static unsigned count_still(unsigned frames, uint8_t *touch, bool has_markers)
{
    unsigned still = 0;
    for (unsigned i = 0; i < frames; i++) {
        now_ns += frame_ns;
        if (touch != NULL)
            (*touch)++;
        still += stillness_lasts(&seen, &view, has_markers, now_ns);
    }
    return still;
}

static void picture_that_stays_is_still_after_three_seconds(void **state)
{
    (void)state;
    assert_int_equal(count_still(91, NULL, true), 0);
    assert_int_equal(count_still(10, NULL, true), 10);
    pixels[0]++;
    assert_int_equal(count_still(1, NULL, true), 0);
}

static void one_pixel_is_enough(void **state)
{
    (void)state;
    assert_int_equal(count_still(200, &pixels[8 * STRIDE + 3], true), 0);
    assert_int_equal(count_still(200, &pixels[8 * STRIDE + WIDTH - 1], true), 0);
}

/* What lies between the rows is not of the picture. */
static void padding_does_not_count(void **state)
{
    (void)state;
    assert_true(count_still(200, &pixels[WIDTH], true) > 0);
}

static void picture_without_markers_may_stay(void **state)
{
    (void)state;
    assert_int_equal(count_still(200, NULL, false), 0);
}

static void slow_camera_is_given_more_time(void **state)
{
    (void)state;
    now_ns += 10000 * frame_ns;
    stillness_lasts(&seen, &view, true, now_ns);
    for (int i = 1; i < 8; i++)
        assert_false(stillness_lasts(&seen, &view, true, now_ns += INT64_C(2000000000)));
    assert_true(stillness_lasts(&seen, &view, true, now_ns += INT64_C(2000000000)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(picture_that_stays_is_still_after_three_seconds, begin),
        cmocka_unit_test_setup(one_pixel_is_enough, begin),
        cmocka_unit_test_setup(padding_does_not_count, begin),
        cmocka_unit_test_setup(picture_without_markers_may_stay, begin),
        cmocka_unit_test_setup(slow_camera_is_given_more_time, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
