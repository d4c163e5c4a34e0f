/* The device's end: lengths, ranges, room. */
#include "link_test.h"

static void longest_records_are_as_long_as_the_page_says(void **state)
{
    (void)state;
    static const struct {
        uint8_t type, sentence, packet;
    } lengths[] = {
        {TAPEMARK_RECORD_FRAME, 62, 22},  {TAPEMARK_RECORD_CM, 76, 25},     {TAPEMARK_RECORD_TM, 71, 25},
        {TAPEMARK_RECORD_PLACE, 58, 20},  {TAPEMARK_RECORD_STATUS, 74, 26}, {TAPEMARK_RECORD_DEVICE, 43, 14},
        {TAPEMARK_RECORD_ANSWER, 78, 57}, {TAPEMARK_RECORD_COMMAND, 78, 64},
    };
    assert_int_equal(COUNT_OF(lengths), RECORD_TYPES);
    for (size_t i = 0; i < COUNT_OF(lengths); i++) {
        const tapemark_record record = longest_record(lengths[i].type);
        assert_int_equal(message_of(&record, TAPEMARK_SENTENCES).size, lengths[i].sentence);
        assert_int_equal(message_of(&record, TAPEMARK_PACKETS).size, lengths[i].packet);
        assert_true(lengths[i].sentence <= TAPEMARK_SENTENCE_MAX_BYTES);
        assert_true(lengths[i].packet <= TAPEMARK_PACKET_MAX_BYTES);
    }
}

static void no_record_is_longer_than_the_longest(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (uint8_t type = 1; type <= RECORD_TYPES; type++) {
        const tapemark_record longest = longest_record(type);
        for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
            const size_t most = message_of(&longest, encoding).size;
            for (int round = 0; round < 2000; round++) {
                const tapemark_record record = random_record(&random, type);
                assert_true(message_of(&record, encoding).size <= most);
            }
        }
    }
}

/* Exactly as large as they are, so that a sanitizer sees a byte too many. */
static void records_fit_or_are_refused(void **state)
{
    (void)state;
    uint32_t random = 2;
    for (uint8_t type = 1; type <= RECORD_TYPES; type++) {
        const tapemark_record record = random_record(&random, type);
        for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
            const size_t needed = message_of(&record, encoding).size;
            for (size_t size = 1; size <= needed; size++) {
                uint8_t *buffer = malloc(size);
                assert_non_null(buffer);
                assert_int_equal(tapemark_record_write(&record, encoding, buffer, size), size == needed ? needed : 0);
                free(buffer);
            }
        }
    }
}

static void packets_have_zeros_at_their_ends_alone(void **state)
{
    (void)state;
    uint32_t random = 3;
    for (int round = 0; round < 5000; round++) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + random_below(&random, RECORD_TYPES)));
        const message packet = message_of(&record, TAPEMARK_PACKETS);
        for (size_t i = 0; i < packet.size; i++)
            assert_int_equal(packet.bytes[i] == 0, i == 0 || i == packet.size - 1);
    }
}

static bool is_sent(const tapemark_record *record)
{
    uint8_t buffer[TAPEMARK_SENTENCE_MAX_BYTES];
    const bool as_sentence = tapemark_record_write(record, TAPEMARK_SENTENCES, buffer, sizeof buffer) > 0;
    const bool as_packet = tapemark_record_write(record, TAPEMARK_PACKETS, buffer, sizeof buffer) > 0;
    assert_int_equal(as_sentence, as_packet);
    return as_sentence;
}

static void types_that_do_not_exist_are_refused(void **state)
{
    (void)state;
    for (unsigned type = 0; type < 256; type++) {
        tapemark_record record = longest_record(TAPEMARK_RECORD_DEVICE);
        record.type = (uint8_t)type;
        if (type == 0 || type > RECORD_TYPES)
            assert_false(is_sent(&record));
    }
}

