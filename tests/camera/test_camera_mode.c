/* Which of a camera's modes serves best. */
#include "../app/test_main.h"

#include "camera_mode.h"

static const camera_mode webcam[] = {
    {PIXEL_YUYV, false, 640, 480, 30},   {PIXEL_YUYV, false, 640, 480, 15},  {PIXEL_YUYV, false, 1280, 720, 10},
    {PIXEL_YUYV, false, 1920, 1080, 5},  {PIXEL_GREY, true, 640, 480, 60},   {PIXEL_GREY, true, 1280, 720, 30},
    {PIXEL_GREY, true, 1920, 1080, 30},
};

static const camera_mode sensor[] = {
    {PIXEL_Y10, false, 1280, 800, 60},  {PIXEL_GREY, false, 1280, 800, 120}, {PIXEL_GREY, false, 1280, 720, 120},
    {PIXEL_GREY, false, 1280, 720, 60}, {PIXEL_Y10P, false, 1280, 720, 120}, {PIXEL_NV12, false, 640, 400, 240},
    {PIXEL_SRGGB8, false, 1280, 720, 30},
};

static const camera_mode unknown_rates[] = {
    {PIXEL_YUYV, false, 1920, 1080, 0}, {PIXEL_NV12, false, 640, 480, 0}, {PIXEL_YU12, false, 1920, 1080, 0},
};

static void expect(const camera_mode *modes, size_t count, camera_wishes wishes, int wanted)
{
    error_text error = {""};
    const camera_mode *chosen = camera_mode_choose(modes, count, &wishes, &error);
    int found = chosen != NULL ? (int)(chosen - modes) : -1;
    if (found != wanted)
        fail_msg("mode %d instead of %d; %s", found, wanted, error.text);
    assert_int_equal(chosen == NULL, error.text[0] != '\0');
}

#define EXPECT(modes, wanted, ...) expect(modes, COUNT_OF(modes), (camera_wishes){__VA_ARGS__}, wanted)

static void a_webcam_is_read_without_jpeg_where_it_is_fast_enough(void **state)
{
    (void)state;
    EXPECT(webcam, 0, 0);
    EXPECT(webcam, 5, .width_px = 1280, .height_px = 720);
    EXPECT(webcam, 2, .width_px = 1280, .height_px = 720, .rate_hz = 10);
    EXPECT(webcam, 2, .width_px = 1280, .height_px = 720, .format = "YUYV");
    EXPECT(webcam, 5, .format = "mjpeg");
    EXPECT(webcam, 4, .rate_hz = 60);
    EXPECT(webcam, 4, .rate_hz = 500);
    EXPECT(webcam, 1, .rate_hz = 15, .width_px = 640, .height_px = 480);
    EXPECT(webcam, 3, .format = "YUYV", .width_px = 1920, .height_px = 1080);
}

static void a_sensor_gives_gray_in_the_usual_size(void **state)
{
    (void)state;
    EXPECT(sensor, 3, 0);
    EXPECT(sensor, 2, .rate_hz = 100);
    EXPECT(sensor, 5, .rate_hz = 200);
    EXPECT(sensor, 1, .width_px = 1280, .height_px = 800);
    EXPECT(sensor, 0, .format = "Y10");
    EXPECT(sensor, 6, .format = "SRGGB8");
}

static void rates_that_are_not_known_count_as_enough(void **state)
{
    (void)state;
    EXPECT(unknown_rates, 1, 0);
    EXPECT(unknown_rates, 2, .width_px = 1920, .height_px = 1080);
}

static void what_there_is_is_told(void **state)
{
    error_text error;
    (void)state;
    EXPECT(webcam, -1, .format = "GREY");
    EXPECT(webcam, -1, .width_px = 800, .height_px = 600);
    const camera_wishes not_there = {.width_px = 800, .height_px = 600};
    assert_null(camera_mode_choose(webcam, COUNT_OF(webcam), &not_there, &error));
    assert_string_equal(error.text, "does not offer any format:800x600; it has YUYV:640x480 YUYV:1280x720 "
                                    "YUYV:1920x1080 MJPEG:640x480 MJPEG:1280x720 MJPEG:1920x1080");
    assert_null(camera_mode_choose(webcam, 0, &(camera_wishes){0}, &error));
    assert_non_null(strstr(error.text, "no pixel format"));
    /* However long the list is. */
    static camera_mode many[1000];
    for (size_t i = 0; i < COUNT_OF(many); i++)
        many[i] = (camera_mode){PIXEL_SRGGB10P, false, (int32_t)(10000 + i), 10000, 30};
    assert_null(camera_mode_choose(many, COUNT_OF(many), &(camera_wishes){.format = "GREY"}, &error));
    assert_int_equal(strncmp(error.text, "does not offer GREY; it has SRGGB10P:10000x10000", 48), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_webcam_is_read_without_jpeg_where_it_is_fast_enough),
        cmocka_unit_test(a_sensor_gives_gray_in_the_usual_size),
        cmocka_unit_test(rates_that_are_not_known_count_as_enough),
        cmocka_unit_test(what_there_is_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
