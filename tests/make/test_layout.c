/* Layouts of lines whose outcome is known. */
#include "make_test.h"

#include <math.h>

/* The layout as text: a TM by its code, a CM that stands alone by a dot, lines with a bar between them. */
static void describe(const tape_layout *layout, char *text, size_t size)
{
    size_t length = 0, line = 0;
    text[0] = '\0';
    for (size_t i = 0; i < layout->segment_count; i++) {
        const layout_segment *segment = &layout->segments[i];
        const char *separator = i == 0 ? "" : segment->line != line ? "|" : " ";
        line = segment->line;
        length += (size_t)snprintf(text + length, size - length, "%s%s", separator, segment->bars ? "" : ".");
        for (size_t slot = 0; segment->bars && slot < segment->cm_count; slot++)
            length += (size_t)snprintf(text + length, size - length, "%c",
                                       layout->ids[segment->first_cm + slot] >= 0 ? '1' : '0');
    }
}

static void expect_layout(const plan *wanted, const char *expected)
{
    tape_layout layout;
    error_text error = {""};
    char text[1000];
    if (!layout_make(wanted, &layout, &error))
        fail_msg("%s", error.text);
    describe(&layout, text, sizeof text);
    assert_string_equal(text, expected);
    layout_release(&layout);
}

static void expect_line(double modules, const char *expected)
{
    plan wanted = plan_of_modules(&modules, 1);
    expect_layout(&wanted, expected);
    plan_release(&wanted);
}

static void sixes_then_what_fits_then_single_cms(void **state)
{
    (void)state;
    expect_line(34, ".");
    expect_line(67, ".");
    expect_line(68, ". .");
    expect_line(101, ". .");
    expect_line(102, "100");
    expect_line(126, "100");
    expect_line(127, "1000");
    expect_line(136, "1000");
    expect_line(152, "10000");
    expect_line(177, "100000");
    expect_line(202, "100000");
    expect_line(211, "100000 .");
    expect_line(177 + 152 + 24, "100000 10000");
    expect_line(2 * 177 + 151, "100000 010000 1000");
}

/* Noise of a nanometre must not lose a CM, and a tenth of a millimetre is no noise. */
static void lengths_are_exact_to_a_micrometre(void **state)
{
    static const double boundaries[] = {34, 68, 102, 127, 152, 177, 211, 1000 * 177};
    error_text error;
    (void)state;
    for (size_t i = 0; i < COUNT_OF(boundaries); i++) {
        plan wanted = plan_of_modules(&boundaries[i], 1);
        double exact_m = wanted.lines[0].to.x_m;
        wanted.lines[0].to.x_m = exact_m - 1e-9;
        assert_int_equal(plan_line_modules(&wanted, &wanted.lines[0]), (uint32_t)boundaries[i]);
        wanted.lines[0].to.x_m = exact_m + 1e-9;
        assert_int_equal(plan_line_modules(&wanted, &wanted.lines[0]), (uint32_t)boundaries[i]);
        wanted.lines[0].to.x_m = exact_m - 1e-4;
        assert_int_equal(plan_line_modules(&wanted, &wanted.lines[0]), (uint32_t)boundaries[i] - 1);
        if (i == 0) {
            assert_false(plan_line_holds_cm(&wanted, &wanted.lines[0], &error));
            assert_non_null(strstr(error.text, "is shorter than a CM, which takes 0.29143 m"));
            expect_layout(&wanted, "");
            wanted.lines[0].to.x_m = exact_m;
            assert_true(plan_line_holds_cm(&wanted, &wanted.lines[0], &error));
            expect_layout(&wanted, ".");
        }
        plan_release(&wanted);
    }
}

static void ids_ascend_with_signs_as_the_codes_say(void **state)
{
    static const double lines[] = {177 + 34, 102};
    static const int32_t ids[] = {0, -1, -2, -3, -4, -5, 6, 7, -8, -9};
    tape_layout layout;
    (void)state;
    plan wanted = lay_modules(lines, COUNT_OF(lines), &layout);
    assert_int_equal(layout.cm_count, COUNT_OF(ids));
    assert_memory_equal(layout.ids, ids, sizeof ids);
    assert_int_equal(layout.segment_count, 3);
    assert_int_equal(layout.segments[0].start_modules, 2);
    assert_int_equal(layout.segments[1].start_modules, 177 + 1);
    assert_int_equal(layout.segments[2].start_modules, 2);
    assert_int_equal(layout.segments[2].line, 1);
    assert_int_equal(layout.segments[2].first_cm, 7);
    assert_int_equal(layout_cm_start_modules(&layout.segments[0], 0), 2 + 8);
    assert_int_equal(layout_cm_start_modules(&layout.segments[0], 5), 2 + 8 + 5 * 25);
    assert_int_equal(layout_cm_start_modules(&layout.segments[1], 0), 177 + 1);
    layout_release(&layout);
    plan_release(&wanted);
}