static void a_cm_out_of_range_is_refused(void **state)
{
    (void)state;
    tapemark_record record = longest_record(TAPEMARK_RECORD_CM);
    assert_true(is_sent(&record));
    record.as.cm.angle_tenth_deg = 3600;
    assert_false(is_sent(&record));
    record.as.cm.angle_tenth_deg = 0;
    record.as.cm.confidence_percent = 101;
    assert_false(is_sent(&record));
}

static void a_tm_out_of_range_is_refused(void **state)
{
    (void)state;
    static const struct {
        uint8_t length;
        uint32_t code;
        uint8_t cms_read;
        uint16_t angle_tenth_deg;
        uint8_t confidence_percent;
        bool sent;
    } cases[] = {
        {3, 7, 3, 3599, 100, true},           {2, 3, 2, 0, 0, false},          {33, 7, 3, 0, 0, false},
        {33, 0, 0, 0, 0, false},              {255, 7, 3, 0, 0, false},        {3, 8, 3, 0, 0, false},
        {3, 7, 4, 0, 0, false},
        {32, 0xffffffff, 32, 0, 0, true},     {31, 0xffffffff, 0, 0, 0, false}, {31, 0x7fffffff, 0, 0, 0, true},
        {6, 0x20, 0, 3600, 0, false},         {6, 0x20, 0, 0, 101, false},
    };
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        tapemark_record record = {.type = TAPEMARK_RECORD_TM};
        record.as.tm.length = cases[i].length;
        record.as.tm.code = cases[i].code;
        record.as.tm.cms_read = cases[i].cms_read;
        record.as.tm.angle_tenth_deg = cases[i].angle_tenth_deg;
        record.as.tm.confidence_percent = cases[i].confidence_percent;
        assert_int_equal(is_sent(&record), cases[i].sent);
    }
}

static void images_beyond_the_format_are_refused(void **state)
{
    (void)state;
    tapemark_record record = {.type = TAPEMARK_RECORD_FRAME};
    record.as.frame.width_px = 6553;
    record.as.frame.height_px = 6553;
    assert_true(is_sent(&record));
    record.as.frame.width_px = 6554;
    assert_false(is_sent(&record));
    record.as.frame.width_px = 0;
    record.as.frame.height_px = 6554;
    assert_false(is_sent(&record));
}

static void a_heading_out_of_range_matters_when_it_is_known(void **state)
{
    (void)state;
    tapemark_record record = {.type = TAPEMARK_RECORD_PLACE};
    record.as.place.heading_tenth_deg = 3600;
    assert_true(is_sent(&record));
    record.as.place.flags = TAPEMARK_PLACE_HEADED;
    assert_false(is_sent(&record));
}

static void texts_out_of_range_are_refused(void **state)
{
    (void)state;
    static const char *const bad_texts[] = {"a,b", "$", "*", "!", "\\", "^", "~", "\n", "\x7f", "\xc3\xa9", "\t"};
    tapemark_record record = {.type = TAPEMARK_RECORD_ANSWER};
    strcpy(record.as.answer.result, "OK");
    for (size_t i = 0; i < COUNT_OF(bad_texts); i++) {
        strcpy(record.as.answer.text, bad_texts[i]);
        assert_false(is_sent(&record));
    }
    strcpy(record.as.answer.text, "a b");
    assert_true(is_sent(&record));
    strcpy(record.as.answer.result, "ok");
    assert_false(is_sent(&record));
    strcpy(record.as.answer.result, "O");
    assert_false(is_sent(&record));
    strcpy(record.as.answer.result, "");
    assert_false(is_sent(&record));
    strcpy(record.as.answer.result, "ERR");
    memset(record.as.answer.text, 'x', sizeof record.as.answer.text);
    assert_false(is_sent(&record));
}

