/* The line, treated badly: its other end reads at another rate, sends everything back, or talks nonsense without
 * end. */
#include "stream_test.h"

#include "uart.h"

enum { RATE_HZ = 50 };

static walk_check check;

/* Until that many more frames are whole. */
static void expect_frames(unsigned count)
{
    const uint64_t wanted = check.frames + count;
    tapemark_record record;
    while (check.frames < wanted) {
        if (!host_record(&host, SOON_MS, &record)) {
            host_says(&host, "\n", 0);
            fail_msg("no record came; the program said: %s", host.said);
        }
        walk_check_record(&check, &record);
    }
    if (check.wrong > 0)
        fail_msg("%s", check.complaint);
}

static void start_walk(const char *encoding)
{
    check = (walk_check){.walk = &walk};
    start(ARGUMENTS("--camera", WALK "@50", "--repeat", "yes", "--serial", "LINE:921600", "--encoding", encoding));
    expect_frames(3);
}

/* ---- Another rate -------------------------------------------------------------------------------------------- */

static double other_rate;
static size_t misread_bytes;

static size_t misread(void *context, uint8_t *bytes, size_t size)
{
    uint8_t sent[HOST_READ_BYTES];
    (void)context;
    misread_bytes += size;
    memcpy(sent, bytes, size);
    return uart_misread(sent, size, other_rate, bytes, sizeof host.bytes);
}

/* What the program takes a command for that is sent to it at another rate. */
static void send_misread(uint16_t number)
{
    char sentence[TAPEMARK_SENTENCE_MAX_BYTES];
    uint8_t bytes[2 * TAPEMARK_SENTENCE_MAX_BYTES];
    const size_t size = tapemark_command_write(sentence, sizeof sentence, number, "SET", "encoding", "cobs");
    const size_t misread_size = uart_misread((const uint8_t *)sentence, size, 1 / other_rate, bytes, sizeof bytes);
    assert_true(write(host.line, bytes, misread_size) >= 0);
}

/* The model of the wire itself: at the right rate, bytes are what they are. */
static void a_uart_at_its_rate_reads_right(void **state)
{
    (void)state;
    uint8_t sent[256], seen[512];
    for (size_t i = 0; i < sizeof sent; i++)
        sent[i] = (uint8_t)i;
    assert_int_equal(uart_misread(sent, sizeof sent, 1, seen, sizeof seen), sizeof sent);
    assert_memory_equal(seen, sent, sizeof sent);
    assert_int_equal(uart_misread(sent, sizeof sent, 1.03, seen, sizeof seen), sizeof sent);
    assert_memory_equal(seen, sent, sizeof sent);
    const size_t half = uart_misread(sent, sizeof sent, 0.5, seen, sizeof seen);
    assert_in_range(half, sizeof sent / 4, sizeof sent);
    assert_memory_not_equal(seen, sent, half);
}

/* So many bytes, of several frames; what is believed of them has to be right. */
static void watch_misread(void)
{
    enum { MISREAD_BYTES = 1000 };
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
    tapemark_record record;
    misread_bytes = 0;
    host.on_bytes = misread;
    while (misread_bytes < MISREAD_BYTES && host_clock_ns() < deadline_ns)
        if (host_record(&host, 20, &record))
            walk_check_record(&check, &record);
    host.on_bytes = NULL;
    assert_true(misread_bytes >= MISREAD_BYTES);
    if (check.wrong > 0)
        fail_msg("%s", check.complaint);
}

static void read_at_other_rates(const char *encoding)
{
    static const double rates[] = {0.5, 2, 1.0 / 3, 1.0 / 12, 0.9, 1.5};
    start_walk(encoding);
    for (uint16_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        const uint16_t damaged = host.receiver.damaged;
        other_rate = rates[i];
        send_misread(i);
        watch_misread();
        /* The frame in which it changes back is not whole. */
        check.harmed = true;
        check.expected = 0;
        expect_frames(3);
        assert_true(host.receiver.damaged != damaged || strcmp(encoding, "nmea") == 0);
    }
    assert_int_equal(check.misplaced + check.unexplained, 0);
    expect_silence();
}

static void sentences_at_other_rates_are_not_believed(void **state)
{
    (void)state;
    read_at_other_rates("nmea");
}

static void packets_at_other_rates_are_not_believed(void **state)
{
    (void)state;
    read_at_other_rates("cobs");
}

/* ---- An echo ------------------------------------------------------------------------------------------------- */

static unsigned answers;

