/* Both ends against vectors.txt, which was not made by either of them. */
#include "link_test.h"

static tapemark_record record_of(const uint8_t *bytes, size_t size)
{
    tapemark_receiver receiver = {0};
    assert_int_equal(push_all(&receiver, bytes, size), 1);
    assert_int_equal(receiver.damaged + receiver.unknown, 0);
    return receiver.record;
}

static void both_ends_agree_with_the_vectors(void **state)
{
    (void)state;
    FILE *file = fopen(LINK_VECTORS, "r");
    assert_non_null(file);
    unsigned seen[RECORD_TYPES + 1] = {0};
    for (test_vector vector; read_vector(file, &vector);) {
        const tapemark_record of_sentence = record_of(vector.sentence, vector.sentence_size);
        const tapemark_record of_packet = record_of(vector.packet, vector.packet_size);
        char text[RECORD_TEXT_BYTES];
        record_to_text(&of_sentence, text);
        assert_string_equal(text, vector.fields);
        record_to_text(&of_packet, text);
        assert_string_equal(text, vector.fields);

        const message sentence = message_of(&of_sentence, TAPEMARK_SENTENCES);
        assert_int_equal(sentence.size, vector.sentence_size);
        assert_memory_equal(sentence.bytes, vector.sentence, sentence.size);
        const message packet = message_of(&of_packet, TAPEMARK_PACKETS);
        assert_int_equal(packet.size, vector.packet_size);
        assert_memory_equal(packet.bytes, vector.packet, packet.size);
        seen[of_packet.type]++;
    }
    fclose(file);
    for (unsigned type = 1; type <= RECORD_TYPES; type++)
        assert_true(seen[type] >= 2);
}

/* Values typed here by hand, so that a field's name and its member are known to belong together. */
static void members_have_the_values_of_their_names(void **state)
{
    (void)state;
    static const char sentence[] = "$PTMKC,4711,1,01,-17,2551,2411,301,3592,97,0,1,6868*6C\r\n";
    const tapemark_record record = record_of((const uint8_t *)sentence, sizeof sentence - 1);
    const tapemark_cm_record *cm = &record.as.cm;
    assert_int_equal(record.type, TAPEMARK_RECORD_CM);
    assert_int_equal(cm->seq, 4711);
    assert_int_equal(cm->index, 1);
    assert_int_equal(cm->flags, TAPEMARK_CM_IN_TM);
    assert_int_equal(cm->id, -17);
    assert_int_equal(cm->x_tenth_px, 2551);
    assert_int_equal(cm->y_tenth_px, 2411);
    assert_int_equal(cm->size_tenth_px, 301);
    assert_int_equal(cm->angle_tenth_deg, 3592);
    assert_int_equal(cm->confidence_percent, 97);
    assert_int_equal(cm->tm, 0);
    assert_int_equal(cm->slot, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_ends_agree_with_the_vectors),
        cmocka_unit_test(members_have_the_values_of_their_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
