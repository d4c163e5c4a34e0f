/* Which readings are believed: by themselves, and beside their neighbours on the tape. */
#include "decoding.h"

#include "code.h"
#include "judgement.h"
#include "segment.h"

enum { MAX_CMS = 3 };

static tmi_reading seen(int32_t id, float odds)
{
    return (tmi_reading){.id = id, .score = 0.98f, .odds = odds};
}

/* Judges CMs in a row, the first of which is at 0, upright or standing on the head; returns how many are believed. */
static int judge(const tmi_reading *readings, int count, bool turned, tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    static const tapemark_config config = {.id_max = TAPEMARK_MAX_ID};
    static const tmi_reader reader = {.config = &config};
    static tmi_segment segment;
    for (int i = 0; i < count; i++)
        segment.readings[turned ? TMI_TURNED : TMI_UPRIGHT][i] = readings[i];
    return tmi_judge(&reader, &segment, 0, count, turned ? -3 : 3, reasons);
}

static tapemark_reject judge_one(tmi_reading reading)
{
    tapemark_reject reasons[TAPEMARK_TM_MAX_CMS];
    judge(&reading, 1, false, reasons);
    return reasons[0];
}

/* The more words there are with as many ones, the likelier one fits by chance. */
static void rarer_words_need_better_odds(void **state)
{
    (void)state;
    static const struct {
        int32_t id;
        float needed;
    } cases[] = {{57, 1.6f}, {3081, 1.6f}, {3082, 2}, {79157, 2}, {79158, 2.48f}, {TAPEMARK_MAX_ID, 2.48f}};
    for (size_t i = 0; i < COUNT_OF(cases); i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            assert_int_equal(judge_one(seen(sign * cases[i].id, cases[i].needed + 0.01f)), TMI_BELIEVED);
            assert_int_equal(judge_one(seen(sign * cases[i].id, cases[i].needed - 0.01f)), TAPEMARK_REJECT_MARGIN);
        }
}

static void what_speaks_against_a_reading_is_named(void **state)
{
    (void)state;
    tmi_reading reading = seen(57, 4);
    assert_int_equal(judge_one(reading), TMI_BELIEVED);
    reading.unknown = true;
    assert_int_equal(judge_one(reading), TAPEMARK_REJECT_UNKNOWN_ID);
    reading.contrary = 1;
    assert_int_equal(judge_one(reading), TAPEMARK_REJECT_SCORE);
    reading = seen(57, 4);
    reading.score = 0.5f;
    assert_int_equal(judge_one(reading), TAPEMARK_REJECT_SCORE);
    assert_int_equal(judge_one(seen(TMI_NO_ID, 4)), TAPEMARK_REJECT_SCORE);
}

/* Ids ascend along a tape, whichever way it is seen: one that does is believed on less, one that does not needs
 * more. */
static void sure_neighbours_count(void **state)
{
    (void)state;
    tapemark_reject reasons[TAPEMARK_TM_MAX_CMS];
    const tmi_reading ascending[MAX_CMS] = {seen(20, 4), seen(-21, 1.2f), seen(22, 4)};
    assert_int_equal(judge(ascending, MAX_CMS, false, reasons), 3);
    assert_int_equal(judge(ascending, MAX_CMS, true, reasons), 2);
    assert_int_equal(reasons[1], TAPEMARK_REJECT_MARGIN);

    const tmi_reading descending[MAX_CMS] = {seen(22, 4), seen(-21, 1.2f), seen(20, 4)};
    assert_int_equal(judge(descending, MAX_CMS, true, reasons), 3);

    const tmi_reading stranger[MAX_CMS] = {seen(20, 4), seen(57, 1.8f), seen(22, 4)};
    assert_int_equal(judge(stranger, MAX_CMS, false, reasons), 2);
    assert_int_equal(reasons[1], TAPEMARK_REJECT_CONFLICT);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(rarer_words_need_better_odds),
        cmocka_unit_test(what_speaks_against_a_reading_is_named),
        cmocka_unit_test(sure_neighbours_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
