/* A receiver with one of the encodings compiled out: it reads the other one as before, and nothing of its own. */
#include "link_test.h"

#ifdef TAPEMARK_RECEIVER_NO_SENTENCES
static const tapemark_encoding kept = TAPEMARK_PACKETS;
static const tapemark_encoding left_out = TAPEMARK_SENTENCES;
#else
static const tapemark_encoding kept = TAPEMARK_SENTENCES;
static const tapemark_encoding left_out = TAPEMARK_PACKETS;
#endif

static void one_encoding_is_read_and_the_other_is_not(void **state)
{
    (void)state;
    uint32_t random = 1;
    tapemark_receiver receiver = {0};
    for (int round = 0; round < 5000; round++) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
        const message read = message_of(&record, kept);
        const message not_read = message_of(&record, left_out);
        assert_int_equal(push_message(&receiver, &not_read), 0);
        assert_int_equal(push_message(&receiver, &read), 1);
        assert_same_record(&receiver.record, &record);
    }
}

static void it_is_smaller_than_it_would_be_with_both(void **state)
{
    (void)state;
    const size_t both = sizeof(tapemark_record) + 2 * sizeof(uint16_t) + 4 + TAPEMARK_SENTENCE_BODY_MAX + 3 +
                        TAPEMARK_PAYLOAD_MAX;
    assert_true(sizeof(tapemark_receiver) < both - 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_encoding_is_read_and_the_other_is_not),
        cmocka_unit_test(it_is_smaller_than_it_would_be_with_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
