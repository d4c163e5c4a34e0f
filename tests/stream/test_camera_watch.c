/* A camera that is lost, stuck and back, with a fake in the camera's place and a clock that the tests set. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "camera_watch.h"

static const int64_t ms = 1000000;

/* What the fake does next. */
static struct {
    int64_t now_ns;
    bool absent, refuses, opening, stuck, same_time;
    camera_status status;
    uint32_t dropped;
    int64_t last_time_ns;
    unsigned opened, closed, abandoned;
} fake;

static char thread_memory;

camera_thread *__wrap_camera_thread_open(const char *name, const camera_wishes *wishes, error_text *error)
{
    (void)name;
    (void)wishes;
    (void)error;
    fake.opened++;
    return (camera_thread *)(void *)&thread_memory;
}

camera_status __wrap_camera_thread_next(camera_thread *self, camera_frame *output, error_text *error)
{
    (void)self;
    fake.last_time_ns = fake.same_time ? fake.last_time_ns : fake.now_ns;
    *output = (camera_frame){.dropped = fake.dropped, .image = {.time_ns = fake.last_time_ns}};
    error_text_set(error, fake.absent ? "is not there" : fake.refuses ? "does not want to" : "was unplugged");
    return fake.absent || fake.refuses ? CAMERA_FAILED : fake.opening ? CAMERA_TIMEOUT : fake.status;
}

bool __wrap_camera_thread_settings(camera_thread *self, camera_settings *output)
{
    (void)self;
    *output = (camera_settings){.mode = {.rate_hz = 20}};
    return !fake.absent && !fake.refuses && !fake.opening;
}

int __wrap_camera_thread_descriptor(const camera_thread *self)
{
    (void)self;
    return 42;
}

void __wrap_camera_thread_leave(camera_thread *self)
{
    assert_non_null(self);
}

void __wrap_camera_thread_release(camera_thread *self)
{
    assert_non_null(self);
}

bool __wrap_camera_thread_has_ended(camera_thread *self)
{
    assert_non_null(self);
    return !fake.stuck;
}

bool __wrap_camera_thread_close(camera_thread *self, int64_t patience_ns)
{
    (void)patience_ns;
    fake.closed += self != NULL && !fake.stuck;
    fake.abandoned += self != NULL && fake.stuck;
    return self == NULL || !fake.stuck;
}

int64_t __wrap_camera_clock_ns(void)
{
    return fake.now_ns;
}

/* ---- Helpers ------------------------------------------------------------------------------------------------- */

static stream_settings settings;
static camera_watch watch;
static error_text message;

static int begin(void **state)
{
    (void)state;
    memset(&fake, 0, sizeof fake);
    memset(&watch, 0, sizeof watch);
    fake.now_ns = 1000 * ms;
    fake.status = CAMERA_FRAME;
    settings = settings_usual();
    snprintf(settings.camera, sizeof settings.camera, "v4l2:/dev/video9");
    return 0;
}

static bool step(int64_t later_ms)
{
    camera_frame got;
    fake.now_ns += later_ms * ms;
    if (!camera_watch_next(&watch, &settings, fake.now_ns, &got))
        return false;
    camera_watch_accept(&watch, &got, fake.now_ns);
    camera_watch_release(&watch);
    return true;
}

static void start_and_take(unsigned frames)
{
    camera_watch_begin(&watch, &settings);
    for (unsigned i = 0; i < frames; i++)
        assert_true(step(33));
}

static void expect_news(const char *text)
{
    assert_true(camera_watch_news(&watch, &message));
    assert_string_equal(message.text, text);
    assert_false(camera_watch_news(&watch, &message));
}

/* ---- Tests --------------------------------------------------------------------------------------------------- */

static void frames_are_numbered_with_those_left_out(void **state)
{
    (void)state;
    start_and_take(3);
    assert_int_equal(watch.seq, 3);
    fake.dropped = 4;
    assert_true(step(33));
    assert_int_equal(watch.seq, 8);
    assert_false(camera_watch_is_lost(&watch));
    assert_false(camera_watch_news(&watch, &message));
}

