/* What goes over the line and what does not, with a fake in the sink's place that is ready when the tests say so. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "record_line.h"

static const int64_t ms = 1000000;

static struct {
    bool ready;
    unsigned groups;
    tapemark_receiver receiver;
    unsigned frames, answers;           /* that were sent */
    tapemark_frame_record last_frame;
    char commands[4096];                /* that have come */
    size_t commands_size, commands_taken;
} fake;

static char sink_memory;

record_sink *__wrap_record_sink_open(const char *name, error_text *error)
{
    (void)name;
    (void)error;
    return (record_sink *)(void *)&sink_memory;
}

void __wrap_record_sink_close(record_sink *sink)
{
    (void)sink;
}

record_sink_state __wrap_record_sink_state_of(const record_sink *sink)
{
    (void)sink;
    return RECORD_SINK_OPEN;
}

bool __wrap_record_sink_ready(const record_sink *sink)
{
    (void)sink;
    return fake.ready;
}

/* One group, and it is busy. */
void __wrap_record_sink_send(record_sink *sink, const uint8_t *group, size_t size, unsigned record_count)
{
    (void)sink;
    (void)record_count;
    fake.ready = false;
    fake.groups++;
    for (size_t i = 0; i < size; i++) {
        const tapemark_record_type type = tapemark_receiver_push(&fake.receiver, group[i]);
        fake.answers += type == TAPEMARK_RECORD_ANSWER;
        fake.frames += type == TAPEMARK_RECORD_FRAME;
        if (type == TAPEMARK_RECORD_FRAME)
            fake.last_frame = fake.receiver.record.as.frame;
    }
}

int64_t __wrap_record_sink_last_byte_ns(const record_sink *sink)
{
    (void)sink;
    return 0;
}

record_sink_counts __wrap_record_sink_counts_of(const record_sink *sink)
{
    (void)sink;
    return (record_sink_counts){0};
}

size_t __wrap_record_sink_read(record_sink *sink, uint8_t *bytes, size_t size)
{
    (void)sink;
    const size_t left = fake.commands_size - fake.commands_taken, count = size < left ? size : left;
    memcpy(bytes, fake.commands + fake.commands_taken, count);
    fake.commands_taken += count;
    return count;
}

/* ---- Helpers ------------------------------------------------------------------------------------------------- */

static record_line line;
static const int64_t start_ns = INT64_C(5000000000);

static int begin(void **state)
{
    (void)state;
    error_text error;
    memset(&fake, 0, sizeof fake);
    memset(&line, 0, sizeof line);
    return record_line_open(&line, "-", &error) ? 0 : -1;
}

static void offer(uint16_t seq, int64_t capture_ns)
{
    frame_records *records = record_line_place(&line, 0);
    const frame_circumstances about = {.seq = seq, .capture_ns = capture_ns, .markers_max = 1};
    frame_records_of_loss(&about, records);
    records->capture_ns = capture_ns;
    records->records[0].as.frame.flags |= TAPEMARK_FRAME_TIMED;
    record_line_offer(&line);
}

static void get_ready(int64_t now_ns)
{
    fake.ready = true;
    record_line_go_on(&line, now_ns);
}

/* ---- Frames -------------------------------------------------------------------------------------------------- */

static void newest_frame_takes_the_place_of_the_one_that_waits(void **state)
{
    (void)state;
    for (uint16_t seq = 1; seq <= 4; seq++)
        offer(seq, start_ns + seq * 33 * ms);
    get_ready(start_ns + 5 * 33 * ms);
    assert_int_equal(fake.frames, 1);
    assert_int_equal(fake.last_frame.seq, 4);
    assert_int_equal(fake.last_frame.dropped, 3);
    assert_int_equal(fake.last_frame.age_10us, 3300);
}

