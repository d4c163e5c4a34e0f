/* Codes of tape markers: how many, in which order, none twice, none its own mirror image. */
#include "make_test.h"

#include "tm_codes.h"

static uint32_t mirror(uint32_t code, unsigned length)
{
    uint32_t result = 0;
    for (unsigned i = 0; i < length; i++)
        result = result << 1 | (code >> i & 1);
    return result;
}

static unsigned ones_of(uint32_t code)
{
    unsigned ones = 0;
    for (; code != 0; code &= code - 1)
        ones++;
    return ones;
}

static void as_many_as_there_are(void **state)
{
    (void)state;
    for (unsigned length = 3; length <= 14; length++) {
        for (int mirrored_too = 0; mirrored_too <= 1; mirrored_too++) {
            uint32_t all = UINT32_C(1) << length, palindromes = UINT32_C(1) << (length + 1) / 2, count = 0, code;
            uint8_t *used = calloc(all, 1);
            tm_codes codes;
            assert_non_null(used);
            tm_codes_init(&codes, mirrored_too == 1);
            while (tm_codes_take(&codes, length, false, &code)) {
                assert_true(code < all);
                assert_int_equal(used[code], 0);
                assert_true(mirrored_too || used[mirror(code, length)] == 0);
                assert_true(mirrored_too || code != mirror(code, length));
                used[code] = 1;
                count++;
            }
            assert_int_equal(count, mirrored_too ? all : (all - palindromes) / 2);
            assert_false(tm_codes_take(&codes, length, false, &code));
            free(used);
        }
    }
}

static void fewest_ones_first_then_from_the_left(void **state)
{
    static const char *const sixes[] = {"100000", "010000", "001000", "110000", "101000", "100100", "100010",
                                        "011000", "010100", "111000"};
    tm_codes codes;
    uint32_t code = 0;
    (void)state;
    tm_codes_init(&codes, false);
    for (size_t i = 0; i < COUNT_OF(sixes); i++) {
        assert_true(tm_codes_take(&codes, 6, false, &code));
        for (unsigned slot = 0; slot < 6; slot++)
            assert_int_equal(tm_code_light(code, 6, slot), sixes[i][slot] == '1');
    }
}

static void the_longest_codes_fit(void **state)
{
    tm_codes codes;
    uint32_t code = 0, before = UINT32_MAX;
    unsigned ones = 0;
    (void)state;
    tm_codes_init(&codes, false);
    for (size_t i = 0; i < 100000; i++) {
        assert_true(tm_codes_take(&codes, 32, false, &code));
        assert_true(code > mirror(code, 32));
        assert_true(ones_of(code) > ones || code < before);
        assert_true(ones_of(code) >= ones);
        ones = ones_of(code);
        before = code;
    }
    assert_int_equal(ones, 5);
}

static void a_light_start_is_taken_before_its_turn_and_only_once(void **state)
{
    tm_codes codes;
    uint32_t code = 0;
    (void)state;
    tm_codes_init(&codes, true);
    assert_true(tm_codes_take(&codes, 4, true, &code));
    assert_int_equal(code, 8);
    for (uint32_t i = 0; i < 15; i++) {
        assert_true(tm_codes_take(&codes, 4, false, &code));
        assert_int_not_equal(code, 8);
        assert_true(i > 0 || code == 0);
    }
    assert_false(tm_codes_take(&codes, 4, false, &code));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_many_as_there_are),
        cmocka_unit_test(fewest_ones_first_then_from_the_left),
        cmocka_unit_test(the_longest_codes_fit),
        cmocka_unit_test(a_light_start_is_taken_before_its_turn_and_only_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
