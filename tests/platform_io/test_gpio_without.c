/* GPIO lines in a build without libgpiod. */
#include "gpio_lines.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void add_chip(void *context, const gpio_chip_description *description)
{
    (void)description;
    ++*(int *)context;
}

static void test_there_are_no_chips(void **state)
{
    (void)state;
    int chips = 0;
    gpio_list(add_chip, &chips);
    assert_int_equal(chips, 0);
}

static void test_opening_says_why_not(void **state)
{
    (void)state;
    error_text error = {""};
    assert_null(gpio_output_open("gpiochip0:1", &error));
    assert_non_null(strstr(error.text, "built without libgpiod"));
    error.text[0] = '\0';
    assert_null(gpio_input_open("gpiochip0:1", &error));
    assert_non_null(strstr(error.text, "built without libgpiod"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_there_are_no_chips),
        cmocka_unit_test(test_opening_says_why_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
