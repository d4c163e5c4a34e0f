/* The GPIO lines, with a fake in the place of the chips. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "signal_lines.h"

static const int64_t ms = 1000000;

/* A strobe's thread writes; but for `flashes`, the test reads when that thread has ended. */
static struct {
    unsigned opened, refused, closed, sets, events;
    atomic_uint flashes;
    bool on, broken, all_are_there;
    int64_t on_ns, off_ns;  /* when it last went on and off */
} fake;

static char memory;

gpio_output *__wrap_gpio_output_open(const char *name, error_text *error)
{
    const bool there = strcmp(name, "0:9") != 0 || fake.all_are_there;
    error_text_set(error, "is in use");
    fake.opened += there;
    fake.refused += !there;
    return there ? (gpio_output *)(void *)&memory : NULL;
}

bool __wrap_gpio_output_set(gpio_output *line, bool on, error_text *error)
{
    (void)line;
    fake.sets++;
    if (fake.broken) {
        fake.broken = false;
        error_text_set(error, "is gone");
        return false;
    }
    if (on)
        fake.on_ns = camera_clock_ns();
    else
        fake.off_ns = camera_clock_ns();
    fake.on = on;
    atomic_fetch_add(&fake.flashes, on);
    return true;
}

void __wrap_gpio_output_close(gpio_output *line)
{
    fake.closed += line != NULL;
}

gpio_input *__wrap_gpio_input_open(const char *name, error_text *error)
{
    (void)name;
    (void)error;
    fake.opened++;
    return (gpio_input *)(void *)&memory;
}

int __wrap_gpio_input_descriptor(const gpio_input *line)
{
    (void)line;
    return 17;
}

bool __wrap_gpio_input_events(gpio_input *line, unsigned *count, error_text *error)
{
    (void)line;
    error_text_set(error, "is gone");
    *count = fake.events;
    fake.events = 0;
    return !fake.broken;
}

void __wrap_gpio_input_close(gpio_input *line)
{
    fake.closed += line != NULL;
}

static int begin(void **state)
{
    (void)state;
    memset(&fake, 0, sizeof fake);
    return 0;
}

