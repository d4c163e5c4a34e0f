/* The microcontroller's end on an undamaged line: what it takes, and what it lets pass. */
#include "handmade.h"

/* ---- Records come out as they went in ----------------------------------------------------------------- */

static void crc_is_the_one_of_the_page(void **state)
{
    (void)state;
    uint16_t crc = 0xffff;
    for (const char *at = "123456789"; *at != '\0'; at++)
        crc = tapemark_crc16(crc, (uint8_t)*at);
    assert_int_equal(crc, 0x29b1);
    assert_int_equal(slow_crc((const uint8_t *)"123456789", 9), 0x29b1);
}

static void records_come_out_as_they_went_in(void **state)
{
    (void)state;
    uint32_t random = 1;
    tapemark_receiver receiver = {0};
    for (int round = 0; round < 40000; round++) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
        const tapemark_encoding encoding = random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
        const message sent = message_of(&record, encoding);
        assert_int_equal(push_message(&receiver, &sent), 1);
        assert_same_record(&receiver.record, &record);
    }
    assert_int_equal(receiver.damaged, 0);
    assert_int_equal(receiver.unknown, 0);
}

/* Its state is all in it: it may stop after any byte, lie elsewhere in memory, and go on. */
static void receiver_may_pause_and_move_after_any_byte(void **state)
{
    (void)state;
    uint32_t random = 2;
    for (uint8_t type = 1; type <= RECORD_TYPES; type++)
        for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
            const tapemark_record record = random_record(&random, type);
            const message sent = message_of(&record, encoding);
            for (size_t split = 0; split <= sent.size; split++) {
                tapemark_receiver first = {0};
                int records = push_all(&first, sent.bytes, split);
                tapemark_receiver *second = malloc(sizeof *second);
                assert_non_null(second);
                memcpy(second, &first, sizeof first);
                memset(&first, 0xa5, sizeof first);
                records += push_all(second, sent.bytes + split, sent.size - split);
                assert_int_equal(records, 1);
                assert_same_record(&second->record, &record);
                free(second);
            }
        }
}

static void two_receivers_do_not_disturb_each_other(void **state)
{
    (void)state;
    uint32_t random = 3;
    tapemark_receiver receivers[2] = {{.damaged = 0}, {.damaged = 0}};
    for (int round = 0; round < 1000; round++) {
        const tapemark_record one = random_record(&random, TAPEMARK_RECORD_CM);
        const tapemark_record other = random_record(&random, TAPEMARK_RECORD_TM);
        const message sent[2] = {message_of(&one, TAPEMARK_SENTENCES), message_of(&other, TAPEMARK_PACKETS)};
        int records[2] = {0, 0};
        for (size_t i = 0; i < TAPEMARK_SENTENCE_MAX_BYTES; i++)
            for (int end = 0; end < 2; end++)
                if (i < sent[end].size)
                    records[end] += push_all(&receivers[end], sent[end].bytes + i, 1);
        assert_int_equal(records[0], 1);
        assert_int_equal(records[1], 1);
        assert_same_record(&receivers[0].record, &one);
        assert_same_record(&receivers[1].record, &other);
    }
}

static void a_sentence_is_complete_with_its_checksum(void **state)
{
    (void)state;
    const tapemark_record record = {.type = TAPEMARK_RECORD_DEVICE};
    const message sent = message_of(&record, TAPEMARK_SENTENCES);
    tapemark_receiver receiver = {0};
    assert_int_equal(push_all(&receiver, sent.bytes, sent.size - 3), 0);
    assert_int_equal(push_all(&receiver, sent.bytes + sent.size - 3, 1), 1);
    assert_int_equal(push_message(&receiver, &sent), 1);
    assert_int_equal(receiver.damaged, 0);
}

static void one_zero_between_packets_will_do(void **state)
{
    (void)state;
    uint32_t random = 4;
    tapemark_receiver receiver = {0};
    tapemark_receiver_push(&receiver, 0);
    for (int round = 0; round < 100; round++) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + round % RECORD_TYPES));
        const message sent = message_of(&record, TAPEMARK_PACKETS);
        assert_int_equal(push_all(&receiver, sent.bytes + 1, sent.size - 1), 1);
        assert_same_record(&receiver.record, &record);
    }
}

/* ---- What depends on a flag --------------------------------------------------------------------------- */

static void a_field_without_its_flag_is_zero_whatever_is_sent(void **state)
{
    (void)state;
    static const uint8_t place[] = {0x14, 1, 0, 2, 0, 3, 0, 0, 0, 4, 0, 0, 0, 0x10, 0x0e};
    tapemark_receiver receiver;
    memset(&receiver.record, 0xff, sizeof receiver.record);
    tapemark_receiver_reset(&receiver);
    const message sent = packet_of(place, sizeof place);
    assert_int_equal(push_message(&receiver, &sent), 1);
    assert_int_equal(receiver.record.as.place.y_mm, 4);
    assert_int_equal(receiver.record.as.place.heading_tenth_deg, 0);
}

static void no_flag_of_the_upper_byte_makes_a_field_known(void **state)
{
    (void)state;
    tapemark_record record = longest_record(TAPEMARK_RECORD_FRAME);
    record.as.frame.flags = 0xff00;
    const message sent = message_of(&record, TAPEMARK_PACKETS);
    tapemark_receiver receiver = {0};
    assert_int_equal(push_message(&receiver, &sent), 1);
    assert_int_equal(receiver.record.as.frame.capture_us, 0);
    assert_int_equal(receiver.record.as.frame.flags, 0xff00);
    assert_int_equal(receiver.record.as.frame.width_px, 6553);
}

