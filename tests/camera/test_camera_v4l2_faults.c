/* What Video4Linux cameras do when calls fail, when the device is unplugged, and when its driver does odd things. */
#include "v4l2_fixture.h"

#include <errno.h>
#include <poll.h>

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

/* Without waiting it is noticed as well: in a loop around poll() there is no other chance to. */
static void what_poll_reports_is_seen_without_waiting(void **state)
{
    camera_status status = CAMERA_TIMEOUT;
    (void)state;
    fixture f = ready(NULL);
    fake.poll_events = POLLERR;
    for (int i = 0; i < 20 && status == CAMERA_TIMEOUT; i++)
        status = camera_next(f.device, 0, &f.got, &f.error);
    assert_int_equal(status, CAMERA_FAILED);
    finish(&f);

    fake_reset();
    f = ready(NULL);
    fake.source_changed = true;
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FAILED);
    assert_non_null(strstr(f.error.text, "changed the size"));
    finish(&f);
}

/* poll() tells of a frame, and there is none, again and again. */
static void empty_promises_keep_nobody_busy(void **state)
{
    (void)state;
    fixture f = ready(NULL);
    fake.poll_events = POLLIN;
    fake.calls = 0;
    assert_int_equal(camera_next(f.device, 100, &f.got, &f.error), CAMERA_TIMEOUT);
    assert_in_range(fake.calls, 1, 110);

    int64_t start_ns = camera_clock_ns();
    for (int i = 0; i < 50; i++)
        assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_TIMEOUT);
    assert_in_range(camera_clock_ns() - start_ns, 49 * 1000000, INT64_MAX);

    fake_take(1);
    assert_int_equal(camera_next(f.device, 0, &f.got, &f.error), CAMERA_FRAME);
    finish(&f);
}