static void sleep_until(int64_t time_ns)
{
    const struct timespec when = {(time_t)(time_ns / 1000000000), (long)(time_ns % 1000000000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &when, NULL);
}

/* ---- Tests -------------------------------------------------------------------------------------------------- */

static void lines_that_are_not_named_cost_nothing(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings none = {0};
    const camera_frame got = {.image = {.time_ns = 1}};
    signal_lines_open(&lines, &none);
    signal_lines_show_seen(&lines, true);
    signal_lines_foretell(&lines, &got, 2);
    assert_false(signal_lines_triggered(&lines));
    assert_int_equal(signal_lines_descriptor(&lines), -1);
    signal_lines_close(&lines);
    assert_int_equal(fake.opened + fake.sets + lines.failures, 0);
}

static void seen_is_shown_and_lines_are_given_back(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings wanted = {.seen = "0:4", .strobe = "0:5", .trigger = "0:6"};
    signal_lines_open(&lines, &wanted);
    assert_int_equal(fake.opened, 3);
    signal_lines_show_seen(&lines, true);
    assert_true(fake.on);
    signal_lines_show_seen(&lines, false);
    assert_false(fake.on);
    fake.events = 2;
    assert_int_equal(signal_lines_descriptor(&lines), 17);
    assert_true(signal_lines_triggered(&lines));
    assert_false(signal_lines_triggered(&lines));
    signal_lines_open(&lines, &wanted);
    assert_int_equal(fake.closed, 3);
    signal_lines_close(&lines);
    assert_int_equal(fake.closed, 6);
}

static void line_that_fails_is_counted(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings wanted = {.seen = "0:4", .strobe = "0:9"};
    signal_lines_open(&lines, &wanted);
    assert_int_equal(lines.failures, 1);
    assert_null(lines.strobe);
    assert_false(signal_lines_are_whole(&lines, &wanted));
    fake.broken = true;
    signal_lines_show_seen(&lines, true);
    assert_int_equal(lines.failures, 2);
    assert_int_equal(fake.closed, 1);
    signal_lines_show_seen(&lines, true);
    signal_lines_close(&lines);
    assert_int_equal(lines.failures, 2);
    assert_int_equal(fake.closed, 1);
}

/* Every few seconds, and with one failure counted in all. */
static void lines_that_are_missing_are_asked_for_again(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings wanted = {.seen = "0:9", .strobe = "0:9", .trigger = "0:6"};
    signal_lines_open(&lines, &wanted);
    const int64_t now_ns = camera_clock_ns();
    assert_int_equal(fake.refused, 2);
    signal_lines_try_again(&lines, &wanted, now_ns + 1000 * ms);
    assert_int_equal(fake.refused, 2);
    signal_lines_try_again(&lines, &wanted, now_ns + 4000 * ms);
    signal_lines_try_again(&lines, &wanted, now_ns + 5000 * ms);
    assert_int_equal(fake.refused, 4);
    fake.broken = true;
    assert_false(signal_lines_triggered(&lines));
    fake.broken = false;
    fake.all_are_there = true;
    assert_int_equal(fake.opened, 1);
    signal_lines_try_again(&lines, &wanted, now_ns + 10000 * ms);
    assert_int_equal(fake.opened, 4);
    assert_true(signal_lines_are_whole(&lines, &wanted));
    signal_lines_try_again(&lines, &wanted, now_ns + 20000 * ms);
    assert_int_equal(fake.opened, 4);
    assert_int_equal(lines.failures, 3);
    signal_lines_close(&lines);
    assert_int_equal(fake.closed, 4);
}

static void trigger_that_fails_is_given_back_and_may_be_had_again(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings wanted = {.trigger = "0:6"};
    signal_lines_open(&lines, &wanted);
    assert_true(signal_lines_are_whole(&lines, &wanted));
    fake.broken = true;
    assert_false(signal_lines_triggered(&lines));
    assert_false(signal_lines_triggered(&lines));
    assert_int_equal(lines.failures, 1);
    assert_int_equal(fake.closed, 1);
    assert_int_equal(signal_lines_descriptor(&lines), -1);
    assert_false(signal_lines_are_whole(&lines, &wanted));
    fake.broken = false;
    signal_lines_open(&lines, &wanted);
    assert_true(signal_lines_are_whole(&lines, &wanted));
    signal_lines_close(&lines);
    assert_int_equal(lines.failures, 1);
}

/* It fails in its thread, and is given back with the next frame. */
static void strobe_that_fails_is_given_back(void **state)
{
    (void)state;
    signal_lines lines = {0};
    const gpio_settings wanted = {.strobe = "0:5"};
    const int64_t now_ns = camera_clock_ns();
    camera_frame got = {.image = {.time_ns = now_ns - 20 * ms}, .exposure_us = 2000000};
    signal_lines_open(&lines, &wanted);
    fake.broken = true;
    signal_lines_foretell(&lines, &got, now_ns);
    got.image.time_ns = now_ns - 10 * ms;
    signal_lines_foretell(&lines, &got, now_ns);
    for (int i = 0; i < 1500 && lines.failures == 0; i++) {
        sleep_until(camera_clock_ns() + 20 * ms);
        got.image.time_ns = FRAME_TIME_UNKNOWN;
        signal_lines_foretell(&lines, &got, camera_clock_ns());
    }
    assert_int_equal(lines.failures, 1);
    assert_int_equal(fake.closed, 1);
    assert_null(lines.strobe);
    signal_lines_close(&lines);
    assert_int_equal(fake.closed, 1);
}

static bool is_within(int64_t value, int64_t least, int64_t most)
{
    return value >= least && value <= most;
}

/* A frame every 100 ms, exposed for 20 ms; told 30 ms after the middle of its exposure. Whether it flashed, and that
 * in time. */
static bool flashes_around_the_next_exposure(void)
{
    signal_lines lines = {0};
    const gpio_settings wanted = {.strobe = "0:5"};
    const int64_t first_ns = camera_clock_ns();
    const camera_frame before = {.image = {.time_ns = first_ns - 200 * ms}, .exposure_us = 20000};
    const camera_frame got = {.image = {.time_ns = first_ns}, .dropped = 1, .exposure_us = 20000};
    memset(&fake, 0, sizeof fake);
    signal_lines_open(&lines, &wanted);
    signal_lines_foretell(&lines, &before, first_ns - 170 * ms);
    assert_int_equal(fake.sets, 0);
    signal_lines_foretell(&lines, &got, first_ns + 30 * ms);
    sleep_until(first_ns + 160 * ms);
    signal_lines_close(&lines);
    const int64_t next_ns = first_ns + 100 * ms, late_ns = 8 * ms;
    assert_false(fake.on);
    return fake.sets == 2 && is_within(fake.on_ns, next_ns - 11 * ms, next_ns - 10 * ms + late_ns) &&
           is_within(fake.off_ns, next_ns + 10 * ms, next_ns + 10 * ms + late_ns);
}

/* On a busy machine, a thread may be late now and then. */
static void strobe_is_on_around_the_next_exposure(void **state)
{
    (void)state;
    bool done = false;
    for (int tries = 0; tries < 20 && !done; tries++)
        done = flashes_around_the_next_exposure();
    assert_true(done);
}

/* A frame tells of the next exposure, then no frame comes. Whether the last of the flashes was in time. */
static bool flashes_go_on_for_a_while(void)
{
    enum { FLASHES = 4, PERIOD_MS = 50 };
    error_text error;
    memset(&fake, 0, sizeof fake);
    strobe *flash = strobe_open((gpio_output *)(void *)&memory, &error);
    assert_non_null(flash);
    const int64_t on_ns = camera_clock_ns() + PERIOD_MS * ms, period_ns = PERIOD_MS * ms;
    /* Of the exposure behind it; that one is not forgotten for it. */
    strobe_plan(flash, &(strobe_times){on_ns, on_ns + 20 * ms, period_ns});
    strobe_plan(flash, &(strobe_times){on_ns + period_ns, on_ns + period_ns + 20 * ms, period_ns});
    sleep_until(on_ns + (FLASHES + 2) * period_ns);
    strobe_close(flash);
    const int64_t last_ns = on_ns + (FLASHES - 1) * period_ns;
    assert_true(fake.flashes <= FLASHES);
    assert_false(fake.on);
    return fake.flashes == FLASHES && is_within(fake.on_ns, last_ns, last_ns + 10 * ms);
}

static void strobe_lights_frames_behind_one_that_is_left_out(void **state)
{
    (void)state;
    bool done = false;
    for (int tries = 0; tries < 20 && !done; tries++)
        done = flashes_go_on_for_a_while();
    assert_true(done);
}

static void strobe_ends_with_the_line_off(void **state)
{
    (void)state;
    error_text error;
    strobe *flash = strobe_open((gpio_output *)(void *)&memory, &error);
    assert_non_null(flash);
    const int64_t now_ns = camera_clock_ns();
    strobe_plan(flash, &(strobe_times){now_ns, now_ns + 60000 * ms, 70000 * ms});
    while (atomic_load(&fake.flashes) == 0 && camera_clock_ns() < now_ns + 30000 * ms)
        sleep_until(camera_clock_ns() + ms);
    strobe_close(flash);
    assert_true(camera_clock_ns() < now_ns + 40000 * ms);
    assert_true(fake.on_ns > 0 && fake.off_ns >= fake.on_ns);
    assert_false(fake.on);
    assert_int_equal(fake.closed, 1);
}

static void strobe_that_comes_too_late_does_not_flash(void **state)
{
    (void)state;
    error_text error;
    strobe *flash = strobe_open((gpio_output *)(void *)&memory, &error);
    assert_non_null(flash);
    const int64_t now_ns = camera_clock_ns();
    strobe_plan(flash, &(strobe_times){now_ns - 20 * ms, now_ns - 10 * ms, 70000 * ms});
    sleep_until(now_ns + 50 * ms);
    strobe_close(flash);
    assert_int_equal(fake.sets, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(lines_that_are_not_named_cost_nothing, begin),
        cmocka_unit_test_setup(seen_is_shown_and_lines_are_given_back, begin),
        cmocka_unit_test_setup(line_that_fails_is_counted, begin),
        cmocka_unit_test_setup(lines_that_are_missing_are_asked_for_again, begin),
        cmocka_unit_test_setup(trigger_that_fails_is_given_back_and_may_be_had_again, begin),
        cmocka_unit_test_setup(strobe_that_fails_is_given_back, begin),
        cmocka_unit_test_setup(strobe_is_on_around_the_next_exposure, begin),
        cmocka_unit_test_setup(strobe_lights_frames_behind_one_that_is_left_out, begin),
        cmocka_unit_test_setup(strobe_ends_with_the_line_off, begin),
        cmocka_unit_test_setup(strobe_that_comes_too_late_does_not_flash, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
