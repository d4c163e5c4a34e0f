/* Whole lines of records in both encodings, with noise among them and damage anywhere. */
#include "link_test.h"

#include "damaged_line.h"

enum { LINES = 25000, SCRIPT_MAX = 192 };

static size_t random_script(uint32_t *random, uint8_t script[SCRIPT_MAX])
{
    const size_t size = 16 + random_below(random, SCRIPT_MAX - 16);
    for (size_t i = 0; i < size; i++)
        script[i] = (uint8_t)(next_random(random) >> 16);
    return size;
}

/* Of a million damaged packets, 0.6 pass the checks by chance; of sentences, fewer. */
static void only_damaged_records_are_lost_and_none_is_made_up(void **state)
{
    (void)state;
    uint32_t random = 11;
    line_tally tally = {.lost = 0};
    for (int i = 0; i < LINES; i++) {
        uint8_t script[SCRIPT_MAX];
        const size_t size = random_script(&random, script);
        run_damaged_line(script, size, &tally);
    }
    const unsigned long damaged = tally.damaged[TAPEMARK_SENTENCES] + tally.damaged[TAPEMARK_PACKETS];
    print_message("%lu records sent, %lu damaged; %lu sentences and %lu packets received that nobody sent\n",
                  tally.sent[TAPEMARK_SENTENCES] + tally.sent[TAPEMARK_PACKETS], damaged,
                  tally.wrong[TAPEMARK_SENTENCES], tally.wrong[TAPEMARK_PACKETS]);
    assert_true(damaged > 2 * LINES);
    assert_int_equal(tally.lost, 0);
    assert_int_equal(tally.wrong[TAPEMARK_SENTENCES], 0);
    assert_true(tally.wrong[TAPEMARK_PACKETS] <= 1);
}

/* The line itself: without damage, all that is sent is received. */
static void an_undamaged_line_loses_nothing(void **state)
{
    (void)state;
    line_tally tally = {.lost = 0};
    for (unsigned seed = 0; seed < 0x10000; seed += 7) {
        /* Four records, and nothing after them. */
        const uint8_t high = (uint8_t)(seed >> 8), low = (uint8_t)seed;
        const uint8_t script[] = {3, 1, low, high, low, 1, high, low, high, 1, low, low, high, 1, high, high, low};
        run_damaged_line(script, sizeof script, &tally);
    }
    assert_int_equal(tally.sent[TAPEMARK_SENTENCES] + tally.sent[TAPEMARK_PACKETS], 4 * (0xffff / 7 + 1));
    assert_int_equal(tally.damaged[TAPEMARK_SENTENCES] + tally.damaged[TAPEMARK_PACKETS], 0);
    assert_int_equal(tally.lost, 0);
    assert_int_equal(tally.wrong[TAPEMARK_SENTENCES] + tally.wrong[TAPEMARK_PACKETS], 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_damaged_records_are_lost_and_none_is_made_up),
        cmocka_unit_test(an_undamaged_line_loses_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
