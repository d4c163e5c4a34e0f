/* What the microcontroller's end refuses although nothing was damaged on the way: messages that break the rules. */
#include "handmade.h"

/* ---- Sentences that are refused ------------------------------------------------------------------------ */

static const char good_place[] = "PTMKP,1,2,01,-3,4,5";

static void a_sentence_made_by_hand_is_taken(void **state)
{
    (void)state;
    const message sent = sentence_of(good_place);
    tapemark_receiver receiver = {0};
    assert_int_equal(push_message(&receiver, &sent), 1);
    assert_int_equal(receiver.record.as.place.x_mm, -3);
    assert_int_equal(receiver.record.as.place.heading_tenth_deg, 5);
}

/* Their checks are right, and what they say is not. */
static void sentences_that_break_the_rules_are_damaged(void **state)
{
    (void)state;
    static const char *const bad[] = {
        "PTMKP,,2,01,-3,4,5",           /* empty, and has to be known */
        "PTMKP,1,2,01,-3,4,",           /* likewise, by its flag */
        "PTMKP,1,2,00,-3,4,5",          /* not empty, and is not known */
        "PTMKP,1,2,01,-3,4",            /* too few */
        "PTMKP,1,2,00,-3,4",            /* too few, though the missing one would be empty */
        "PTMKA,1,OK,2",
        "PTMKP",                        /* none */
        "PTMKP,65536,2,01,-3,4,5",      /* u16 */
        "PTMKP,1,256,01,-3,4,5",        /* u8 */
        "PTMKP,-1,2,01,-3,4,5",         /* a sign, where there is none */
        "PTMKP,+1,2,01,-3,4,5",
        "PTMKP, 1,2,01,-3,4,5",
        "PTMKP,1 ,2,01,-3,4,5",
        "PTMKP,1.0,2,01,-3,4,5",
        "PTMKP,0x1,2,01,-3,4,5",
        "PTMKP,1,2,1,-3,4,5",           /* hexadecimal: two digits */
        "PTMKP,1,2,001,-3,4,5",
        "PTMKP,1,2,0g,-3,4,5",
        "PTMKP,1,2,0f,-3,4,5",          /* and upper case */
        "PTMKP,1,2,01,-,4,5",
        "PTMKP,1,2,01,--3,4,5",
        "PTMKP,1,2,01,2147483648,4,5",  /* i32 */
        "PTMKP,1,2,01,-2147483649,4,5",
        "PTMKP,1,2,01,4294967295,4,5",
        "PTMKP,1,2,01,99999999999,4,5", /* beyond 32 bits */
        "PTMKP,1,2,01,42949672960,4,5",
        "PTMKD,4294967296,1,2,3,4",
        "PTMKD,4294967300,1,2,3,4",
        "PTMKF,1,0000,,,6554,0,0,0",    /* what fits its type, and not its range */
        "PTMKF,1,0000,,,0,6554,0,0",
        "PTMKC,1,2,00,5,0,0,0,3600,0,,",
        "PTMKC,1,2,00,5,0,0,0,0,101,,",
        "PTMKT,1,2,00,2,00000000,0,0,0,0,0,0",
        "PTMKT,1,2,00,33,00000000,0,0,0,0,0,0",
        "PTMKT,1,2,00,3,00000008,0,0,0,0,0,0",
        "PTMKT,1,2,00,3,00000000,0,0,0,0,0,4",
        "PTMKP,1,2,01,-3,4,3600",
        "PTMKA,1,OKAY,2,text",          /* a text too long */
        "PTMKA,1,OK,2,12345678901234567890123456789012345678901",
        "PTMKA,1,O!,2,text",
        "PTMKA,1,OK,2,a^b",
        "PTMKPP,1,2,01,-3,4,5",         /* a letter too many */
        "PTMK,1,2,01,-3,4,5",
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        const message sent = sentence_of(bad[i]);
        tapemark_receiver receiver = {0};
        assert_int_equal(push_message(&receiver, &sent), 0);
        assert_int_equal(receiver.damaged, 1);
        const message next = sentence_of(good_place);
        assert_int_equal(push_message(&receiver, &next), 1);
    }
}

/* After a whole one, whose end still lies in the receiver. */
static void sentences_that_stop_early_are_damaged(void **state)
{
    (void)state;
    const message whole = sentence_of(good_place);
    for (size_t length = 4; length < sizeof good_place + 4; length++) {
        tapemark_receiver receiver = {0};
        assert_int_equal(push_message(&receiver, &whole), 1);
        unsigned sum = 0;
        for (size_t i = 1; i <= length; i++)
            sum ^= whole.bytes[i];
        char end[8];
        const int size = snprintf(end, sizeof end, "*%02X\r\n", sum);
        push_all(&receiver, whole.bytes, length + 1);
        assert_int_equal(push_all(&receiver, (const uint8_t *)end, (size_t)size), 0);
        assert_int_equal(receiver.damaged, 1);
    }
}