static void absent_camera_is_opened_again_at_growing_intervals(void **state)
{
    (void)state;
    fake.absent = true;
    camera_watch_begin(&watch, &settings);
    assert_false(step(0));
    expect_news("camera v4l2:/dev/video9: is not there");
    assert_true(camera_watch_is_lost(&watch));
    assert_false(step(0));
    assert_int_equal(camera_watch_descriptor(&watch), -1);
    int64_t last_pause_ms = 0;
    for (int i = 0; i < 8; i++) {
        const int64_t pause_ms = (camera_watch_wake_ns(&watch) - fake.now_ns) / ms;
        assert_true(pause_ms >= 500 && pause_ms <= 8000);
        assert_true(pause_ms >= last_pause_ms);
        last_pause_ms = pause_ms;
        assert_false(step(pause_ms));
        assert_false(step(0));
        assert_false(camera_watch_news(&watch, &message));
    }
    assert_int_equal(last_pause_ms, 8000);
    assert_int_equal(watch.failures, 1);
}

static void unplugged_camera_comes_back(void **state)
{
    (void)state;
    start_and_take(5);
    fake.status = CAMERA_GONE;
    assert_false(step(10));
    fake.absent = true;
    expect_news("camera v4l2:/dev/video9: was unplugged");
    assert_true(camera_watch_is_lost(&watch));
    assert_false(step(1));
    assert_int_equal(fake.closed, 1);
    assert_false(step(600));
    fake.absent = false;
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(9000));
    assert_int_equal(fake.opened, 3);
    assert_true(camera_watch_is_lost(&watch));
    fake.status = CAMERA_FRAME;
    assert_true(step(100));
    assert_int_equal(watch.seq, 6);
    assert_int_equal(watch.sequence, 6);
    expect_news("camera v4l2:/dev/video9: gives frames again");
    assert_false(camera_watch_is_lost(&watch));
}

static void frozen_camera_is_lost_and_opened_again(void **state)
{
    (void)state;
    start_and_take(5);
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(499));
    assert_false(camera_watch_is_lost(&watch));
    assert_false(step(2));
    assert_true(camera_watch_is_lost(&watch));
    expect_news("camera v4l2:/dev/video9: gives no frames");
    assert_int_equal(fake.closed, 0);
    assert_false(step(3000));
    assert_false(step(1));
    assert_int_equal(fake.closed, 1);
    for (int i = 0; i < 5; i++) {
        assert_false(step(0));
        assert_true(camera_watch_wake_ns(&watch) > fake.now_ns);
        assert_false(step((camera_watch_wake_ns(&watch) - fake.now_ns) / ms));
    }
    assert_true(fake.opened >= 3);
    assert_in_range(fake.opened - fake.closed, 0, 1);
    assert_false(camera_watch_news(&watch, &message) && strstr(message.text, "again") != NULL);
}

static void slow_camera_is_not_lost(void **state)
{
    (void)state;
    camera_watch_begin(&watch, &settings);
    assert_true(step(300));
    assert_true(step(400));
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(900));
    assert_false(camera_watch_is_lost(&watch));
    assert_false(step(200));
    assert_true(camera_watch_is_lost(&watch));
}

static void camera_that_refuses_is_waited_for(void **state)
{
    (void)state;
    fake.refuses = true;
    camera_watch_begin(&watch, &settings);
    assert_false(step(0));
    expect_news("camera v4l2:/dev/video9: does not want to");
    assert_false(step(0));
    assert_int_equal(fake.opened, fake.closed);
}

