/* Text as it is put together for people and for programs, whatever it is made of. */
#include "test_main.h"

#include <math.h>

#include "error_line.h"

static void sources_are_escaped(void **state)
{
    static const struct {
        const char *source;
        const char *json;
    } cases[] = {
        {"a \"b\"\\c\n\x01", "\"a \\\"b\\\"\\\\c\\u000a\\u0001\""},
        {"gr\xc3\xbc\xc3\x9f \xf0\x9f\x8e\xac", "\"gr\xc3\xbc\xc3\x9f \xf0\x9f\x8e\xac\""},
        {"\xff\xc3(", "\"\\ufffd\\ufffd(\""},                              /* no UTF-8 */
        {"\xc0\xaf", "\"\\ufffd\\ufffd\""},                                /* overlong */
        {"\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\""},                     /* half of a surrogate pair */
        {"\xf4\x90\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\""},          /* beyond U+10FFFF */
        {"\xf8\x88\x80\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd\""},
        {"end\xe2\x82", "\"end\\ufffd\\ufffd\""},                          /* cut */
        {"\x7f", "\"\\u007f\""},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        text_buffer text = {0};
        text_buffer_add_json_string(&text, cases[i].source);
        assert_string_equal(text.text, cases[i].json);
        text_buffer_release(&text);
    }
}

static void messages_are_printable(void **state)
{
    text_buffer text = {0};
    (void)state;
    text_buffer_add_printable(&text, "gr\xc3\xbc\xc3\x9f\n\x1b[2J\x7f\xff%s");
    assert_string_equal(text.text, "gr\xc3\xbc\xc3\x9f??[2J??%s");
    text_buffer_release(&text);
}

/* Two bytes each in UTF-8, the first of them as those of letters. */
static void c1_controls_are_not_printable(void **state)
{
    text_buffer text = {0};
    (void)state;
    text_buffer_add_printable(&text, "\xc2\x80 \xc2\x9b" "2J \xc2\x9f \xc2\xa0\xc2\xb5\xc3\x9b");
    assert_string_equal(text.text, "? ?2J ? \xc2\xa0\xc2\xb5\xc3\x9b");
    text_buffer_release(&text);
}

static void numbers_that_json_lacks_are_null(void **state)
{
    text_buffer text = {0};
    (void)state;
    text_buffer_add_json_number(&text, 1.0 / 3, 2);
    text_buffer_add_json_number(&text, -INFINITY, 2);
    text_buffer_add_json_number(&text, NAN, 2);
    assert_string_equal(text.text, "0.33nullnull");
    text_buffer_release(&text);
}

static void csv_quotes_what_needs_it(void **state)
{
    text_buffer text = {0};
    (void)state;
    text_buffer_add_csv_field(&text, "plain.mp4");
    text_buffer_add(&text, ";");
    text_buffer_add_csv_field(&text, "a,\"b\"%s\nc");
    assert_string_equal(text.text, "plain.mp4;\"a,\"\"b\"\"%s\nc\"");
    text_buffer_release(&text);
}

static void an_error_is_one_line(void **state)
{
    text_buffer line = {0};
    (void)state;
    error_line_add(&line, "tapemark-test", "a\nfile.png", "is \x1b[31mno\r\npicture");
    assert_string_equal(line.text, "tapemark-test: a?file.png: is ?[31mno??picture\n");
    text_buffer_clear(&line);
    error_line_add(&line, "tapemark-test", NULL, "--fast takes no value");
    assert_string_equal(line.text, "tapemark-test: --fast takes no value\n");
    text_buffer_release(&line);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sources_are_escaped),
        cmocka_unit_test(messages_are_printable),
        cmocka_unit_test(c1_controls_are_not_printable),
        cmocka_unit_test(numbers_that_json_lacks_are_null),
        cmocka_unit_test(csv_quotes_what_needs_it),
        cmocka_unit_test(an_error_is_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