static void numbers_at_the_ends_of_their_ranges_are_taken(void **state)
{
    (void)state;
    tapemark_receiver receiver = {0};
    const message place = sentence_of("PTMKP,65535,255,FE,-2147483648,2147483647,");
    assert_int_equal(push_message(&receiver, &place), 1);
    assert_int_equal(receiver.record.as.place.x_mm, INT32_MIN);
    assert_int_equal(receiver.record.as.place.y_mm, INT32_MAX);
    const message device = sentence_of("PTMKD,4294967295,0,00,255,1");
    assert_int_equal(push_message(&receiver, &device), 1);
    assert_int_equal(receiver.record.as.device.uptime_s, UINT32_MAX);
    assert_int_equal(receiver.record.as.device.version_patch, 255);
}

/* Of a record of zeros, but for what has to be set: taken with the values at both ends of the range, and refused with
 * those beyond them. */
static void expect_range(uint8_t *fields, size_t size, size_t at, uint32_t least, uint32_t most)
{
    const uint32_t tried[] = {least, most, least - 1, most + 1};
    for (size_t i = 0; i < COUNT_OF(tried); i++) {
        if (i == 2 && least == 0)
            continue;
        fields[at] = (uint8_t)tried[i];
        if (most > UINT8_MAX)
            fields[at + 1] = (uint8_t)(tried[i] >> 8);
        const message sent = packet_of(fields, size);
        tapemark_receiver receiver = {0};
        assert_int_equal(push_message(&receiver, &sent), i < 2);
        assert_int_equal(receiver.damaged, i >= 2);
    }
}

static void values_out_of_range_are_refused(void **state)
{
    (void)state;
    enum { VERSION = 0x10, FRAME_BYTES = 17, CM_BYTES = 20, TM_BYTES = 20, PLACE_BYTES = 15, TM_LENGTH_AT = 5,
           TM_CODE_AT = 6, PLACE_FLAGS_AT = 4 };
    static const struct {
        uint8_t type;
        size_t size, at;
        uint32_t least, most;
    } ranges[] = {
        {TAPEMARK_RECORD_FRAME, FRAME_BYTES, 11, 0, 6553}, {TAPEMARK_RECORD_FRAME, FRAME_BYTES, 13, 0, 6553},
        {TAPEMARK_RECORD_CM, CM_BYTES, 15, 0, 3599},       {TAPEMARK_RECORD_CM, CM_BYTES, 17, 0, 100},
        {TAPEMARK_RECORD_TM, TM_BYTES, TM_LENGTH_AT, 3, 32}, {TAPEMARK_RECORD_TM, TM_BYTES, 16, 0, 3599},
        {TAPEMARK_RECORD_TM, TM_BYTES, 18, 0, 100},        {TAPEMARK_RECORD_TM, TM_BYTES, 19, 0, 32},
        {TAPEMARK_RECORD_PLACE, PLACE_BYTES, 13, 0, 3599},
    };
    for (size_t i = 0; i < COUNT_OF(ranges); i++) {
        uint8_t fields[32] = {(uint8_t)(VERSION | ranges[i].type)};
        fields[TM_LENGTH_AT] = ranges[i].type == TAPEMARK_RECORD_TM ? 32 : 0;
        fields[PLACE_FLAGS_AT] = ranges[i].type == TAPEMARK_RECORD_PLACE ? TAPEMARK_PLACE_HEADED : 0;
        expect_range(fields, ranges[i].size, ranges[i].at, ranges[i].least, ranges[i].most);
    }
    /* A TM has no more bits than CMs, and no more CMs read. */
    uint8_t fields[TM_BYTES] = {VERSION | TAPEMARK_RECORD_TM};
    fields[TM_LENGTH_AT] = 5;
    expect_range(fields, sizeof fields, TM_CODE_AT, 0, 31);
    fields[TM_CODE_AT] = 0;
    expect_range(fields, sizeof fields, 19, 0, 5);
    /* What is not known has no range. */
    uint8_t place[PLACE_BYTES] = {VERSION | TAPEMARK_RECORD_PLACE};
    memset(place + 13, 0xff, 2);
    const message sent = packet_of(place, sizeof place);
    tapemark_receiver receiver = {0};
    assert_int_equal(push_message(&receiver, &sent), 1);
    assert_int_equal(receiver.record.as.place.heading_tenth_deg, 0);
}

