/* GPIO lines; built once against each generation of libgpiod, and once without. */
#include "fake_gpiod.h"
#include "gpio_lines.h"

#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static fake_line *const led = &fake_chips[0].lines[1];
static fake_line *const button = &fake_chips[0].lines[2];

static void assert_told(const error_text *error, const char *part)
{
    if (strstr(error->text, part) == NULL || strchr(error->text, '\n') != NULL)
        fail_msg("the error is \"%s\", without \"%s\"", error->text, part);
}

static void assert_refused(const char *name, const char *part)
{
    error_text error = {""};
    gpio_output *line = gpio_output_open(name, &error);
    assert_null(line);
    assert_told(&error, part);
    assert_int_equal(fake_open_handles, 0);
}

static gpio_output *open_output(const char *name)
{
    error_text error = {""};
    gpio_output *line = gpio_output_open(name, &error);
    if (line == NULL)
        fail_msg("%s", error.text);
    return line;
}

static void test_an_output_is_off_until_told_otherwise(void **state)
{
    (void)state;
    error_text error;
    led->level = true;
    gpio_output *line = open_output("gpiochip0:1");
    assert_int_equal(led->use, FAKE_OUTPUT);
    assert_false(led->level);
    assert_true(gpio_output_set(line, true, &error));
    assert_true(led->level);
    assert_true(gpio_output_set(line, true, &error));
    assert_int_equal(led->set_calls, 1);
    gpio_output_close(line);
    assert_false(led->level);
    assert_int_equal(led->use, FAKE_FREE);
    assert_int_equal(fake_open_handles, 0);
}

static void test_low_and_pulls_reach_the_line(void **state)
{
    (void)state;
    error_text error;
    gpio_output *line = open_output("0:1:low:pull-up");
    assert_true(led->level);
    assert_int_equal(led->pull, 1);
    assert_true(gpio_output_set(line, true, &error));
    assert_false(led->level);
    gpio_output_close(line);
    line = open_output("0:1:pull-down");
    assert_int_equal(led->pull, -1);
    assert_false(led->active_low);
    gpio_output_close(line);
}

static void test_chips_and_lines_have_several_names(void **state)
{
    (void)state;
    static const char *const names[] = {"gpiochip0:1", "/dev/gpiochip0:1", "0:1", "soc:1", "soc:LED", "0:LED"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        gpio_output *line = open_output(names[i]);
        assert_int_equal(led->use, FAKE_OUTPUT);
        gpio_output_close(line);
    }
    gpio_output *line = open_output("expander:1");
    assert_int_equal(fake_chips[1].lines[1].use, FAKE_OUTPUT);
    gpio_output_close(line);
    assert_int_equal(fake_open_handles, 0);
}

static void test_what_cannot_be_opened_is_told(void **state)
{
    (void)state;
    assert_refused("gpiochip0:4", "lines 0 to 3");
    assert_refused("gpiochip0:LAMP", "no line with the name LAMP");
    assert_refused("gpiochip0:3", "in use");
    assert_refused("gpiochip1:0", "not there");
    assert_refused("nothing:0", "group gpio");
    assert_refused("gpiochip5:0", "group gpio");
}

static void test_names_that_make_no_sense_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {
        "", ":", "0", "0:", ":1", "gpiochip0:1:high", "gpiochip0:1:low:", "gpiochip0:1:low:x", "gpiochip0::low",
        "0:1:low:low", "0:1:pull-up:pull-down", "0:1::low", "0:1:low:pull-up:low",
        "a-name-of-a-chip-that-is-longer-than-any-that-the-kernel-would-ever-give:1",
    };
    error_text error;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (gpio_name_is_valid(names[i], &error))
            fail_msg("\"%s\" was taken", names[i]);
        assert_told(&error, "CHIP:LINE");
    }
    assert_true(gpio_name_is_valid("pinctrl-rp1:GPIO17:low:pull-up", &error));
}

static void test_an_output_that_fails_is_told_once(void **state)
{
    (void)state;
    error_text error = {""};
    gpio_output *line = open_output("0:1");
    fake_chips_fail = true;
    assert_false(gpio_output_set(line, true, &error));
    assert_told(&error, "No such device");
    assert_true(gpio_output_set(line, true, &error));
    assert_true(gpio_output_set(line, false, &error));
    assert_int_equal(led->set_calls, 1);
    fake_chips_fail = false;
    gpio_output_close(line);
    assert_int_equal(fake_open_handles, 0);
}

