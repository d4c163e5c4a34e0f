/* Frames of Video4Linux cameras, on a device that does what the test wants: which are given, which are counted, and
 * what happens when any call fails at any time. */
#include "v4l2_fixture.h"

#include <errno.h>
#include <poll.h>

/* What libcamera sees plays no part here. */
void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context);
camera *__wrap_camera_libcamera_open(const char *name, error_text *error);

void __wrap_camera_libcamera_list(bool built_in, camera_teller tell, void *context)
{
    (void)built_in;
    (void)tell;
    (void)context;
}

camera *__wrap_camera_libcamera_open(const char *name, error_text *error)
{
    error_text_set(error, "asked for camera %s of libcamera", name);
    return NULL;
}

static int reset(void **state)
{
    (void)state;
    fake_reset();
    return 0;
}

static void frames_come_one_by_one(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    for (unsigned i = 0; i < 20; i++) {
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_int_equal(f.got.image.sequence, i);
        assert_int_equal(f.got.dropped, 0);
        assert_int_equal(f.got.image.layout.width_px, 64);
        assert_int_equal(f.got.image.layout.height_px, 48);
        for (size_t k = 0; k < 64 * 48; k++)
            assert_int_equal(f.got.image.data[k], i);
    }
    assert_int_equal(camera_counts_of(f.device).given, 20);
    assert_int_equal(camera_counts_of(f.device).dropped, 0);
    finish(&f);
}

static void the_newest_frame_wins(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_take(4);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 4);
    assert_int_equal(f.got.image.sequence, 4);
    assert_int_equal(f.got.dropped, 3);
    assert_int_equal(camera_counts_of(f.device).dropped, 3);
    /* All others are the driver's again. */
    assert_int_equal(fake.queued, 5);
    camera_release(f.device);
    assert_int_equal(fake.queued, 6);
    finish(&f);
}

/* When the driver ran out of buffers, what it has is old: the first that comes from now on is given. */
static void frames_of_a_starved_driver_are_old(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_take(30);
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 31);
    assert_int_equal(f.got.image.sequence, 31);
    assert_int_equal(f.got.dropped, 30);

    /* Nor does it help to give the last one back first. */
    fake_take(30);
    camera_release(f.device);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.sequence, 62);
    finish(&f);
}

/* The same with a driver that always keeps two buffers, by the age of its frames. */
static void old_frames_are_passed_over(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.kept = 2;
    for (int i = 0; i < 3; i++) {
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
    }
    fake.age_ns = INT64_C(5000000000);
    fake_take(8);
    fake.age_ns = 0;
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.sequence, 11);
    assert_int_equal(f.got.dropped, 8);

    /* When all frames take that long, they are taken as they are. */
    fake.age_ns = INT64_C(5000000000);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 0);
    finish(&f);
}

static void frames_lost_before_the_driver_count(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake.sequence += 5;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 5);
    assert_int_equal(f.got.image.sequence, 6);
    /* Numbers that start anew are no loss, and ours go on. */
    fake.sequence = 0;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 0);
    assert_int_equal(f.got.image.sequence, 7);
    finish(&f);
}

static void damaged_frames_are_counted_and_not_given(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.bytes_used = 64 * 48 - 1;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    fake.bytes_used = 0;
    fake.flags |= V4L2_BUF_FLAG_ERROR;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    fake.flags &= ~(uint32_t)V4L2_BUF_FLAG_ERROR;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.dropped, 2);
    assert_int_equal(camera_counts_of(f.device).damaged, 2);

    /* A frame that comes with damaged ones before and behind it is given. */
    fake_take(1);
    fake.bytes_used = 10;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.data[0], 3);
    finish(&f);
}

static void a_repeated_frame_is_not_given(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake.stamp_us = f.got.image.time_ns / 1000;
    fake.sequence = 0;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_counts_of(f.device).damaged, 1);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    finish(&f);
}

static void a_camera_without_frames_times_out(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_TIMEOUT);
    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
    finish(&f);
}

static void a_driver_that_never_lets_go_is_left(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.endless = true;
    fake_take(2);
    assert_int_equal(next(&f), CAMERA_FRAME);
    finish(&f);
}

static void an_unplugged_camera_is_gone(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    fake_unplug();
    assert_int_equal(next(&f), CAMERA_GONE);
    assert_non_null(strstr(f.error.text, "unplugged"));
    finish(&f);
}