static void both_checks_of_a_sentence_are_held(void **state)
{
    (void)state;
    tapemark_receiver receiver = {0};
    message sent = sentence_with_crc(good_place, "0000");
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 1);

    sent = sentence_of(good_place);
    sent.bytes[sent.size - 3] ^= 1;
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 2);

    /* The right value, in five digits. */
    char crc[8];
    snprintf(crc, sizeof crc, "0%.4s", strrchr((const char *)sent.bytes, ',') + 1);
    sent = sentence_with_crc(good_place, crc);
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 3);

    sent = sentence_with_crc(good_place, crc + 1);
    assert_int_equal(push_message(&receiver, &sent), 1);
    for (char *at = crc; *at != '\0'; at++)
        *at = (char)(*at >= 'A' ? *at + 'a' - 'A' : *at);
    sent = sentence_with_crc(good_place, crc + 1);
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 4);
}

static void a_checksum_has_two_upper_case_digits(void **state)
{
    (void)state;
    for (int x_mm = 0; x_mm < 256; x_mm++) {
        char fields[40];
        snprintf(fields, sizeof fields, "PTMKP,1,2,00,%d,4,", x_mm);
        const message whole = sentence_of(fields);
        for (size_t from_end = 3; from_end <= 4; from_end++)
            for (const char *bad = "/:@Gaf g"; *bad != '\0'; bad++) {
                message sent = whole;
                sent.bytes[sent.size - from_end] = (uint8_t)*bad;
                tapemark_receiver receiver = {0};
                assert_int_equal(push_message(&receiver, &sent), 0);
                assert_int_equal(receiver.damaged, 1);
            }
    }
}

static void a_line_end_ends_a_sentence(void **state)
{
    (void)state;
    static const char torn[] = "$PTMKP,1,2\r";
    tapemark_receiver receiver = {0};
    push_all(&receiver, (const uint8_t *)torn, sizeof torn - 2);
    assert_int_equal(receiver.damaged, 0);
    push_all(&receiver, (const uint8_t *)torn + sizeof torn - 2, 1);
    assert_int_equal(receiver.damaged, 1);
}

static void sentences_of_other_makers_pass_in_silence(void **state)
{
    (void)state;
    static const char others[] = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"
                                 "$PTMJF,1*00\r\n$PTNKF\r\n!AIVDM,1,1,,A,15M*00\r\nhello\r\n$\r\n$P*00\r\n";
    tapemark_receiver receiver = {0};
    assert_int_equal(push_all(&receiver, (const uint8_t *)others, sizeof others - 1), 0);
    assert_int_equal(receiver.damaged, 0);
    assert_int_equal(receiver.unknown, 0);
}

/* ---- Packets that are refused -------------------------------------------------------------------------- */

static void packets_that_break_the_rules_are_damaged(void **state)
{
    (void)state;
    static const struct {
        uint8_t size;
        uint8_t payload[60];
    } bad[] = {
        {1, {0x16}},                                      /* no fields */
        {8, {0x16, 1, 2, 3, 4, 5, 6, 7}},                 /* one byte short */
        {4, {0x17, 1, 0, 5}},                             /* a text longer than the packet */
        {10, {0x17, 1, 0, 3, 'E', 'R', 'R', 1, 2, 3}},    /* ends within a number */
        {11, {0x17, 1, 0, 3, 'E', 'R', 'R', 1, 2, 3, 4}}, /* a text missing */
        {12, {0x17, 1, 0, 3, 'E', 'R', 'R', 1, 2, 3, 4, 1}},
        {13, {0x17, 1, 0, 4, 'O', 'K', 'A', 'Y', 1, 2, 3, 4, 0}}, /* a text too long */
        {13, {0x17, 1, 0, 2, 'O', 'K', 1, 2, 3, 4, 2, 'a', ','}},
        {13, {0x17, 1, 0, 2, 'O', 'K', 1, 2, 3, 4, 2, 'a', 0}},
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        const message sent = packet_of(bad[i].payload, bad[i].size);
        tapemark_receiver receiver = {0};
        assert_int_equal(push_message(&receiver, &sent), 0);
        assert_int_equal(receiver.damaged, 1);
        assert_int_equal(receiver.unknown, 0);
    }
}