static unsigned count_events(gpio_input *line)
{
    error_text error;
    unsigned count;
    assert_true(gpio_input_events(line, &count, &error));
    return count;
}

static const int64_t ms = 1000000;

static void test_an_input_tells_how_often_it_went_on(void **state)
{
    (void)state;
    error_text error;
    gpio_input *line = gpio_input_open("soc:BUTTON:low:pull-up", &error);
    assert_non_null(line);
    button->level = true;
    assert_int_equal(count_events(line), 0);
    struct pollfd look = {gpio_input_descriptor(line), POLLIN, 0};
    assert_int_equal(poll(&look, 1, 0), 0);
    for (int i = 0; i < 3; i++) {
        fake_drive(button, false, 1000 * ms + i * 50 * ms);
        fake_drive(button, true, 1020 * ms + i * 50 * ms);
    }
    assert_int_equal(poll(&look, 1, 0), 1);
    assert_int_equal(count_events(line), 3);
    assert_int_equal(count_events(line), 0);
    gpio_input_close(line);
    assert_int_equal(fake_open_handles, 0);
}

/* A thousand times a second, for three seconds, and once more after a rest. */
static void test_an_input_that_bounces_went_on_once(void **state)
{
    (void)state;
    error_text error;
    gpio_input *line = gpio_input_open("soc:BUTTON", &error);
    assert_non_null(line);
    button->level = false;
    unsigned count = 0;
    for (int i = 0; i < 3000; i++) {
        fake_drive(button, true, i * ms);
        fake_drive(button, false, i * ms + ms / 2);
        if (i % 20 == 19)
            count += count_events(line);
    }
    struct pollfd look = {gpio_input_descriptor(line), POLLIN, 0};
    while (poll(&look, 1, 0) == 1)
        count += count_events(line);
    assert_int_equal(count, 1);
    fake_drive(button, true, 3048 * ms);
    fake_drive(button, false, 3049 * ms);
    assert_int_equal(count_events(line), 0);
    fake_drive(button, true, 3098 * ms);
    assert_int_equal(count_events(line), 1);
    gpio_input_close(line);
    assert_int_equal(fake_open_handles, 0);
}

static void test_an_input_that_fails_is_told_once(void **state)
{
    (void)state;
    error_text error = {""};
    unsigned count = 9;
    gpio_input *line = gpio_input_open("soc:BUTTON", &error);
    assert_non_null(line);
    button->level = false;
    fake_drive(button, true, 0);
    fake_chips_fail = true;
    assert_false(gpio_input_events(line, &count, &error));
    assert_int_equal(count, 0);
    assert_told(&error, "No such device");
    assert_int_equal(gpio_input_descriptor(line), -1);
    assert_int_equal(count_events(line), 0);
    fake_chips_fail = false;
    gpio_input_close(line);
    assert_int_equal(fake_open_handles, 0);
}

typedef struct chip_list {
    char text[200];
} chip_list;

static void add_chip(void *context, const gpio_chip_description *description)
{
    char *text = ((chip_list *)context)->text;
    snprintf(text + strlen(text), sizeof(chip_list) - strlen(text), "%s %s %u; ", description->name,
             description->label, description->line_count);
}

static void test_chips_are_listed_once_each(void **state)
{
    (void)state;
    chip_list list = {""};
    gpio_list(add_chip, &list);
    assert_string_equal(list.text, "gpiochip0 soc 4; gpiochip2 expander 2; ");
    assert_int_equal(fake_open_handles, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_output_is_off_until_told_otherwise),
        cmocka_unit_test(test_low_and_pulls_reach_the_line),
        cmocka_unit_test(test_chips_and_lines_have_several_names),
        cmocka_unit_test(test_what_cannot_be_opened_is_told),
        cmocka_unit_test(test_names_that_make_no_sense_are_refused),
        cmocka_unit_test(test_an_output_that_fails_is_told_once),
        cmocka_unit_test(test_an_input_tells_how_often_it_went_on),
        cmocka_unit_test(test_an_input_that_bounces_went_on_once),
        cmocka_unit_test(test_an_input_that_fails_is_told_once),
        cmocka_unit_test(test_chips_are_listed_once_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