static void recording_ends(void **state)
{
    (void)state;
    snprintf(settings.camera, sizeof settings.camera, "file:walk.y4m");
    start_and_take(2);
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(60000));
    assert_int_equal(watch.state, CAMERA_WATCH_SILENT);
    assert_int_equal(fake.closed, 0);
    assert_false(camera_watch_news(&watch, &message));
    fake.status = CAMERA_END;
    assert_false(step(1));
    assert_int_equal(watch.state, CAMERA_WATCH_ENDED);
    assert_int_equal(camera_watch_descriptor(&watch), -1);
    assert_int_equal(camera_watch_wake_ns(&watch), INT64_MAX);
}

static void recording_is_repeated(void **state)
{
    (void)state;
    settings.repeat = true;
    snprintf(settings.camera, sizeof settings.camera, "file:walk.y4m");
    start_and_take(2);
    fake.status = CAMERA_END;
    assert_false(step(1));
    assert_int_equal(watch.state, CAMERA_WATCH_RUNNING);
    /* Its first frame is as far from the last one as others are from each other, and not right behind it. */
    assert_int_equal(camera_watch_descriptor(&watch), 42);
    assert_false(step(0));
    assert_int_equal(camera_watch_wake_ns(&watch) - fake.now_ns, 49 * ms);
    fake.status = CAMERA_FRAME;
    assert_false(step(48));
    assert_int_equal(fake.opened, 1);
    assert_true(step(1));
    assert_int_equal(watch.seq, 3);
    assert_int_equal(fake.opened, 2);
    assert_int_equal(fake.closed, 1);
}

/* Or it would be opened again and again, as fast as it goes. */
static void empty_recording_is_not_repeated(void **state)
{
    (void)state;
    settings.repeat = true;
    snprintf(settings.camera, sizeof settings.camera, "file:empty.y4m");
    start_and_take(0);
    fake.status = CAMERA_END;
    assert_false(step(1));
    assert_int_equal(watch.state, CAMERA_WATCH_LOST);
    expect_news("camera file:empty.y4m: holds no frames");
}

static void absent_recording_is_an_error(void **state)
{
    (void)state;
    fake.absent = true;
    snprintf(settings.camera, sizeof settings.camera, "file:walk.y4m");
    camera_watch_begin(&watch, &settings);
    assert_false(camera_watch_has_failed(&watch));
    assert_false(step(0));
    expect_news("camera file:walk.y4m: is not there");
    assert_true(camera_watch_has_failed(&watch));
    assert_true(camera_watch_is_over(&watch));
}

/* ---- Cameras that hang, or lie ------------------------------------------------------------------------------- */

/* Libraries may take a second or two to open a camera: that is no news, but the line is told. */
static void camera_that_takes_long_to_open_is_lost_meanwhile(void **state)
{
    (void)state;
    fake.opening = true;
    camera_watch_begin(&watch, &settings);
    assert_false(step(499));
    assert_false(camera_watch_is_lost(&watch));
    assert_false(step(2));
    assert_true(camera_watch_is_lost(&watch));
    assert_false(camera_watch_news(&watch, &message));
    fake.opening = false;
    assert_true(step(1000));
    assert_false(camera_watch_is_lost(&watch));
    assert_false(camera_watch_news(&watch, &message));
}

/* It cannot be opened twice, so it is waited for, however long; then its first frame has all the time it needs. */
static void camera_that_hangs_when_opened_is_told_of_once(void **state)
{
    (void)state;
    fake.opening = true;
    camera_watch_begin(&watch, &settings);
    assert_false(step(501));
    assert_false(step(3001));
    expect_news("camera v4l2:/dev/video9: is being opened, and its driver does not answer");
    for (int i = 0; i < 100; i++)
        assert_false(step(1000));
    assert_int_equal(fake.opened, 1);
    assert_false(camera_watch_news(&watch, &message));
    assert_true(camera_watch_wake_ns(&watch) > fake.now_ns);
    fake.opening = false;
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(10));
    assert_false(step(3000));
    assert_int_equal(fake.opened, 1);
    fake.status = CAMERA_FRAME;
    assert_true(step(10));
    expect_news("camera v4l2:/dev/video9: gives frames again");
}