/* Nothing newer has come, the line was busy, and now it would be passed off as fresh. */
static void frame_that_waited_too_long_is_left_out(void **state)
{
    (void)state;
    offer(1, start_ns);
    get_ready(start_ns + ms);
    offer(2, start_ns + 33 * ms);
    get_ready(start_ns + 33 * ms + 66 * ms);
    assert_int_equal(fake.frames, 1);
    offer(3, start_ns + 133 * ms);
    get_ready(start_ns + 140 * ms);
    assert_int_equal(fake.frames, 2);
    assert_int_equal(fake.last_frame.seq, 3);
    assert_int_equal(fake.last_frame.dropped, 1);
    assert_true(fake.last_frame.flags & TAPEMARK_FRAME_FRAMES_DROPPED);
    assert_true(record_line_records_dropped(&line) > 0);
}

static void frame_of_two_frame_times_is_sent(void **state)
{
    (void)state;
    offer(1, start_ns);
    offer(2, start_ns + 33 * ms);
    get_ready(start_ns + 33 * ms + 65 * ms);
    assert_int_equal(fake.frames, 1);
    assert_int_equal(fake.last_frame.age_10us, 6500);
}

/* Frames of a machine that needs 100 ms for each, from a camera that gives one each 33 ms: they are what there is. */
static void slow_machine_sends_what_it_has(void **state)
{
    (void)state;
    for (uint16_t i = 0; i < 20; i++) {
        const int64_t capture_ns = start_ns + i * 100 * ms;
        offer(i, capture_ns);
        get_ready(capture_ns + 120 * ms);
    }
    assert_int_equal(fake.frames, 20);
}

/* That there is no camera stays true. */
static void loss_of_the_camera_does_not_grow_old(void **state)
{
    (void)state;
    offer(1, start_ns);
    offer(2, start_ns + 33 * ms);
    const frame_circumstances about = {.seq = 3, .capture_ns = FRAME_TIME_UNKNOWN};
    frame_records_of_loss(&about, record_line_place(&line, 0));
    record_line_offer(&line);
    get_ready(start_ns + 5000 * ms);
    assert_int_equal(fake.frames, 1);
    assert_true(fake.last_frame.flags & TAPEMARK_FRAME_CAMERA_LOST);
}

/* ---- Commands ------------------------------------------------------------------------------------------------ */

static void push_commands(unsigned count)
{
    for (uint16_t i = 0; i < count; i++)
        fake.commands_size += tapemark_command_write(fake.commands + fake.commands_size,
                                                     sizeof fake.commands - fake.commands_size, i, "PING", NULL, "1");
}

static unsigned answer_all(void)
{
    unsigned answered = 0;
    tapemark_command_record command;
    while (record_line_command(&line, &command)) {
        tapemark_record answer = {.type = TAPEMARK_RECORD_ANSWER};
        snprintf(answer.as.answer.result, sizeof answer.as.answer.result, "OK");
        record_line_say_answer(&line, &answer);
        answered++;
    }
    return answered;
}

/* However many commands come, each is answered, and every second group is a frame. */
static void flood_of_commands_holds_up_no_frames(void **state)
{
    (void)state;
    unsigned answered = 0;
    push_commands(60);
    for (uint16_t i = 0; i < 40; i++) {
        const unsigned now_answered = answer_all();
        assert_true(now_answered <= ANSWERS_MAX);
        answered += now_answered;
        offer(i, start_ns + i * 33 * ms);
        get_ready(start_ns + i * 33 * ms + ms);
    }
    assert_int_equal(answered, 60);
    assert_int_equal(fake.answers, 60);
    assert_true(fake.frames >= 20);
    assert_int_equal(record_line_records_dropped(&line) + fake.frames, 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(newest_frame_takes_the_place_of_the_one_that_waits, begin),
        cmocka_unit_test_setup(frame_that_waited_too_long_is_left_out, begin),
        cmocka_unit_test_setup(frame_of_two_frame_times_is_sent, begin),
        cmocka_unit_test_setup(slow_machine_sends_what_it_has, begin),
        cmocka_unit_test_setup(loss_of_the_camera_does_not_grow_old, begin),
        cmocka_unit_test_setup(flood_of_commands_holds_up_no_frames, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