static void what_poll_reports_is_looked_into(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.poll_events = POLLERR;
    assert_int_equal(camera_next(f.device, 1000, &f.got, &f.error), CAMERA_FAILED);
    finish(&f);

    fake_reset();
    f = ready(NULL);
    fake.source_changed = true;
    assert_int_equal(next(&f), CAMERA_FAILED);
    assert_non_null(strstr(f.error.text, "changed the size"));
    finish(&f);
}

static void a_buffer_that_was_not_given_is_an_error(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.wrong_index = 1000;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FAILED);
    finish(&f);
}

static void failures_that_pass_are_borne(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    fake_fail(VIDIOC_DQBUF, EIO, 0, 3);
    fake.comes_while_waited = 1;
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(camera_counts_of(f.device).damaged, 3);
    fake_fail(VIDIOC_DQBUF, EIO, 0, -1);
    assert_int_equal(next(&f), CAMERA_FAILED);
    finish(&f);
}

static const unsigned long requests[] = {
    VIDIOC_QUERYCAP, VIDIOC_ENUM_FMT, VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS, VIDIOC_G_FMT, VIDIOC_S_FMT,
    VIDIOC_G_PARM, VIDIOC_S_PARM, VIDIOC_G_SELECTION, VIDIOC_S_SELECTION, VIDIOC_QUERYCTRL, VIDIOC_S_CTRL,
    VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF, VIDIOC_DQBUF, VIDIOC_STREAMON, VIDIOC_STREAMOFF,
    VIDIOC_SUBSCRIBE_EVENT, VIDIOC_DQEVENT,
};

static void expect_one_line(const error_text *error)
{
    assert_int_not_equal(strlen(error->text), 0);
    assert_null(strchr(error->text, '\n'));
}

/* A whole session in which one ioctl fails in one way from some call on. */
static void run_session(unsigned long request, int failure, int after, int times)
{
    const camera_wishes wishes = {.exposure_us = 2000, .gain = 5};
    error_text error = {""};
    camera_frame got;
    camera_status status = CAMERA_TIMEOUT;
    fake_reset();
    add_usual_controls();
    fake_fail(request, failure, after, times);
    camera *device = camera_open("v4l2:/dev/video0", &error);
    bool configured = device != NULL && camera_configure(device, &wishes, &error);
    if (device == NULL || !configured)
        expect_one_line(&error);
    for (int i = 0; configured && i < 12 && (status == CAMERA_FRAME || status == CAMERA_TIMEOUT); i++) {
        fake_take(i % 4);
        status = camera_next(device, 20, &got, &error);
        assert_int_not_equal(status, CAMERA_END);
    }
    if (status == CAMERA_GONE || status == CAMERA_FAILED)
        expect_one_line(&error);
    if (configured)
        camera_set_light(device, 1000, 1, &error);
    camera_close(device);
    assert_int_equal(fake.open_count, 0);
    assert_int_equal(fake.mapped, 0);
}

static void any_failure_at_any_time_is_survived(void **state)
{
    static const int failures[] = {EINVAL, EIO, ENODEV, ENXIO, ENOTTY, EBUSY, ENOMEM, ENOSPC, EPERM, EAGAIN, EPIPE,
                                   EFAULT, ERANGE};
    (void)state;
    for (size_t r = 0; r < COUNT_OF(requests); r++)
        for (size_t f = 0; f < COUNT_OF(failures); f++)
            for (int after = 0; after < 12; after++) {
                run_session(requests[r], failures[f], after, 1);
                run_session(requests[r], failures[f], after, -1);
            }
}

static void signals_change_nothing(void **state)
{
    (void)state;
    for (size_t r = 0; r < COUNT_OF(requests); r++) {
        fake_reset();
        add_usual_controls();
        fake_fail(requests[r], EINTR, 0, 3);
        fixture f = ready(&(camera_wishes){.exposure_us = 2000});
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        finish(&f);
        /* But not for ever. */
        run_session(requests[r], EINTR, 0, -1);
    }
}

