/* Video4Linux cameras: found, opened, and set to what is wished. */
#include "v4l2_fixture.h"

#include <errno.h>

/* In libcamera's place: no camera, or one that is built in, or one that is not. */
void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context);
camera *__wrap_camera_libcamera_open(const char *name, error_text *error);

typedef enum libcamera_shows { SHOWS_NONE, SHOWS_BUILT_IN, SHOWS_USB } libcamera_shows;
static libcamera_shows shows;

void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context)
{
    static const camera_mode mode = {PIXEL_YU12, false, 640, 480, 0};
    if (shows == (built_in ? SHOWS_BUILT_IN : SHOWS_USB))
        tell(context, &(camera_description){"libcamera:0", "From libcamera", &mode, 1});
}

camera *__wrap_camera_libcamera_open(const char *name, error_text *error)
{
    error_text_set(error, "asked for camera %s of libcamera", name);
    return NULL;
}

static void expect_refusal(const char *name, const camera_wishes *wishes, const char *text)
{
    error_text error;
    camera *device = camera_open(name, &error);
    if (device != NULL)
        assert_false(camera_configure(device, wishes, &error));
    if (strstr(error.text, text) == NULL)
        fail_msg("'%s' instead of '%s'", error.text, text);
    camera_close(device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

static int reset_all(void **state)
{
    (void)state;
    fake_reset();
    shows = SHOWS_NONE;
    return 0;
}

static void opening_tells_what_is_wrong(void **state)
{
    const camera_wishes none = {0};
    (void)state;
    expect_refusal("v4l2:/dev/video9", &none, "No such file");
    fake_fail(0, EACCES, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "group video");
    fake_fail(0, EBUSY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "another program");
    fake_reset();
    fake_fail(VIDIOC_QUERYCAP, ENOTTY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "no Video4Linux device");
    fake_reset();
    fake.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
    expect_refusal("v4l2:/dev/video0", &none, "no camera");
    fake.capabilities = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING;
    expect_refusal("v4l2:/dev/video0", &none, "libcamera");
    fake_reset();
    fake_fail(VIDIOC_REQBUFS, EBUSY, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "another program");
    fake_reset();
    fake_fail(VIDIOC_STREAMON, ENOSPC, 0, -1);
    expect_refusal("v4l2:/dev/video0", &none, "bandwidth");
    fake_reset();
    fake.buffers = 2;
    expect_refusal("v4l2:/dev/video0", &none, "fewer than are needed");
    fake_reset();
    fake.field = V4L2_FIELD_INTERLACED;
    expect_refusal("v4l2:/dev/video0", &none, "interlaced");
    expect_refusal("v4l3:/dev/video0", &none, "expected auto");
}

static void answers_that_cannot_be_are_refused(void **state)
{
    static const fake_mode no_list = {V4L2_PIX_FMT_GREY, 0, 0, 0};
    const camera_wishes none = {0};
    (void)state;
    fake.answer = (struct v4l2_pix_format){.pixelformat = V4L2_PIX_FMT_RGB24};
    expect_refusal("v4l2:/dev/video0", &none, "does not give GREY after all");
    fake.answer = (struct v4l2_pix_format){.width = 32, .height = 16};
    expect_refusal("v4l2:/dev/video0", &none, "answers with 32x16 px instead of 64x48");
    fake.answer = (struct v4l2_pix_format){.bytesperline = 63};
    expect_refusal("v4l2:/dev/video0", &none, "rows of 63 bytes");
    fake.answer = (struct v4l2_pix_format){.sizeimage = 64 * 48 - 1};
    expect_refusal("v4l2:/dev/video0", &none, "pictures of 3071");
    fake.answer = (struct v4l2_pix_format){.bytesperline = 1u << 30};
    expect_refusal("v4l2:/dev/video0", &none, "does not fit into");
    fake.answer = (struct v4l2_pix_format){0};
    fake.buffer_bytes = 64 * 48 - 1;
    expect_refusal("v4l2:/dev/video0", &none, "smaller than a frame");
    fake.buffer_bytes = 0;
    fake.modes = &no_list;
    fake.answer = (struct v4l2_pix_format){.width = 1u << 31, .height = 1};
    expect_refusal("v4l2:/dev/video0", &none, "impossible size");
}

static void wishes_are_checked(void **state)
{
    (void)state;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.format = "RGB7"}, "unknown pixel format 'RGB7'");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.format = "NV12"}, "does not offer NV12; it has GREY:64x48");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 640}, "width and height");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 640, .height_px = 480}, "it has GREY:64x48");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.rate_hz = -1}, "rate");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = -5}, "exposure");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.gain = -5}, "gain");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.region = {-1, 0, 5, 5}}, "region");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = 500}, "no control for the exposure");
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.gain = 2}, "no control for the gain");
    fake.crops = false;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.region = {0, 0, 32, 16}}, "does not crop");
}