static void fields_without_their_flag_are_left_out(void **state)
{
    (void)state;
    tapemark_record record = longest_record(TAPEMARK_RECORD_STATUS);
    tapemark_record without = record;
    record.as.status.flags = 0;
    memset(&without, 0, sizeof without);
    without.type = TAPEMARK_RECORD_STATUS;
    without.as.status.rate_tenth_hz = 65535;
    without.as.status.frames_dropped = 65535;
    without.as.status.records_dropped = 65535;
    without.as.status.errors = 65535;
    for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
        const message of_all = message_of(&record, encoding);
        const message of_known = message_of(&without, encoding);
        assert_int_equal(of_all.size, of_known.size);
        assert_memory_equal(of_all.bytes, of_known.bytes, of_known.size);
    }
}

/* A record with anything in it, of any type: a good one with some of its bytes changed, or nothing but chance. */
static tapemark_record random_rubbish(uint32_t *random)
{
    tapemark_record record = random_record(random, (uint8_t)(1 + random_below(random, RECORD_TYPES)));
    uint8_t *const bytes = (uint8_t *)&record;
    for (uint32_t blows = random_below(random, 4); blows > 0; blows--)
        bytes[random_below(random, sizeof record)] = (uint8_t)(next_random(random) >> 8);
    if (random_below(random, 8) == 0)
        for (size_t i = 1; i < sizeof record; i++)
            bytes[i] = (uint8_t)(next_random(random) >> 8);
    return record;
}

/* Into a buffer of just that size, so that a sanitizer sees a byte too many. */
static size_t write_within(const tapemark_record *record, tapemark_encoding encoding, size_t size)
{
    uint8_t *buffer = malloc(size > 0 ? size : 1);
    assert_non_null(buffer);
    buffer[0] = 0x5a;
    const size_t written = tapemark_record_write(record, encoding, buffer, size);
    assert_true(written <= size);
    if (size == 0)
        assert_int_equal(buffer[0], 0x5a);
    free(buffer);
    return written;
}

static void whatever_a_record_holds_it_is_sent_right_or_refused(void **state)
{
    (void)state;
    enum { TRIALS = 60000 };
    uint32_t random = 4;
    unsigned sent = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        const tapemark_record record = random_rubbish(&random);
        write_within(&record, random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES,
                     random_below(&random, TAPEMARK_SENTENCE_MAX_BYTES));
        if (!is_sent(&record))
            continue;
        sent++;
        for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
            const message written = message_of(&record, encoding);
            tapemark_receiver receiver = {0};
            assert_true(written.size <= (encoding == TAPEMARK_PACKETS ? 64 : 82));
            assert_int_equal(push_message(&receiver, &written), 1);
            assert_same_record(&receiver.record, &record);
        }
    }
    print_message("%u of %d sent\n", sent, TRIALS);
    assert_in_range(sent, TRIALS / 4, TRIALS - TRIALS / 8);
}

static void any_text_is_made_to_fit(void **state)
{
    (void)state;
    char text[8];
    tapemark_text_fit(text, sizeof text, "ab");
    assert_memory_equal(text, "ab\0\0\0\0\0", sizeof text);
    tapemark_text_fit(text, sizeof text, "a,b$\n\xff c");
    assert_string_equal(text, "a_b___ ");
    tapemark_text_fit(text, sizeof text, "more than fits");
    assert_string_equal(text, "more th");
    tapemark_text_fit(text, 1, "x");
    assert_string_equal(text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(longest_records_are_as_long_as_the_page_says),
        cmocka_unit_test(no_record_is_longer_than_the_longest),
        cmocka_unit_test(records_fit_or_are_refused),
        cmocka_unit_test(packets_have_zeros_at_their_ends_alone),
        cmocka_unit_test(types_that_do_not_exist_are_refused),
        cmocka_unit_test(a_cm_out_of_range_is_refused),
        cmocka_unit_test(a_tm_out_of_range_is_refused),
        cmocka_unit_test(images_beyond_the_format_are_refused),
        cmocka_unit_test(a_heading_out_of_range_matters_when_it_is_known),
        cmocka_unit_test(texts_out_of_range_are_refused),
        cmocka_unit_test(fields_without_their_flag_are_left_out),
        cmocka_unit_test(whatever_a_record_holds_it_is_sent_right_or_refused),
        cmocka_unit_test(any_text_is_made_to_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