static void all_formats_are_given_as_they_are(void **state)
{
    static const struct {
        uint32_t fourcc;
        pixel_format format;
        size_t stride;
    } cases[] = {
        {V4L2_PIX_FMT_GREY, PIXEL_GREY, 64},   {V4L2_PIX_FMT_Y10, PIXEL_Y10, 128},
        {V4L2_PIX_FMT_Y10P, PIXEL_Y10P, 80},   {V4L2_PIX_FMT_Y12, PIXEL_Y12, 128},
        {V4L2_PIX_FMT_YUYV, PIXEL_YUYV, 128},  {V4L2_PIX_FMT_UYVY, PIXEL_UYVY, 128},
        {V4L2_PIX_FMT_NV12, PIXEL_NV12, 64},   {V4L2_PIX_FMT_YUV420, PIXEL_YU12, 64},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const fake_mode mode = {cases[i].fourcc, 64, 48, 1};
        fake_reset();
        fake.modes = &mode;
        fake.extra_stride = 16;
        fixture f = ready(NULL);
        fake_take(1);
        assert_int_equal(next(&f), CAMERA_FRAME);
        assert_int_equal(f.got.image.layout.format, cases[i].format);
        assert_int_equal(f.got.image.layout.stride_bytes, cases[i].stride + 16);
        finish(&f);
    }
}

static void jpegs_become_gray(void **state)
{
    static const fake_mode mode = {V4L2_PIX_FMT_MJPEG, 16, 8, 1};
    /* 16 x 8 px, all of gray level 128, as small as they get: an encoder's output. */
    static const uint8_t jpeg[] = {
        0xff, 0xd8, 0xff, 0xdb, 0x00, 0x43, 0x00, 1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,
        1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    1,    0xff,
        0xc0, 0x00, 0x0b, 0x08, 0x00, 0x08, 0x00, 0x10, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x14, 0x00, 1,
        0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0x00, 0xff, 0xc4,
        0x00, 0x14, 0x10, 1,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,
        0,    0x00, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x0f, 0xff, 0xd9, 0,    0,    0,
    };
    (void)state;
    fake.modes = &mode;
    fixture f = ready(NULL);
    fake.content = jpeg;
    fake.content_size = sizeof jpeg;
    fake_take(3);
    assert_int_equal(next(&f), CAMERA_FRAME);
    assert_int_equal(f.got.image.layout.format, PIXEL_GREY);
    assert_int_equal(f.got.image.layout.width_px, 16);
    assert_int_equal(f.got.image.layout.height_px, 8);
    assert_int_equal(f.got.dropped, 2);
    for (size_t i = 0; i < 16 * 8; i++)
        assert_int_equal(f.got.image.data[i], 128);
    /* The camera has all its buffers back already. */
    assert_int_equal(fake.queued, 6);

    fake.content_size = sizeof jpeg - 5;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    static const uint8_t rubbish[] = {0xff, 0xd8, 1, 2, 3, 4, 0xff, 0xd9};
    fake.content = rubbish;
    fake.content_size = sizeof rubbish;
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    assert_int_equal(camera_counts_of(f.device).damaged, 2);
    finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(frames_come_one_by_one, reset),
        cmocka_unit_test_setup(the_newest_frame_wins, reset),
        cmocka_unit_test_setup(frames_of_a_starved_driver_are_old, reset),
        cmocka_unit_test_setup(old_frames_are_passed_over, reset),
        cmocka_unit_test_setup(frames_lost_before_the_driver_count, reset),
        cmocka_unit_test_setup(damaged_frames_are_counted_and_not_given, reset),
        cmocka_unit_test_setup(a_repeated_frame_is_not_given, reset),
        cmocka_unit_test_setup(a_camera_without_frames_times_out, reset),
        cmocka_unit_test_setup(a_driver_that_never_lets_go_is_left, reset),
        cmocka_unit_test_setup(an_unplugged_camera_is_gone, reset),
        cmocka_unit_test_setup(what_poll_reports_is_looked_into, reset),
        cmocka_unit_test_setup(a_buffer_that_was_not_given_is_an_error, reset),
        cmocka_unit_test_setup(failures_that_pass_are_borne, reset),
        cmocka_unit_test_setup(any_failure_at_any_time_is_survived, reset),
        cmocka_unit_test_setup(signals_change_nothing, reset),
        cmocka_unit_test_setup(all_formats_are_given_as_they_are, reset),
        cmocka_unit_test_setup(jpegs_become_gray, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
