/* Frames of Video4Linux cameras, on a device that does what the test wants: which are given, which are counted, and
 * what their time stamps come to. */
#include "v4l2_fixture.h"

#include <sys/resource.h>

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

/* Programs that poll() themselves ask without waiting, each time anew: then, too, at most one frame is too old. */
static void who_polls_is_not_kept_waiting_for_newer_frames(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
    fake.age_ns = INT64_C(5000000000);
    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_TIMEOUT);
    for (unsigned i = 0; i < 10; i++) {
        fake_take(1);
        assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
        assert_int_equal(f.got.dropped, i == 0);
    }
    /* And when they come at once again, that is what counts. */
    fake.age_ns = 0;
    for (unsigned i = 0; i < 3; i++) {
        fake_take(1);
        assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
    }
    fake.age_ns = INT64_C(5000000000);
    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_TIMEOUT);
    finish(&f);
}

/* Held against when it was taken, as far as that is known. */
static void expect_time(int64_t slept_ns, int64_t age_ns, uint32_t flags, int64_t expected_ms)
{
    const int64_t rounding_ns = 1000000;
    fake_reset();
    fixture f = ready(NULL);
    fake.slept_ns = slept_ns;
    fake.age_ns = age_ns;
    fake.flags = flags;
    const int64_t before_ns = camera_clock_ns();
    fake_take(1);
    assert_int_equal(next(&f), CAMERA_FRAME);
    const int64_t expected_ns = f.got.image.time_ns - expected_ms * 1000000;
    finish(&f);
    if (expected_ns < before_ns - rounding_ns || expected_ns > camera_clock_ns() + rounding_ns)
        fail_msg("%lld ms off what was to be about %lld", (long long)(expected_ns - before_ns) / 1000000,
                 (long long)expected_ms);
}

/* Times are given as milliseconds from now. */
static void time_stamps_are_of_the_clock_that_goes_on(void **state)
{
    const uint32_t start = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
    const uint32_t end = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_EOF;
    const int64_t ms_ns = 1000000, hour_ns = INT64_C(3600000000000);
    (void)state;
    expect_time(0, 200 * ms_ns, start, -200);
    expect_time(hour_ns, 200 * ms_ns, start, -200);
    /* Of CLOCK_BOOTTIME, on a machine that slept an hour. */
    expect_time(hour_ns, 200 * ms_ns - hour_ns, start, -200);
    /* A little ahead of now: not an hour ago, on that machine or another. */
    expect_time(hour_ns, -90 * ms_ns, start, 0);
    expect_time(0, -90 * ms_ns, start, 0);
    expect_time(hour_ns, 60 * 1000 * ms_ns, start, 0);
    /* No clock that is known. */
    expect_time(0, 200 * ms_ns, V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, -500);
    /* Half a frame, of one a second, before its end. */
    expect_time(0, 200 * ms_ns, end, -700);
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

    /* Of another size: a gigabyte of it, before anybody looks. */
    enum { SIZE_OFFSET = 76 };
    static uint8_t huge[sizeof jpeg];
    struct rusage before, after;
    memcpy(huge, jpeg, sizeof jpeg);
    memset(huge + SIZE_OFFSET, 0x7f, 4);
    fake.content = huge;
    fake.content_size = sizeof huge;
    fake_take(1);
    getrusage(RUSAGE_SELF, &before);
    assert_int_equal(next(&f), CAMERA_TIMEOUT);
    getrusage(RUSAGE_SELF, &after);
    assert_in_range(after.ru_maxrss - before.ru_maxrss, 0, 100 * 1024);
    assert_int_equal(camera_counts_of(f.device).damaged, 3);
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
        cmocka_unit_test_setup(who_polls_is_not_kept_waiting_for_newer_frames, reset),
        cmocka_unit_test_setup(time_stamps_are_of_the_clock_that_goes_on, reset),
        cmocka_unit_test_setup(all_formats_are_given_as_they_are, reset),
        cmocka_unit_test_setup(jpegs_become_gray, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