/* What a failure leaves in the driver's hands would keep the next format from being set. */
static void after_a_failure_it_can_be_set_up_again(void **state)
{
    const camera_wishes wishes = {0};
    (void)state;
    for (int granted = 0; granted < 6; granted++) {
        error_text error;
        camera *device = camera_open("v4l2:/dev/video0", &error);
        fake.maps = granted;
        assert_false(camera_configure(device, &wishes, &error));
        assert_non_null(strstr(error.text, "does not share its buffers"));
        assert_int_equal(fake.mapped, 0);
        assert_int_equal(fake.allocated, 0);
        fake.maps = -1;
        fake.buffers = 2;
        assert_false(camera_configure(device, &wishes, &error));
        assert_non_null(strstr(error.text, "fewer than are needed"));
        fake.buffers = FAKE_BUFFERS;
        if (!camera_configure(device, &wishes, &error))
            fail_msg("%s", error.text);
        camera_close(device);
        assert_int_equal(fake.mapped, 0);
        fake_reset();
    }
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

/* ---- Frames that are not as they should be -------------------------------------------------------------------- */

static uint32_t dice = 1;

static uint32_t roll(uint32_t below)
{
    dice = dice * 1664525 + 1013904223;
    return (dice >> 8) % below;
}

/* Short, long, marked as torn, of another time or number; now and then one as it should be. False: no frame can come
 * of it. */
static bool take_odd_picture(void)
{
    enum { FRAME_BYTES = 64 * 48 };
    static const uint32_t sizes[] = {1, FRAME_BYTES / 2, FRAME_BYTES - 1, FRAME_BYTES + 1, 2 * FRAME_BYTES,
                                     UINT32_MAX};
    static const int64_t ages_ns[] = {0, INT64_C(3600000000000), INT64_C(-3600000000000), INT64_C(5000000000),
                                      INT64_C(-50000000), INT64_C(9000000000000000)};
    static const uint32_t flags[] = {V4L2_BUF_FLAG_TSTAMP_SRC_SOE, V4L2_BUF_FLAG_TSTAMP_SRC_EOF,
                                     V4L2_BUF_FLAG_TIMESTAMP_COPY};
    static const uint32_t steps[] = {0, 5, 900, 100000, UINT32_MAX, UINT32_MAX - 1000};
    const bool torn = roll(4) == 0;
    fake.bytes_used = roll(3) == 0 ? sizes[roll(COUNT_OF(sizes))] : 0;
    fake.age_ns = roll(2) == 0 ? ages_ns[roll(COUNT_OF(ages_ns))] : 0;
    fake.stamp_us = roll(8) == 0 ? 1 + roll(1000) : 0;
    fake.flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | flags[roll(COUNT_OF(flags))] | (torn ? V4L2_BUF_FLAG_ERROR : 0);
    fake.sequence += roll(2) == 0 ? steps[roll(COUNT_OF(steps))] : 0;
    fake_take(1);
    return !torn && (fake.bytes_used == 0 || fake.bytes_used >= FRAME_BYTES);
}

/* Whole, of one picture, with a time that can be, and a number that goes on. */
static void expect_good_frame(const camera_frame *got, uint64_t *last_sequence, int64_t before_ns)
{
    const int64_t credible_ns = INT64_C(10000000000), frame_ns = 1000000000;
    const size_t bytes = frame_layout_size_bytes(&got->image.layout);
    assert_in_range(got->image.time_ns, before_ns - credible_ns - frame_ns, camera_clock_ns());
    assert_int_equal(got->image.sequence, *last_sequence + got->dropped + 1);
    assert_in_range(got->dropped, 0, 1000);
    for (size_t i = 1; i < bytes; i++)
        assert_int_equal(got->image.data[i], got->image.data[0]);
    *last_sequence = got->image.sequence;
}

static void odd_frames_are_given_right_or_not_at_all(void **state)
{
    enum { PICTURES = 20000 };
    uint64_t last_sequence = UINT64_MAX;
    unsigned possible = 0, given = 0;
    (void)state;
    fixture f = ready(NULL);
    for (unsigned i = 0; i < PICTURES; i++) {
        const int64_t before_ns = camera_clock_ns();
        const bool can_be_given = take_odd_picture();
        const camera_status status = camera_next(f.device, 0, &f.got, &f.error);
        possible += can_be_given;
        assert_true(status == CAMERA_FRAME || status == CAMERA_TIMEOUT);
        if (status != CAMERA_FRAME)
            continue;
        assert_true(can_be_given);
        expect_good_frame(&f.got, &last_sequence, before_ns);
        given++;
    }
    /* Those that seem old cost another one now and then. */
    assert_in_range(given, possible / 2, possible);
    assert_int_equal(camera_counts_of(f.device).given, given);
    finish(&f);
}

static const unsigned long requests[] = {
    VIDIOC_QUERYCAP, VIDIOC_ENUM_FMT, VIDIOC_ENUM_FRAMESIZES, VIDIOC_ENUM_FRAMEINTERVALS, VIDIOC_G_FMT, VIDIOC_S_FMT,
    VIDIOC_G_PARM, VIDIOC_S_PARM, VIDIOC_G_SELECTION, VIDIOC_S_SELECTION, VIDIOC_QUERYCTRL, VIDIOC_S_CTRL,
    VIDIOC_REQBUFS, VIDIOC_QUERYBUF, VIDIOC_QBUF, VIDIOC_DQBUF, VIDIOC_STREAMON, VIDIOC_STREAMOFF,
    VIDIOC_SUBSCRIBE_EVENT, VIDIOC_DQEVENT, VIDIOC_G_EXT_CTRLS,
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(an_unplugged_camera_is_gone, reset),
        cmocka_unit_test_setup(what_poll_reports_is_looked_into, reset),
        cmocka_unit_test_setup(what_poll_reports_is_seen_without_waiting, reset),
        cmocka_unit_test_setup(empty_promises_keep_nobody_busy, reset),
        cmocka_unit_test_setup(after_a_failure_it_can_be_set_up_again, reset),
        cmocka_unit_test_setup(a_buffer_that_was_not_given_is_an_error, reset),
        cmocka_unit_test_setup(failures_that_pass_are_borne, reset),
        cmocka_unit_test_setup(odd_frames_are_given_right_or_not_at_all, reset),
        cmocka_unit_test_setup(any_failure_at_any_time_is_survived, reset),
        cmocka_unit_test_setup(signals_change_nothing, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