static size_t echo(void *context, uint8_t *bytes, size_t size)
{
    (void)context;
    size_t sent = 0;
    while (sent < size) {
        const ssize_t count = write(host.line, bytes + sent, size - sent);
        sent += count > 0 ? (size_t)count : 0;
        if (count <= 0)
            host_sleep_ms(1);
    }
    return size;
}

static void watch_echo(const char *encoding)
{
    tapemark_record record;
    start_walk(encoding);
    host.on_bytes = echo;
    expect_frames(RATE_HZ / 2);
    /* Answers come back as well, and are no commands. What comes back may just be in the middle of a packet. */
    assert_int_equal(write(host.line, "", 1), 1);
    host_command(&host, 1, "PING", NULL, "there");
    answers = 0;
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
    uint64_t end = check.frames + RATE_HZ / 2;
    while (check.frames < end && host_clock_ns() < deadline_ns) {
        assert_true(host_record(&host, SOON_MS, &record));
        walk_check_record(&check, &record);
        answers += record.type == TAPEMARK_RECORD_ANSWER;
        end = answers == 0 ? check.frames + RATE_HZ / 2 : end;
    }
    assert_int_equal(answers, 1);
    assert_int_equal(check.wrong + check.misplaced + check.unexplained + check.incomplete, 0);
    expect_silence();
}

static void sentences_that_come_back_change_nothing(void **state)
{
    (void)state;
    watch_echo("nmea");
}

static void packets_that_come_back_change_nothing(void **state)
{
    (void)state;
    watch_echo("cobs");
}

/* ---- Nonsense ------------------------------------------------------------------------------------------------ */

static size_t fill_with_nonsense(unsigned kind, uint8_t *bytes, size_t size)
{
    static const char *const texts[] = {"$PTMKQ,", "$", "$PTMKQ,1,SET,exposure,", "*00\r\n", "\r\n"};
    static uint32_t dice = 1;
    const char *text = texts[kind % (sizeof texts / sizeof *texts)];
    for (size_t i = 0; i < size; i++) {
        dice = dice * 1664525 + 1013904223;
        bytes[i] = kind == 0 ? (uint8_t)(dice >> 24) : kind == 1 ? 0 : (uint8_t)text[i % strlen(text)];
    }
    return size;
}

/* As much as the line carries, and no command in it: for so many bytes of each kind, and so many frames. */
static void endless_nonsense_changes_nothing(void **state)
{
    (void)state;
    enum { KINDS = 7, KIND_FRAMES = 8, KIND_BYTES = 50000 };
    uint8_t nonsense[2048];
    tapemark_record record;
    unsigned too_old = 0;
    start_walk("nmea");
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * 2 * SOON_MS;
    for (unsigned kind = 0; kind < KINDS; kind++) {
        const size_t size = fill_with_nonsense(kind, nonsense, sizeof nonsense);
        const uint64_t frames = check.frames;
        uint64_t bytes = 0;
        while (bytes < KIND_BYTES || check.frames < frames + KIND_FRAMES) {
            assert_true(host_clock_ns() < deadline_ns);
            const ssize_t count = write(host.line, nonsense, size);
            bytes += count > 0 ? (uint64_t)count : 0;
            while (host_record(&host, 1, &record)) {
                walk_check_record(&check, &record);
                too_old += record.type == TAPEMARK_RECORD_FRAME && is_too_old(&record.as.frame, RATE_HZ);
                assert_int_not_equal(record.type, TAPEMARK_RECORD_ANSWER);
            }
        }
    }
    assert_int_equal(too_old, 0);
    assert_int_equal(check.wrong + check.misplaced + check.unexplained, 0);
    /* And then a command is one again. */
    assert_int_equal(write(host.line, "\r\n", 2), 2);
    host_command(&host, 7, "PING", NULL, "there");
    const tapemark_record answer = expect_record(TAPEMARK_RECORD_ANSWER);
    assert_int_equal(answer.as.answer.number, 7);
    assert_string_equal(answer.as.answer.result, "OK");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_uart_at_its_rate_reads_right),
        cmocka_unit_test_setup_teardown(sentences_at_other_rates_are_not_believed, open_host, close_host),
        cmocka_unit_test_setup_teardown(packets_at_other_rates_are_not_believed, open_host, close_host),
        cmocka_unit_test_setup_teardown(sentences_that_come_back_change_nothing, open_host, close_host),
        cmocka_unit_test_setup_teardown(packets_that_come_back_change_nothing, open_host, close_host),
        cmocka_unit_test_setup_teardown(endless_nonsense_changes_nothing, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