static void exposure_and_gain_are_set(void **state)
{
    (void)state;
    add_usual_controls();
    fixture f = ready(&(camera_wishes){.exposure_us = 2040, .gain = 500});
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_ABSOLUTE), 20);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 2000);
    assert_int_equal(fake_control_value(V4L2_CID_GAIN), 100);
    assert_int_equal(camera_settings_of(f.device)->gain, 100);
    assert_int_equal(fake_control_value(V4L2_CID_AUTOGAIN), 0);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.exposure_us, 2000);

    /* While it runs, and back to automatic. */
    assert_true(camera_set_light(f.device, 300, 7, &f.error));
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_ABSOLUTE), 3);
    assert_int_equal(fake_control_value(V4L2_CID_GAIN), 7);
    assert_true(fake.streaming);
    assert_true(camera_set_light(f.device, 0, 0, &f.error));
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_AUTO);
    assert_int_equal(fake_control_value(V4L2_CID_AUTOGAIN), 1);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 0);
    finish(&f);
}

/* Sensors count rows: 64 + 36 px at 10 MHz are 10 us a row. */
static void exposure_in_rows_is_set(void **state)
{
    (void)state;
    fake.controls[0] = (fake_control){V4L2_CID_EXPOSURE, 4, 1000, 4};
    fake.controls[1] = (fake_control){V4L2_CID_PIXEL_RATE, 0, INT32_MAX, 10 * 1000 * 1000};
    fake.controls[2] = (fake_control){V4L2_CID_HBLANK, 0, 1000, 36};
    fake.controls[3] = (fake_control){V4L2_CID_ANALOGUE_GAIN, 16, 256, 16};
    fake.control_count = 4;
    fixture f = ready(&(camera_wishes){.exposure_us = 1234, .gain = 40});
    assert_int_equal(fake_control_value(V4L2_CID_EXPOSURE), 123);
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 1230);
    assert_int_equal(fake_control_value(V4L2_CID_ANALOGUE_GAIN), 40);
    assert_true(camera_set_light(f.device, 1, 0, &f.error));
    assert_int_equal(camera_settings_of(f.device)->exposure_us, 40);
    finish(&f);

    fake.control_count = 1;
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.exposure_us = 1234}, "no control for the exposure");
}

static void the_time_is_that_of_the_middle_of_the_exposure(void **state)
{
    (void)state;
    add_usual_controls();
    fixture f = ready(&(camera_wishes){.exposure_us = 10000});
    fake.age_ns = 20 * 1000 * 1000;
    fake.comes_while_waited = 1;
    int64_t before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    int64_t after_ns = camera_clock_ns();
    /* Started 20 ms ago, and exposed for 10 ms. */
    assert_in_range(f.got.image.time_ns, before_ns - 15001000, after_ns - 15000000);

    /* Ended 20 ms ago, read out in a second. */
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    after_ns = camera_clock_ns();
    assert_in_range(f.got.image.time_ns, before_ns - 20001000 - 500000000 - 5000000,
                    after_ns - 20000000 - 500000000 - 5000000);

    /* No time that can be: then the frame's arrival counts, as the end of it. */
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
    before_ns = camera_clock_ns();
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_in_range(f.got.image.time_ns, before_ns - 500000000 - 5000000, camera_clock_ns() - 500000000 - 5000000);
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    static const int64_t impossible_ns[] = {-3600000000000, 3600000000000, -60000000, INT64_MIN / 4, INT64_MAX / 4};
    for (size_t i = 0; i < COUNT_OF(impossible_ns); i++) {
        fake.age_ns = impossible_ns[i];
        before_ns = camera_clock_ns();
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_in_range(f.got.image.time_ns, before_ns + 5000000, camera_clock_ns() + 5000000);
    }
    finish(&f);
}