/* ---- Later versions ------------------------------------------------------------------------------------ */

static void appended_fields_are_left_aside(void **state)
{
    (void)state;
    tapemark_receiver receiver = {0};
    const message sentence = sentence_of("PTMKP,1,2,01,-3,4,5,6,,seven");
    assert_int_equal(push_message(&receiver, &sentence), 1);
    assert_int_equal(receiver.record.as.place.heading_tenth_deg, 5);

    static const uint8_t device[] = {0x16, 9, 0, 0, 0, 0, 1, 2, 1, 0, 77, 0};
    const message packet = packet_of(device, sizeof device);
    assert_int_equal(push_message(&receiver, &packet), 1);
    assert_int_equal(receiver.record.as.device.uptime_s, 9);
    assert_int_equal(receiver.damaged + receiver.unknown, 0);
}

static void new_records_are_counted_as_unknown(void **state)
{
    (void)state;
    tapemark_receiver receiver = {0};
    const message sentence = sentence_of("PTMKX,1,2,3");
    assert_int_equal(push_message(&receiver, &sentence), 0);
    assert_int_equal(receiver.unknown, 1);
    static const uint8_t heads[] = {0x00, 0x10, 0x19, 0x1a, 0x1f, 0x01, 0x26, 0xf6};
    for (uint16_t i = 0; i < sizeof heads; i++) {
        const uint8_t device[] = {heads[i], 9, 0, 0, 0, 0, 1, 0, 1};
        const message packet = packet_of(device, sizeof device);
        assert_int_equal(push_message(&receiver, &packet), 0);
        assert_int_equal(receiver.unknown, 2 + i);
    }
    assert_int_equal(receiver.damaged, 0);
}

/* ---- Commands ------------------------------------------------------------------------------------------ */

static void commands_are_read_as_they_were_written(void **state)
{
    (void)state;
    tapemark_receiver receiver = {0};
    char buffer[TAPEMARK_SENTENCE_MAX_BYTES];
    const uint16_t numbers[] = {0, 7, 10, 99, 100, 12345, 65535};
    for (size_t i = 0; i < COUNT_OF(numbers); i++) {
        const size_t size = tapemark_command_write(buffer, sizeof buffer, numbers[i], "SET", "exposure", "500");
        tapemark_record expected = {.type = TAPEMARK_RECORD_COMMAND};
        expected.as.command = (tapemark_command_record){numbers[i], "SET", "exposure", "500"};
        assert_int_equal(push_all(&receiver, (const uint8_t *)buffer, size), 1);
        assert_same_record(&receiver.record, &expected);

        const message sent = message_of(&expected, TAPEMARK_SENTENCES);
        assert_int_equal(size, sent.size);
        assert_memory_equal(buffer, sent.bytes, size);
    }
    const size_t size = tapemark_command_write(buffer, sizeof buffer, 1, "VERSION", NULL, NULL);
    assert_int_equal(push_all(&receiver, (const uint8_t *)buffer, size), 1);
    assert_string_equal(receiver.record.as.command.verb, "VERSION");
    assert_string_equal(receiver.record.as.command.name, "");
}

static void commands_fit_or_are_refused(void **state)
{
    (void)state;
    const tapemark_record longest = longest_record(TAPEMARK_RECORD_COMMAND);
    const tapemark_command_record *command = &longest.as.command;
    const size_t needed = message_of(&longest, TAPEMARK_SENTENCES).size;
    for (size_t size = 0; size <= needed; size++) {
        char *buffer = malloc(size > 0 ? size : 1);
        assert_non_null(buffer);
        const size_t written =
            tapemark_command_write(buffer, size, command->number, command->verb, command->name, command->value);
        assert_int_equal(written, size == needed ? needed : 0);
        free(buffer);
    }
}

static void commands_out_of_range_are_refused(void **state)
{
    (void)state;
    char buffer[TAPEMARK_SENTENCE_MAX_BYTES];
    assert_int_equal(tapemark_command_write(buffer, sizeof buffer, 1, "VERSIONS", NULL, NULL), 0);
    assert_int_equal(tapemark_command_write(buffer, sizeof buffer, 1, "GET", "a name that is long", NULL), 0);
    assert_int_equal(
        tapemark_command_write(buffer, sizeof buffer, 1, "SET", "roi", "a value of more than 31 letters."), 0);
    assert_int_equal(tapemark_command_write(buffer, sizeof buffer, 1, "SET", "roi", "1,2"), 0);
    assert_int_equal(tapemark_command_write(buffer, sizeof buffer, 1, "SET", "roi*", "1"), 0);
    assert_int_equal(tapemark_command_write(buffer, sizeof buffer, 1, "SE\nT", "roi", "1"), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crc_is_the_one_of_the_page),
        cmocka_unit_test(records_come_out_as_they_went_in),
        cmocka_unit_test(receiver_may_pause_and_move_after_any_byte),
        cmocka_unit_test(two_receivers_do_not_disturb_each_other),
        cmocka_unit_test(a_sentence_is_complete_with_its_checksum),
        cmocka_unit_test(one_zero_between_packets_will_do),
        cmocka_unit_test(a_field_without_its_flag_is_zero_whatever_is_sent),
        cmocka_unit_test(no_flag_of_the_upper_byte_makes_a_field_known),
        cmocka_unit_test(appended_fields_are_left_aside),
        cmocka_unit_test(new_records_are_counted_as_unknown),
        cmocka_unit_test(commands_are_read_as_they_were_written),
        cmocka_unit_test(commands_fit_or_are_refused),
        cmocka_unit_test(commands_out_of_range_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
