/* The vote of the lines through a TM. */
#include "decoding.h"

#include "bars.h"

static tmi_tm_reading vote_of(const uint32_t *codes, int clear, int lines)
{
    tmi_tm_reading reading = {0};
    tmi_vote(codes, clear, lines, &reading);
    return reading;
}

static void most_lines_decide(void **state)
{
    (void)state;
    static const uint32_t first[] = {5, 5, 5, 2, 3}, middle[] = {2, 5, 3, 5, 5}, last[] = {2, 3, 5, 5, 5};
    static const uint32_t *const orders[] = {first, middle, last};
    for (size_t i = 0; i < COUNT_OF(orders); i++) {
        const tmi_tm_reading reading = vote_of(orders[i], 5, 5);
        assert_int_equal(reading.code, 5);
        assert_true(reading.vote > 0.59f && reading.vote < 0.61f);
    }
}

static void lines_that_are_not_clear_are_against_it(void **state)
{
    (void)state;
    static const uint32_t codes[] = {6, 6, 6, 6};
    assert_true(vote_of(codes, 4, 4).vote > 0.99f);
    const float half = vote_of(codes, 4, 8).vote;
    assert_true(half > 0.49f && half < 0.51f);
}

static void few_lines_are_no_vote(void **state)
{
    (void)state;
    static const uint32_t codes[TMI_LINES] = {6, 6, 6, 6};
    assert_true(vote_of(codes, TMI_LINES / 3, TMI_LINES / 3).vote <= 0);
    assert_true(vote_of(codes, TMI_LINES / 3 + 1, TMI_LINES / 3 + 1).vote > 0.99f);
    assert_true(vote_of(codes, 0, TMI_LINES).vote <= 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_lines_decide),
        cmocka_unit_test(lines_that_are_not_clear_are_against_it),
        cmocka_unit_test(few_lines_are_no_vote),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
