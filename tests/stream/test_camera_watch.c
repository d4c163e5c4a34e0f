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
    bool absent, refuses;
    camera_status status;
    uint32_t dropped;
    unsigned opened, closed;
} fake;

static char device_memory;

camera *__wrap_camera_open(const char *name, error_text *error)
{
    (void)name;
    fake.opened += !fake.absent;
    error_text_set(error, "is not there");
    return fake.absent ? NULL : (camera *)(void *)&device_memory;
}

bool __wrap_camera_configure(camera *device, const camera_wishes *wishes, error_text *error)
{
    (void)device;
    (void)wishes;
    error_text_set(error, "does not want to");
    return !fake.refuses;
}

camera_status __wrap_camera_next(camera *device, int timeout_ms, camera_frame *output, error_text *error)
{
    (void)device;
    assert_int_equal(timeout_ms, 0);
    *output = (camera_frame){.dropped = fake.dropped};
    if (fake.status == CAMERA_GONE)
        error_text_set(error, "was unplugged");
    return fake.status;
}

int __wrap_camera_descriptor(const camera *device)
{
    (void)device;
    return 42;
}

void __wrap_camera_close(camera *device)
{
    fake.closed += device != NULL;
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
    return camera_watch_next(&watch, &settings, fake.now_ns, &got);
}

static void start_and_take(unsigned frames)
{
    assert_true(camera_watch_begin(&watch, &settings, &message));
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
    assert_true(camera_watch_begin(&watch, &settings, &message));
    expect_news("camera v4l2:/dev/video9: is not there");
    assert_true(camera_watch_is_lost(&watch));
    assert_int_equal(camera_watch_descriptor(&watch), -1);
    int64_t last_pause_ms = 0;
    for (int i = 0; i < 8; i++) {
        const int64_t pause_ms = (camera_watch_wake_ns(&watch) - fake.now_ns) / ms;
        assert_true(pause_ms >= 500 && pause_ms <= 8000);
        assert_true(pause_ms >= last_pause_ms);
        last_pause_ms = pause_ms;
        assert_false(step(pause_ms));
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
    fake.absent = true;
    assert_false(step(10));
    expect_news("camera v4l2:/dev/video9: was unplugged");
    assert_true(camera_watch_is_lost(&watch));
    assert_int_equal(fake.closed, 1);
    assert_false(step(600));
    fake.absent = false;
    fake.status = CAMERA_TIMEOUT;
    assert_false(step(9000));
    assert_int_equal(fake.opened, 2);
    assert_true(camera_watch_is_lost(&watch));
    fake.status = CAMERA_FRAME;
    assert_true(step(100));
    assert_int_equal(watch.seq, 6);
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
    assert_int_equal(fake.closed, 1);
    for (int i = 0; i < 5; i++) {
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
    assert_true(camera_watch_begin(&watch, &settings, &message));
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
    assert_true(camera_watch_begin(&watch, &settings, &message));
    expect_news("camera v4l2:/dev/video9: does not want to");
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
    fake.status = CAMERA_FRAME;
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
    assert_false(camera_watch_begin(&watch, &settings, &message));
    assert_string_equal(message.text, "is not there");
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
