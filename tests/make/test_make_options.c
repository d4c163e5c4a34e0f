/* The command line of tapemark-make: what it says, and what is wrong with others. */
#include "make_test.h"

#include <math.h>

#include "make_options.h"

enum { ARGUMENTS_MAX = 20 };

/* Splits at blanks; the answer borrows from the static copy. */
static make_answer parse(const char *line, make_options *options, error_text *error)
{
    static char copy[300];
    char *arguments[ARGUMENTS_MAX + 2] = {"tapemark-make"};
    int count = 1;
    snprintf(copy, sizeof copy, "%s", line);
    for (char *word = strtok(copy, " "); word != NULL && count < ARGUMENTS_MAX; word = strtok(NULL, " "))
        arguments[count++] = word;
    error->text[0] = '\0';
    return make_options_parse(count, arguments, options, error);
}

static make_options parse_right(const char *line)
{
    make_options options;
    error_text error;
    if (parse(line, &options, &error) != MAKE_RUN)
        fail_msg("%s: %s", line, error.text);
    return options;
}

static void expect_wrong(const char *line, const char *reason)
{
    make_options options;
    error_text error;
    make_answer answer = parse(line, &options, &error);
    make_options_release(&options);
    if (answer != MAKE_WRONG || strstr(error.text, reason) == NULL)
        fail_msg("%s: '%s' instead of '%s'", line, error.text, reason);
}

static bool about(double a, double b)
{
    return fabs(a - b) < 1e-9;
}

static void a_plan_with_defaults(void **state)
{
    (void)state;
    make_options options = parse_right("plan.json -o out");
    assert_string_equal(options.plan_path, "plan.json");
    assert_string_equal(options.output_path, "out");
    assert_int_equal(options.print.paper, PRINT_A4);
    assert_true(options.print.scale_x == 0 && options.print.scale_y == 0);
    assert_null(options.print.only);
    assert_false(options.svg || options.paper_map || options.quiet || options.print.without_labels);
    assert_true(options.png_dpi == 0 && options.pgm_dpi == 0);
    make_options_release(&options);
}

static void a_quick_tape_with_all(void **state)
{
    (void)state;
    make_options options = parse_right("--cms 9 --module 8.5mm --first-id 100 --tm-cms 4 --tm-cms-max 9 "
                                       "--camera-upright --paper roll --scale-x 100.3% --output out");
    assert_null(options.plan_path);
    assert_int_equal(options.quick.cms_wanted, 9);
    assert_true(about(options.quick.module_mm, 8.5));
    assert_int_equal(options.quick.first_id, 100);
    assert_int_equal(options.quick.tm_cms, 4);
    assert_int_equal(options.quick.tm_cms_max, 9);
    assert_true(options.quick.tm_required && options.quick.camera_upright);
    assert_int_equal(options.print.paper, PRINT_ROLL);
    assert_true(about(options.print.scale_x, 1.003) && options.print.scale_y == 0);
    make_options_release(&options);

    options = parse_right("--line 3.2m -o out --measured 99.4mm --only 17..20,-5,-7..-9 --svg --png 300 --pgm 77.5 "
                          "--no-labels --paper-map --quiet");
    assert_true(about(options.quick_length_m, 3.2) && options.quick.cms_wanted == 0);
    assert_true(about(options.quick.module_mm, 60.0 / 7));
    assert_int_equal(options.quick.tm_cms, 6);
    assert_int_equal(options.quick.tm_cms_max, 32);
    assert_false(options.quick.tm_required);
    assert_true(about(options.print.scale_x, 100 / 99.4) && options.print.scale_x == options.print.scale_y);
    static const print_id_range ranges[] = {{17, 20}, {5, 5}, {7, 9}};
    assert_int_equal(options.print.only_count, COUNT_OF(ranges));
    assert_memory_equal(options.print.only, ranges, sizeof ranges);
    assert_true(options.svg && options.paper_map && options.quiet && options.print.without_labels);
    assert_true(options.png_dpi == 300 && options.pgm_dpi == 77.5);
    make_options_release(&options);
}

static void lengths_have_units(void **state)
{
    static const struct {
        const char *line;
        double length_m;
    } cases[] = {{"--line 320cm -o o", 3.2}, {"--line 3200mm -o o", 3.2}, {"--line .5m -o o", 0.5},
                 {"--line 10in -o o", 0.254}, {"--line 2500m -o o", 2500}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        make_options options = parse_right(cases[i].line);
        assert_true(about(options.quick_length_m, cases[i].length_m));
        make_options_release(&options);
    }
    static const char *const wrong[] = {"3.2", "m", "-3m", "0x10m", "infm", "nanm", "1e3m", "3,2m", "3.2km",
                                        "3.2mm5", "3.2.1m", "3.2M"};
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        char line[60];
        snprintf(line, sizeof line, "--line %s -o o", wrong[i]);
        expect_wrong(line, "--line: expected a length in m, cm, mm or in from 0.0001m to 2500m, not \"");
    }
    static const char *const bounds[] = {"--height 0.7mm", "--height 1050mm", "--module 0.1mm", "--module 15cm",
                                         "--measured 90mm", "--measured 11cm", "--scale 90%", "--scale 110%"};
    for (size_t i = 0; i < COUNT_OF(bounds); i++) {
        char line[60];
        snprintf(line, sizeof line, "%s --cms 1 -o o", bounds[i]);
        make_options options = parse_right(line);
        make_options_release(&options);
    }
    expect_wrong("--line 0m -o o", "--line: expected a length in m, cm, mm or in from 0.0001m to 2500m, not \"0m\"");
    expect_wrong("--line 2501m -o o", "from 0.0001m to 2500m");
    expect_wrong("--line 99999999999999999999999999999999999999999m -o o", "from 0.0001m to 2500m");
    expect_wrong("--cms 1 -o o --module 0.0086mm", "from 0.1mm to 150mm, not \"0.0086mm\"");
    expect_wrong("--cms 1 -o o --height 1.06m", "from 0.0007m to 1.05m, not \"1.06m\"");
}