/* A driver that does not let go of a device would only be asked for it again and again. */
static void camera_that_hangs_when_closed_is_not_opened_again(void **state)
{
    (void)state;
    start_and_take(3);
    fake.status = CAMERA_GONE;
    fake.stuck = true;
    for (int i = 0; i < 20; i++)
        assert_false(step(1000));
    assert_int_equal(fake.opened, 1);
    assert_int_equal(camera_watch_descriptor(&watch), 42);
    fake.stuck = false;
    fake.status = CAMERA_FRAME;
    assert_true(step(0));
    assert_int_equal(fake.opened, 2);
    assert_int_equal(fake.abandoned, 0);
}

/* With another camera in its settings, it is not waited for. */
static void camera_that_hangs_does_not_hold_up_another_one(void **state)
{
    (void)state;
    start_and_take(3);
    fake.stuck = true;
    camera_watch_begin(&watch, &settings);
    assert_false(step(900));
    assert_int_equal(fake.opened, 1);
    assert_true(step(200));
    assert_int_equal(fake.opened, 2);
    assert_int_equal(fake.abandoned, 1);
    assert_int_equal(watch.seq, 4);
    fake.stuck = false;
    assert_false(camera_watch_close(&watch));
}

/* A driver that is stuck may hand out the last picture over and over. */
static void same_time_is_no_frame(void **state)
{
    (void)state;
    start_and_take(3);
    fake.same_time = true;
    for (int i = 0; i < 14; i++)
        assert_false(step(33));
    assert_false(camera_watch_is_lost(&watch));
    assert_false(step(500));
    assert_true(camera_watch_is_lost(&watch));
    expect_news("camera v4l2:/dev/video9: gives frames that it gave before");
    assert_int_equal(watch.seq, 3);
    fake.same_time = false;
    assert_true(step(33));
    assert_int_equal(watch.seq, 3 + 15 + 1);
}

static void refused_frames_are_none(void **state)
{
    (void)state;
    camera_frame got;
    start_and_take(3);
    for (int i = 0; i < 20; i++) {
        fake.now_ns += 33 * ms;
        assert_true(camera_watch_next(&watch, &settings, fake.now_ns, &got));
        camera_watch_refuse(&watch, &got, "is not to be believed", fake.now_ns);
        camera_watch_release(&watch);
    }
    assert_true(camera_watch_is_lost(&watch));
    expect_news("camera v4l2:/dev/video9: is not to be believed");
    assert_true(step(33));
    assert_int_equal(watch.seq, 3 + 20 + 1);
    expect_news("camera v4l2:/dev/video9: gives frames again");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(frames_are_numbered_with_those_left_out, begin),
        cmocka_unit_test_setup(absent_camera_is_opened_again_at_growing_intervals, begin),
        cmocka_unit_test_setup(unplugged_camera_comes_back, begin),
        cmocka_unit_test_setup(frozen_camera_is_lost_and_opened_again, begin),
        cmocka_unit_test_setup(slow_camera_is_not_lost, begin),
        cmocka_unit_test_setup(camera_that_refuses_is_waited_for, begin),
        cmocka_unit_test_setup(recording_ends, begin),
        cmocka_unit_test_setup(recording_is_repeated, begin),
        cmocka_unit_test_setup(empty_recording_is_not_repeated, begin),
        cmocka_unit_test_setup(absent_recording_is_an_error, begin),
        cmocka_unit_test_setup(camera_that_takes_long_to_open_is_lost_meanwhile, begin),
        cmocka_unit_test_setup(camera_that_hangs_when_opened_is_told_of_once, begin),
        cmocka_unit_test_setup(camera_that_hangs_when_closed_is_not_opened_again, begin),
        cmocka_unit_test_setup(camera_that_hangs_does_not_hold_up_another_one, begin),
        cmocka_unit_test_setup(same_time_is_no_frame, begin),
        cmocka_unit_test_setup(refused_frames_are_none, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
