/* The microcontroller's end on a bad line: no wrong record is taken beyond the odds of the CRC, and none is lost but
 * those that the damage hit. */
#include "link_test.h"

enum { CRC_ODDS = 65536 };

/* ---- A line with a victim ------------------------------------------------------------------------------ */

/* Four records one after the other; the second is damaged on its way. */
typedef struct test_line {
    char texts[4][RECORD_TEXT_BYTES];
    message messages[4];
} test_line;

enum { VICTIM = 1 };

static test_line random_line(uint32_t *random, uint8_t victim_type, tapemark_encoding encoding)
{
    test_line made;
    for (int i = 0; i < 4; i++) {
        const uint8_t type = i == VICTIM ? victim_type : (uint8_t)(1 + random_below(random, RECORD_TYPES));
        const tapemark_record record = random_record(random, type);
        record_to_text(&record, made.texts[i]);
        made.messages[i] = message_of(&record, encoding);
    }
    return made;
}

typedef struct line_outcome {
    bool victim_taken;
    unsigned wrong;
    unsigned damaged;
} line_outcome;

static void push_damaged(tapemark_receiver *receiver, uint8_t byte, const char *victim, line_outcome *outcome)
{
    if (tapemark_receiver_push(receiver, byte) == TAPEMARK_RECORD_NONE)
        return;
    char text[RECORD_TEXT_BYTES];
    record_to_text(&receiver->record, text);
    if (strcmp(text, victim) == 0 && !outcome->victim_taken)
        outcome->victim_taken = true;
    else
        outcome->wrong++;
}

static void assert_received(const tapemark_receiver *receiver, const char *expected)
{
    char text[RECORD_TEXT_BYTES];
    record_to_text(&receiver->record, text);
    assert_string_equal(text, expected);
}

/* Sends the line with other bytes in the victim's place. The records around it have to arrive, whole and in order. */
static line_outcome send_line(const test_line *line, const uint8_t *bytes, size_t size)
{
    line_outcome outcome = {false, 0, 0};
    tapemark_receiver receiver = {0};
    assert_int_equal(push_message(&receiver, &line->messages[0]), 1);
    assert_received(&receiver, line->texts[0]);

    for (size_t i = 0; i < size; i++)
        push_damaged(&receiver, bytes[i], line->texts[VICTIM], &outcome);
    /* The delimiter before the next record ends the victim where its own is gone. */
    const message *const next = &line->messages[2];
    push_damaged(&receiver, next->bytes[0], line->texts[VICTIM], &outcome);
    assert_int_equal(push_all(&receiver, next->bytes + 1, next->size - 1), 1);
    assert_received(&receiver, line->texts[2]);
    assert_int_equal(push_message(&receiver, &line->messages[3]), 1);
    assert_received(&receiver, line->texts[3]);
    outcome.damaged = receiver.damaged;
    return outcome;
}

/* Damage that a receiver has to bear: where it strikes is the caller's choice, and what it does depends on its kind.
 * Answers the new size. */
typedef size_t (*damage)(uint8_t *bytes, size_t size, size_t at);

/* Each damage at each of its places, on records of all types in both encodings. Where little of a record is left, a
 * receiver cannot count it; otherwise it has to. */
static void strike_everywhere(damage strike, size_t places_per_byte, bool counted)
{
    uint32_t random = 1;
    for (uint8_t type = 1; type <= RECORD_TYPES; type++)
        for (int round = 0; round < 8; round++) {
            const tapemark_encoding encoding = round % 2 ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
            const test_line line = random_line(&random, type, encoding);
            const message *victim = &line.messages[VICTIM];
            for (size_t at = 0; at < victim->size * places_per_byte; at++) {
                uint8_t bytes[2 * TAPEMARK_SENTENCE_MAX_BYTES];
                memcpy(bytes, victim->bytes, victim->size);
                const size_t size = strike(bytes, victim->size, at);
                const line_outcome outcome = send_line(&line, bytes, size);
                assert_int_equal(outcome.wrong, 0);
                /* A sentence whose first letters are hit is nobody's. */
                if (counted && !outcome.victim_taken && (encoding == TAPEMARK_PACKETS || at >= 6 * places_per_byte))
                    assert_true(outcome.damaged > 0);
            }
        }
}

static size_t flip_bit(uint8_t *bytes, size_t size, size_t at)
{
    bytes[at / 8] ^= (uint8_t)(1 << at % 8);
    return size;
}

