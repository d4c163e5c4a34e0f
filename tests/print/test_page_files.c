/* PDFs as files: their text, that they are the same each time, and what is told when they cannot be made. */
#include "printing.h"

#include <math.h>

static const unsigned codes[] = {32, 16, 8};

static void print_to(const hand_tape *tape, const print_settings *settings, const char *path)
{
    error_text error = {""};
    print_summary summary;
    if (!print_pdf(&tape->wanted, &tape->layout, settings, path, &summary, &error))
        fail_msg("%s", error.text);
}

static void pages_tell_what_is_on_them(void **state)
{
    static const int32_t ids[] = {17, -18, 19, -1505582};
    static const hand_segment segments[] = {{0, 3, true}, {1, 1, false}};
    (void)state;
    hand_tape tape = hand_tape_new(8, ids, segments, COUNT_OF(segments));
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf"), *text_path = path_in(folder, "text");
    char command[1200];
    print_to(&tape, &(print_settings){.paper = PRINT_A4}, path);
    snprintf(command, sizeof command, "'%s' -raw '%s' '%s'", TEST_PDFTOTEXT, path, text_path);
    assert_int_equal(system(command), 0);
    size_t size;
    char *text = read_text(text_path, &size);
    static const char *const wanted[] = {
        "17", "\u221218", "19", "\u22121505582", "TM 101", "L1", "L2", "L1 \u00b7 1|2", "0.5 m", "Print at 100 %",
        "100 mm", "the ink is 56.00 mm high", "this way up", "Page 1 of 3", "Page 3 of 3", "A4", "glue"};
    for (size_t i = 0; i < COUNT_OF(wanted); i++)
        assert_text_has(text, wanted[i]);
    free(text);
    remove_folder(folder);
    hand_tape_release(&tape);
}

/* Also behind bytes that would end a text. */
static bool holds(const char *bytes, size_t size, const char *wanted)
{
    size_t length = strlen(wanted);
    for (size_t i = 0; i + length <= size; i++) {
        if (memcmp(bytes + i, wanted, length) == 0)
            return true;
    }
    return false;
}

static void the_same_tape_is_the_same_file(void **state)
{
    (void)state;
    hand_tape tape = hand_tape_of_tms(2, 0, codes, 3, false);
    const char *folder = new_folder(), *first = path_in(folder, "a.pdf"), *second = path_in(folder, "b.pdf");
    print_to(&tape, &(print_settings){.paper = PRINT_A4}, first);
    print_to(&tape, &(print_settings){.paper = PRINT_A4}, second);
    size_t first_size, second_size;
    char *a = read_text(first, &first_size), *b = read_text(second, &second_size);
    assert_int_equal(first_size, second_size);
    assert_memory_equal(a, b, first_size);
    assert_true(holds(a, first_size, "/Title"));
    assert_false(holds(a, first_size, "/CreationDate"));
    free(a);
    free(b);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void what_cannot_be_written_is_told(void **state)
{
    (void)state;
    hand_tape tape = hand_tape_of_tms(2, 0, codes, 3, false);
    error_text error = {""};
    print_summary summary;
    const print_settings settings = {.paper = PRINT_A4};
    assert_false(print_pdf(&tape.wanted, &tape.layout, &settings, "/dev/full", &summary, &error));
    assert_text_has(error.text, "/dev/full");
    assert_text_has(error.text, "No space left on device");
    assert_false(print_pdf(&tape.wanted, &tape.layout, &settings, "/nowhere/at/all.pdf", &summary, &error));
    assert_text_has(error.text, "/nowhere/at/all.pdf");
    assert_text_has(error.text, "No such file or directory");
    hand_tape_release(&tape);
}

static void settings_out_of_range_are_told(void **state)
{
    static const print_settings wrong[] = {{.scale_x = 0.5}, {.scale_y = 2}, {.scale_x = NAN}, {.margin_mm = -1},
                                           {.margin_mm = 60}, {.margin_mm = NAN}};
    (void)state;
    hand_tape tape = hand_tape_of_tms(2, 0, codes, 1, false);
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        error_text error = {""};
        print_summary summary;
        assert_false(print_pdf(&tape.wanted, &tape.layout, &wrong[i], "/dev/null", &summary, &error));
        assert_text_has(error.text, i < 3 ? "scale" : "margin");
    }
    hand_tape_release(&tape);
}

static void papers_have_names(void **state)
{
    print_paper paper = PRINT_A4;
    (void)state;
    assert_true(print_paper_parse("a3", &paper));
    assert_int_equal(paper, PRINT_A3);
    assert_true(print_paper_parse("roll", &paper));
    assert_int_equal(paper, PRINT_ROLL);
    assert_false(print_paper_parse("a5", &paper));
    assert_false(print_paper_parse("", &paper));
    assert_int_equal(paper, PRINT_ROLL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_tell_what_is_on_them),
        cmocka_unit_test(the_same_tape_is_the_same_file),
        cmocka_unit_test(what_cannot_be_written_is_told),
        cmocka_unit_test(settings_out_of_range_are_told),
        cmocka_unit_test(papers_have_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