/* Whatever the CRC's bytes happen to be: lengths or letters, for instance. */
static void texts_do_not_reach_into_the_crc(void **state)
{
    (void)state;
    for (unsigned value = 0; value < 0x10000; value++) {
        const uint8_t answer[] = {0x17, (uint8_t)value, (uint8_t)(value >> 8), 2, 'O', 'K', 1, 2, 3, 4, 1};
        for (size_t size = sizeof answer - 1; size <= sizeof answer; size++) {
            const message sent = packet_of(answer, size);
            tapemark_receiver receiver = {0};
            assert_int_equal(push_message(&receiver, &sent), 0);
            assert_int_equal(receiver.damaged, 1);
        }
    }
}

/* All their bytes are there, and right, and there should have been more. */
static void packets_that_end_within_a_block_are_damaged(void **state)
{
    (void)state;
    static const uint8_t device[] = {0x16, 9, 8, 7, 6, 5, 4, 3, 2};
    message sent = packet_of(device, sizeof device);
    tapemark_receiver receiver = {0};
    assert_int_equal(sent.bytes[1], sizeof device + 3);
    assert_int_equal(push_message(&receiver, &sent), 1);
    sent.bytes[1]++;
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 1);
}

/* The part that fits is a packet by itself. */
static void packets_that_are_too_long_are_damaged(void **state)
{
    (void)state;
    const tapemark_record record = longest_record(TAPEMARK_RECORD_COMMAND);
    message sent = message_of(&record, TAPEMARK_PACKETS);
    tapemark_receiver receiver = {0};
    assert_int_equal(sent.bytes[1], TAPEMARK_PAYLOAD_MAX + 1);
    assert_int_equal(push_message(&receiver, &sent), 1);
    sent.bytes[1]++;
    sent.bytes[TAPEMARK_PACKET_MAX_BYTES - 1] = 'x';
    sent.bytes[TAPEMARK_PACKET_MAX_BYTES] = 0;
    sent.size = TAPEMARK_PACKET_MAX_BYTES + 1;
    assert_int_equal(push_message(&receiver, &sent), 0);
    assert_int_equal(receiver.damaged, 1);
}

static void a_reset_receiver_has_forgotten_everything(void **state)
{
    (void)state;
    const tapemark_record record = longest_record(TAPEMARK_RECORD_PLACE);
    for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
        const message sent = message_of(&record, encoding);
        tapemark_receiver receiver = {.damaged = 1, .unknown = 2};
        assert_int_equal(push_all(&receiver, sent.bytes, sent.size / 2), 0);
        tapemark_receiver_reset(&receiver);
        assert_int_equal(push_all(&receiver, sent.bytes + sent.size / 2, sent.size - sent.size / 2), 0);
        assert_int_equal(receiver.damaged + receiver.unknown, 0);
    }
}

static void packets_without_a_payload_are_damaged(void **state)
{
    (void)state;
    /* The second one's CRC is right, for no byte at all. */
    static const uint8_t bad[][5] = {{0, 2, 0x11, 0, 0}, {0, 3, 0xff, 0xff, 0}, {0, 1, 0, 0, 0}, {0, 1, 1, 0, 0}};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        tapemark_receiver receiver = {0};
        assert_int_equal(push_all(&receiver, bad[i], sizeof bad[i]), 0);
        assert_int_equal(receiver.damaged, 1);
        assert_int_equal(receiver.unknown, 0);
    }
}

static void a_silent_line_of_zeros_is_no_damage(void **state)
{
    (void)state;
    static const uint8_t zeros[1000];
    tapemark_receiver receiver = {0};
    assert_int_equal(push_all(&receiver, zeros, sizeof zeros), 0);
    assert_int_equal(receiver.damaged, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sentence_made_by_hand_is_taken),
        cmocka_unit_test(sentences_that_break_the_rules_are_damaged),
        cmocka_unit_test(sentences_that_stop_early_are_damaged),
        cmocka_unit_test(numbers_at_the_ends_of_their_ranges_are_taken),
        cmocka_unit_test(values_out_of_range_are_refused),
        cmocka_unit_test(both_checks_of_a_sentence_are_held),
        cmocka_unit_test(a_checksum_has_two_upper_case_digits),
        cmocka_unit_test(a_line_end_ends_a_sentence),
        cmocka_unit_test(sentences_of_other_makers_pass_in_silence),
        cmocka_unit_test(packets_that_break_the_rules_are_damaged),
        cmocka_unit_test(texts_do_not_reach_into_the_crc),
        cmocka_unit_test(packets_that_end_within_a_block_are_damaged),
        cmocka_unit_test(packets_that_are_too_long_are_damaged),
        cmocka_unit_test(a_reset_receiver_has_forgotten_everything),
        cmocka_unit_test(packets_without_a_payload_are_damaged),
        cmocka_unit_test(a_silent_line_of_zeros_is_no_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