static size_t drop_byte(uint8_t *bytes, size_t size, size_t at)
{
    memmove(bytes + at, bytes + at + 1, size - at - 1);
    return size - 1;
}

static size_t double_byte(uint8_t *bytes, size_t size, size_t at)
{
    memmove(bytes + at + 1, bytes + at, size - at);
    return size + 1;
}

static size_t swap_with_next(uint8_t *bytes, size_t size, size_t at)
{
    if (at + 1 < size) {
        const uint8_t byte = bytes[at];
        bytes[at] = bytes[at + 1];
        bytes[at + 1] = byte;
    }
    return size;
}

static size_t swap_with_the_one_after_next(uint8_t *bytes, size_t size, size_t at)
{
    if (at + 2 < size) {
        const uint8_t byte = bytes[at];
        bytes[at] = bytes[at + 2];
        bytes[at + 2] = byte;
    }
    return size;
}

static size_t cut_off(uint8_t *bytes, size_t size, size_t at)
{
    (void)bytes;
    (void)size;
    return at;
}

static size_t lose_the_front(uint8_t *bytes, size_t size, size_t at)
{
    memmove(bytes, bytes + at, size - at);
    return size - at;
}

static size_t insert_zero(uint8_t *bytes, size_t size, size_t at)
{
    memmove(bytes + at + 1, bytes + at, size - at);
    bytes[at] = 0;
    return size + 1;
}

static size_t insert_dollar(uint8_t *bytes, size_t size, size_t at)
{
    memmove(bytes + at + 1, bytes + at, size - at);
    bytes[at] = '$';
    return size + 1;
}

static void each_bit_flipped(void **state)
{
    (void)state;
    strike_everywhere(flip_bit, 8, true);
}

static void each_byte_dropped(void **state)
{
    (void)state;
    strike_everywhere(drop_byte, 1, true);
}

static void each_byte_doubled(void **state)
{
    (void)state;
    strike_everywhere(double_byte, 1, true);
}

static void each_two_neighbours_swapped(void **state)
{
    (void)state;
    strike_everywhere(swap_with_next, 1, true);
    strike_everywhere(swap_with_the_one_after_next, 1, true);
}

static void cut_at_each_byte(void **state)
{
    (void)state;
    strike_everywhere(cut_off, 1, false);
    strike_everywhere(lose_the_front, 1, false);
}

static void a_delimiter_at_each_byte(void **state)
{
    (void)state;
    strike_everywhere(insert_zero, 1, true);
    strike_everywhere(insert_dollar, 1, true);
}

/* ---- Worse damage: here the CRC's odds are all there is ------------------------------------------------- */

static size_t strike_at_random(uint32_t *random, uint8_t *bytes, size_t size)
{
    static const damage kinds[] = {drop_byte, double_byte, swap_with_next, insert_zero, insert_dollar};
    for (uint32_t blows = 1 + random_below(random, 6); blows > 0 && size > 0; blows--) {
        const uint32_t kind = random_below(random, COUNT_OF(kinds) + 2);
        const uint32_t at = random_below(random, (uint32_t)size);
        if (kind < COUNT_OF(kinds))
            size = kinds[kind](bytes, size, at);
        else if (kind == COUNT_OF(kinds))
            size = flip_bit(bytes, size, 8 * at + random_below(random, 8));
        else
            bytes[at] = (uint8_t)next_random(random);
    }
    return size;
}

static void random_damage_is_within_the_odds(void **state)
{
    (void)state;
    enum { TRIALS = 30000 };
    uint32_t random = 5;
    unsigned wrong = 0;
    unsigned lost = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        const tapemark_encoding encoding = trial % 2 ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
        const test_line line = random_line(&random, (uint8_t)(1 + trial % RECORD_TYPES), encoding);
        uint8_t bytes[2 * TAPEMARK_SENTENCE_MAX_BYTES];
        memcpy(bytes, line.messages[VICTIM].bytes, line.messages[VICTIM].size);
        const size_t size = strike_at_random(&random, bytes, line.messages[VICTIM].size);
        const line_outcome outcome = send_line(&line, bytes, size);
        wrong += outcome.wrong;
        lost += !outcome.victim_taken;
    }
    print_message("of %d damaged records, %u lost, %u taken wrongly\n", TRIALS, lost, wrong);
    assert_true(lost > TRIALS / 2);
    assert_true(wrong <= 2 + 2 * TRIALS / CRC_ODDS);
}