static void the_id_zero_is_never_negative(void **state)
{
    double modules = 8 * 102;
    (void)state;
    plan wanted = plan_of_modules(&modules, 1);
    wanted.tm_cms = wanted.tm_cms_max = 3;
    wanted.camera_upright = true;
    expect_layout(&wanted, "100 000 010 001 110 101 011 111");
    wanted.first_id = 1;
    expect_layout(&wanted, "000 100 010 001 110 101 011 111");
    plan_release(&wanted);
}

static void longer_tms_when_codes_run_out_then_shorter_ones(void **state)
{
    double modules = 7 * 177 + 12;
    (void)state;
    plan wanted = plan_of_modules(&modules, 1);
    wanted.tm_cms = 3;
    expect_layout(&wanted, "100 110 1000 0100 1100 1010 1110 1101 10000 . . .");
    wanted.tm_cms_max = 4;
    expect_layout(&wanted, "100 110 1000 0100 1100 1010 1110 1101 . . . . . . . .");
    wanted.tm_cms = 4;
    expect_layout(&wanted, "1000 0100 1100 1010 1110 1101 100 110 . . . . . . . .");
    plan_release(&wanted);
}

static void codeless_tape_is_counted(void **state)
{
    double modules[2] = {7 * 177 + 12, 101};
    tape_layout layout;
    error_text error;
    (void)state;
    plan wanted = plan_of_modules(modules, 2);
    wanted.tm_cms = wanted.tm_cms_max = 4;
    assert_true(layout_make(&wanted, &layout, &error));
    assert_int_equal(layout.codeless_cms, 8);
    layout_release(&layout);
    plan_release(&wanted);
}

static void promised_tms_without_codes_are_an_error(void **state)
{
    double modules = 7 * 177 + 12;
    tape_layout layout;
    error_text error;
    (void)state;
    plan wanted = plan_of_modules(&modules, 1);
    wanted.tm_cms = wanted.tm_cms_max = 4;
    wanted.tm_required = true;
    assert_false(layout_make(&wanted, &layout, &error));
    assert_null(layout.ids);
    /* 6 x 127 and 2 x 102 modules are TMs, 8 x 34 are not. */
    assert_non_null(strstr(error.text, "codes of 3 to 4 CMs cover 8.3 m of the 10.6 m wanted; allow longer TMs"));
    wanted.tm_cms_max = 5;
    assert_true(layout_make(&wanted, &layout, &error));
    layout_release(&layout);

    /* What is too short for the wanted TMs was not promised. */
    double threes[] = {102, 102, 102};
    plan shorts = plan_of_modules(threes, COUNT_OF(threes));
    shorts.tm_required = true;
    expect_layout(&shorts, "100|110|. . .");
    plan_release(&shorts);
    plan_release(&wanted);
}

static void ids_that_run_out_are_an_error(void **state)
{
    double modules = 177 + 34;
    tape_layout layout;
    error_text error;
    (void)state;
    plan wanted = plan_of_modules(&modules, 1);
    wanted.first_id = TAPEMARK_MAX_ID - 6;
    assert_true(layout_make(&wanted, &layout, &error));
    assert_int_equal(layout.ids[6], TAPEMARK_MAX_ID);
    layout_release(&layout);
    wanted.first_id = TAPEMARK_MAX_ID - 5;
    assert_false(layout_make(&wanted, &layout, &error));
    assert_non_null(strstr(error.text, "ids end at 1505582: from 1505577 on they cover 1.5 m of the 1.8 m wanted"));
    wanted.first_id = TAPEMARK_MAX_ID - 4;
    assert_false(layout_make(&wanted, &layout, &error));
    assert_non_null(strstr(error.text, "cover 0.0 m"));
    wanted.cms_wanted = 6;
    assert_false(layout_make(&wanted, &layout, &error));
    assert_string_equal(error.text, "ids end at 1505582: from 1505578 on they do for 5 of the 6 CMs wanted");
    plan_release(&wanted);
}

static void so_many_cms_as_are_wanted(void **state)
{
    static const struct {
        uint32_t cms;
        const char *layout;
    } cases[] = {{1, "."}, {2, ". ."}, {3, "100"}, {5, "10000"}, {6, "100000"}, {7, "100000 ."}, {8, "100000 . ."},
                 {9, "100000 100"}, {17, "100000 010000 10000"}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        double modules = 34 * (cases[i].cms + 1);
        plan wanted = plan_of_modules(&modules, 1);
        wanted.cms_wanted = cases[i].cms;
        expect_layout(&wanted, cases[i].layout);
        plan_release(&wanted);
    }
}