static void numbers_have_ranges(void **state)
{
    (void)state;
    expect_wrong("--cms 0 -o o", "--cms: expected a whole number from 1 to 100000, not \"0\"");
    expect_wrong("--cms 100001 -o o", "--cms: expected a whole number");
    expect_wrong("--cms 1.5 -o o", "--cms: expected a whole number");
    expect_wrong("--cms six -o o", "--cms: expected a whole number");
    expect_wrong("--cms 99999999999999999999999 -o o", "--cms: expected a whole number");
    expect_wrong("--cms 1 --first-id 1505583 -o o", "--first-id: expected a whole number from 0 to 1505582");
    expect_wrong("--cms 1 --first-id -1 -o o", "--first-id: expected a whole number");
    expect_wrong("--cms 1 --tm-cms 2 -o o", "--tm-cms: expected a whole number from 3 to 32");
    expect_wrong("--cms 1 --tm-cms 33 -o o", "--tm-cms: expected");
    expect_wrong("--cms 1 --tm-cms 8 --tm-cms-max 7 -o o", "--tm-cms-max 7 is less than the 8 CMs of --tm-cms");
    expect_wrong("--cms 1 -o o --scale 100", "--scale: expected a percentage from 90% to 110%, not \"100\"");
    expect_wrong("--cms 1 -o o --scale-y 1003%", "--scale-y: expected a percentage from 90% to 110%");
    expect_wrong("--cms 1 -o o --measured 10cm5", "--measured: expected a length");
    expect_wrong("--cms 1 -o o --measured 9.94mm", "from 90mm to 110mm, not \"9.94mm\"");
    expect_wrong("--cms 1 -o o --png 0", "--png: expected a number from 1 to 4800, not \"0\"");
    expect_wrong("--cms 1 -o o --pgm 300dpi", "--pgm: expected a number");
    expect_wrong("--cms 1 -o o --paper a5", "--paper: expected a4, a3, letter or roll, not \"a5\"");
}

static void ranges_of_ids(void **state)
{
    static const char *const wrong[] = {",", "1,", ",1", "1..", "..2", "2..1", "1...3", "1..2..3", "a", "1505583",
                                        "1..1505583", "12345678901234567890", "--1", "1,,2", "1;2"};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        char line[60];
        snprintf(line, sizeof line, "--cms 9 -o o --only %s", wrong[i]);
        expect_wrong(line, "--only: expected ids such as 17..20 or 5,17..20");
    }
}

static void options_that_do_not_go_together(void **state)
{
    (void)state;
    expect_wrong("", "expected one of PLAN.json, --line and --cms, not none");
    expect_wrong("-o o", "not none");
    expect_wrong("plan.json other.json -o o", "not several");
    expect_wrong("plan.json --cms 3 -o o", "not several");
    expect_wrong("--line 3m --cms 3 -o o", "not several");
    expect_wrong("plan.json", "-o DIRECTORY is missing");
    expect_wrong("plan.json -o o --module 8mm", "--module is for --line and --cms: a plan says it itself");
    expect_wrong("plan.json -o o --camera-upright", "--camera-upright is for --line and --cms");
    expect_wrong("--cms 3 -o o --module 8mm --height 60mm", "--height and --module say the same");
    expect_wrong("--cms 3 -o o --scale 101% --measured 99mm", "--measured and --scale say the same");
    expect_wrong("--cms 3 -o o --scale 101% --scale-y 101%", "--scale and --scale-y say the same");
    expect_wrong("--cms 3 --cms 4 -o o", "--cms is given twice");
    expect_wrong("--cms 3 -o a --output b", "--output is given twice");
    expect_wrong("--cms", "--cms needs a value");
    expect_wrong("--cms 3 -o", "-o needs a value");
    expect_wrong("--frobnicate", "option '--frobnicate' is unknown");
    expect_wrong("--svg=3 --cms 3 -o o", "option '--svg=3' is unknown, ambiguous or takes no value");
    expect_wrong("-x", "unknown option '-x'");
}

static void help_and_version_come_first(void **state)
{
    make_options options;
    error_text error;
    (void)state;
    assert_int_equal(parse("--help", &options, &error), MAKE_HELP);
    assert_int_equal(parse("--version --frobnicate", &options, &error), MAKE_VERSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plan_with_defaults),
        cmocka_unit_test(a_quick_tape_with_all),
        cmocka_unit_test(lengths_have_units),
        cmocka_unit_test(numbers_have_ranges),
        cmocka_unit_test(ranges_of_ids),
        cmocka_unit_test(options_that_do_not_go_together),
        cmocka_unit_test(help_and_version_come_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