/* Whole packets of random bytes: the CRC is met as often as chance has it, no more. */
static void random_packets_pass_as_often_as_chance_has_it(void **state)
{
    (void)state;
    enum { TRIALS = 1 << 19, EXPECTED = TRIALS / CRC_ODDS };
    uint32_t random = 6;
    tapemark_receiver receiver = {0};
    unsigned records = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        uint8_t packet[] = {0, 24, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
        for (size_t i = 2; i < sizeof packet - 1; i++)
            packet[i] = (uint8_t)(1 + random_below(&random, 255));
        records += (unsigned)push_all(&receiver, packet, sizeof packet - 1);
    }
    const unsigned met = records + receiver.unknown;
    print_message("of %d random packets, %u met the CRC, %u gave a record\n", TRIALS, met, records);
    assert_true(met > EXPECTED / 3 && met < EXPECTED * 3);
    assert_true(records <= 4);
}

/* ---- Noise, and what is no damage at all ---------------------------------------------------------------- */

static void noise_between_messages_costs_none(void **state)
{
    (void)state;
    uint32_t random = 7;
    for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
        tapemark_receiver receiver = {0};
        for (int round = 0; round < 10000; round++) {
            for (uint32_t noise = random_below(&random, 150); noise > 0; noise--)
                assert_int_equal(tapemark_receiver_push(&receiver, (uint8_t)next_random(&random)), 0);
            const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
            const message sent = message_of(&record, encoding);
            assert_int_equal(push_message(&receiver, &sent), 1);
            assert_same_record(&receiver.record, &record);
        }
    }
}

/* The nastiest noise: pieces of real messages. */
static void pieces_of_messages_between_messages_cost_none(void **state)
{
    (void)state;
    uint32_t random = 8;
    tapemark_receiver receiver = {0};
    for (int round = 0; round < 10000; round++) {
        const tapemark_encoding encoding = random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
        const tapemark_record torn = random_record(&random, (uint8_t)(1 + random_below(&random, RECORD_TYPES)));
        const message piece = message_of(&torn, encoding);
        const size_t half = piece.size / 2;
        const size_t start = random_below(&random, 2) ? half : 0;
        assert_int_equal(push_all(&receiver, piece.bytes + start, half), 0);

        const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
        const message sent = message_of(&record, random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES);
        assert_int_equal(push_message(&receiver, &sent), 1);
        assert_same_record(&receiver.record, &record);
    }
}

static void changing_the_encoding_is_no_damage(void **state)
{
    (void)state;
    uint32_t random = 9;
    tapemark_receiver receiver = {0};
    for (int round = 0; round < 10000; round++) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
        const message sent = message_of(&record, random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES);
        assert_int_equal(push_message(&receiver, &sent), 1);
        assert_same_record(&receiver.record, &record);
    }
    assert_int_equal(receiver.damaged, 0);
}

static void messages_without_an_end_cost_none_after_them(void **state)
{
    (void)state;
    static const char start[] = "$PTMKA,1,OK,1,";
    uint32_t random = 10;
    for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++)
        for (size_t excess = 0; excess < 300; excess++) {
            tapemark_receiver receiver = {0};
            push_all(&receiver, (const uint8_t *)start, encoding == TAPEMARK_SENTENCES ? sizeof start - 1 : 0);
            if (encoding == TAPEMARK_PACKETS)
                tapemark_receiver_push(&receiver, 0);
            for (size_t i = 0; i < excess; i++)
                assert_int_equal(tapemark_receiver_push(&receiver, 'x'), TAPEMARK_RECORD_NONE);
            const tapemark_record record = random_record(&random, (uint8_t)(1 + excess % RECORD_TYPES));
            const message sent = message_of(&record, encoding);
            assert_int_equal(push_message(&receiver, &sent), 1);
            assert_same_record(&receiver.record, &record);
            assert_int_equal(receiver.damaged, encoding == TAPEMARK_SENTENCES || excess > 0);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_bit_flipped),
        cmocka_unit_test(each_byte_dropped),
        cmocka_unit_test(each_byte_doubled),
        cmocka_unit_test(each_two_neighbours_swapped),
        cmocka_unit_test(cut_at_each_byte),
        cmocka_unit_test(a_delimiter_at_each_byte),
        cmocka_unit_test(random_damage_is_within_the_odds),
        cmocka_unit_test(random_packets_pass_as_often_as_chance_has_it),
        cmocka_unit_test(noise_between_messages_costs_none),
        cmocka_unit_test(pieces_of_messages_between_messages_cost_none),
        cmocka_unit_test(changing_the_encoding_is_no_damage),
        cmocka_unit_test(messages_without_an_end_cost_none_after_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