/* 10 CMs a TM, all 1024 codes: the 2355 m that the marker's inventors name, at their pitch of 0.23 m a CM. */
static void ten_cms_a_tm_cover_two_kilometres(void **state)
{
    double modules = 1025 * 277;
    tape_layout layout;
    error_text error;
    (void)state;
    for (int upright = 0; upright <= 1; upright++) {
        plan wanted = plan_of_modules(&modules, 1);
        wanted.tm_cms = wanted.tm_cms_max = 10;
        wanted.camera_upright = upright == 1;
        assert_true(layout_make(&wanted, &layout, &error));
        size_t tens = upright == 1 ? 1024 : 496;
        assert_int_equal(layout.segments[tens - 1].cm_count, 10);
        assert_int_equal(layout.segments[tens].cm_count, 9);
        double covered_m = layout.segments[tens].start_modules * wanted.module_mm / 1000;
        assert_true((covered_m > 2355) == (upright == 1));
        layout_release(&layout);
        plan_release(&wanted);
    }
}

static void a_promise_ends_where_all_codes_are_used(void **state)
{
    /* There are 2 codes of 3 CMs, which take 102 modules each, 6 of 4, 12 of 5, 28 of 6, 56 of 7, 120 of 8. */
    static const double up_to[] = {[6] = 28 * 177 + 12 * 152 + 6 * 127 + 2 * 102,
                                   [7] = 28 * 177 + 56 * 202 + 12 * 152 + 6 * 127 + 2 * 102,
                                   [8] = 28 * 177 + 56 * 202 + 120 * 227 + 12 * 152 + 6 * 127 + 2 * 102};
    error_text error;
    tape_layout layout;
    (void)state;
    for (unsigned most = 6; most <= 8; most++) {
        plan wanted = plan_of_modules(&up_to[most], 1);
        wanted.tm_cms_max = most;
        wanted.tm_required = true;
        assert_true(layout_make(&wanted, &layout, &error));
        layout_release(&layout);
        wanted.lines[0].to.x_m += 177 * wanted.module_mm / 1000;
        assert_false(layout_make(&wanted, &layout, &error));
        assert_non_null(strstr(error.text, "allow longer TMs"));
        plan_release(&wanted);
    }
}

/* Lines that are too short are not helped by longer TMs. */
static void the_longest_tms_cannot_be_longer(void **state)
{
    static const double lines[3] = {102, 102, 102};
    error_text error;
    tape_layout layout;
    (void)state;
    plan wanted = plan_of_modules(lines, 3);
    wanted.tm_cms = 3;
    wanted.tm_cms_max = TAPEMARK_TM_MAX_CMS;
    wanted.tm_required = true;
    assert_false(layout_make(&wanted, &layout, &error));
    assert_non_null(strstr(error.text, "wanted; leave tm_cms_max out"));
    plan_release(&wanted);
}

static void all_ids_are_laid_in_no_time(void **state)
{
    double lines[150];
    tape_layout layout;
    error_text error;
    (void)state;
    for (size_t i = 0; i < COUNT_OF(lines); i++)
        lines[i] = 277000;
    plan wanted = plan_of_modules(lines, COUNT_OF(lines));
    assert_false(layout_make(&wanted, &layout, &error));
    assert_non_null(strstr(error.text, "ids end at 1505582"));
    wanted.line_count = 130;
    assert_true(layout_make(&wanted, &layout, &error));
    assert_true(layout.cm_count > 1300000);
    /* Codes as long as the rest of a line run out first: only line ends are without. */
    assert_true(layout.codeless_cms < 130 * 10);
    layout_release(&layout);
    plan_release(&wanted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sixes_then_what_fits_then_single_cms),
        cmocka_unit_test(lengths_are_exact_to_a_micrometre),
        cmocka_unit_test(ids_ascend_with_signs_as_the_codes_say),
        cmocka_unit_test(the_id_zero_is_never_negative),
        cmocka_unit_test(longer_tms_when_codes_run_out_then_shorter_ones),
        cmocka_unit_test(codeless_tape_is_counted),
        cmocka_unit_test(promised_tms_without_codes_are_an_error),
        cmocka_unit_test(ids_that_run_out_are_an_error),
        cmocka_unit_test(so_many_cms_as_are_wanted),
        cmocka_unit_test(ten_cms_a_tm_cover_two_kilometres),
        cmocka_unit_test(a_promise_ends_where_all_codes_are_used),
        cmocka_unit_test(the_longest_tms_cannot_be_longer),
        cmocka_unit_test(all_ids_are_laid_in_no_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