static void a_region_is_cut_out(void **state)
{
    (void)state;
    fixture f = ready(&(camera_wishes){.region = {8, 4, 32, 16}});
    assert_int_equal(fake.crop.left, 8);
    assert_int_equal(fake.crop.width, 32);
    assert_int_equal(camera_settings_of(f.device)->region.y_px, 4);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.width_px, 32);
    assert_int_equal(f.got.image.layout.height_px, 16);

    /* And all is there again; numbers go on. */
    assert_true(camera_configure(f.device, &(camera_wishes){0}, &f.error));
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.width_px, 64);
    assert_int_equal(f.got.image.sequence, 1);
    finish(&f);
}

static void sizes_in_steps_and_no_sizes_at_all(void **state)
{
    static const fake_mode one = {V4L2_PIX_FMT_GREY, 1, 1, 0};
    static const fake_mode none = {V4L2_PIX_FMT_GREY, 0, 0, 0};
    (void)state;
    fake.modes = &one;
    fake.steps = (struct v4l2_frmsize_stepwise){16, 256, 8, 16, 256, 2};
    fixture f = ready(&(camera_wishes){.width_px = 120, .height_px = 90});
    assert_int_equal(camera_settings_of(f.device)->mode.width_px, 120);
    finish(&f);
    expect_refusal("v4l2:/dev/video0", &(camera_wishes){.width_px = 121, .height_px = 90}, "does not offer");

    fake_reset();
    fake.modes = &none;
    f = ready(NULL);
    assert_int_equal(camera_settings_of(f.device)->mode.width_px, 64);
    finish(&f);
}

static void tell(void *context, const camera_description *description)
{
    char *told = context;
    size_t length = strlen(told);
    snprintf(told + length, 200 - length, "%s|%s|%zu|%s;", description->name, description->label,
             description->mode_count,
             camera_mode_format(&description->modes[0]));
}

static void cameras_are_listed_and_found(void **state)
{
    char told[200] = "";
    error_text error;
    (void)state;
    camera_list(tell, told);
    assert_string_equal(told, "v4l2:/dev/video0|Camera of the tests|1|GREY;");
    camera *device = camera_open("auto", &error);
    assert_non_null(device);
    assert_string_equal(camera_name(device), "v4l2:/dev/video0");
    assert_int_equal(camera_descriptor(device), -1);
    camera_frame got;
    assert_int_equal(camera_next(device, 10, &got, &error), CAMERA_FAILED);
    assert_false(camera_set_light(device, 0, 0, &error));
    camera_close(device);
    assert_int_equal(fake.open_count, 0);

    /* Cameras that are built in come first; USB cameras are better off without libcamera. */
    shows = SHOWS_USB;
    told[0] = '\0';
    camera_list(tell, told);
    assert_string_equal(told, "v4l2:/dev/video0|Camera of the tests|1|GREY;libcamera:0|From libcamera|1|YU12;");
    shows = SHOWS_BUILT_IN;
    expect_refusal("auto", &(camera_wishes){0}, "libcamera:0: asked for camera 0 of libcamera");

    shows = SHOWS_NONE;
    fake.capabilities |= V4L2_CAP_IO_MC;
    expect_refusal("auto", &(camera_wishes){0}, "no camera was found");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(opening_tells_what_is_wrong, reset_all),
        cmocka_unit_test_setup(answers_that_cannot_be_are_refused, reset_all),
        cmocka_unit_test_setup(wishes_are_checked, reset_all),
        cmocka_unit_test_setup(exposure_and_gain_are_set, reset_all),
        cmocka_unit_test_setup(exposure_in_rows_is_set, reset_all),
        cmocka_unit_test_setup(the_time_is_that_of_the_middle_of_the_exposure, reset_all),
        cmocka_unit_test_setup(a_region_is_cut_out, reset_all),
        cmocka_unit_test_setup(sizes_in_steps_and_no_sizes_at_all, reset_all),
        cmocka_unit_test_setup(cameras_are_listed_and_found, reset_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
