/* The whole program: frames of a recording in, through a terminal, to the microcontroller's receiver. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cmocka.h>

#include "stream_host.h"
#include "truth.h"

#define WALK "file:" STREAM_DATA "/walk.y4m"
#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

enum { SOON_MS = 10000, WALK_FRAMES = 24 };

static truth walk;
static stream_host host;

static int read_truth(void **state)
{
    (void)state;
    return truth_read(STREAM_DATA "/walk.jsonl", &walk) && walk.count == WALK_FRAMES ? 0 : -1;
}

static int open_host(void **state)
{
    (void)state;
    return host_open(&host) ? 0 : -1;
}

static int close_host(void **state)
{
    (void)state;
    host_close(&host);
    return 0;
}

static void start(const char *const *arguments)
{
    assert_true(host_start(&host, STREAM_PROGRAM, arguments));
}

static tapemark_record expect_record(tapemark_record_type type)
{
    tapemark_record record;
    if (!host_record_of(&host, type, SOON_MS, &record))
        fail_msg("no record of type %d came; the program said: %s", (int)type, host.said);
    return record;
}

/* ---- Every record is right --------------------------------------------------------------------------------------- */

typedef struct seen_records {
    unsigned frames, cms, tms, wrong, incomplete, old;
    uint16_t last_seq;
    unsigned expected;  /* of the frame that is coming in */
    unsigned dropped;
} seen_records;

static void check_frame(seen_records *seen, const tapemark_frame_record *frame)
{
    const uint16_t needed = TAPEMARK_FRAME_TIMED | TAPEMARK_FRAME_REPLAYED;
    seen->incomplete += seen->expected > 0;
    seen->expected = frame->records;
    seen->frames++;
    seen->dropped += frame->dropped;
    seen->wrong += (frame->flags & needed) != needed || frame->width_px != 480 || frame->height_px != 270;
    seen->wrong += (frame->dropped > 0) != ((frame->flags & TAPEMARK_FRAME_FRAMES_DROPPED) != 0);
    if (seen->frames > 1)
        seen->wrong += (uint16_t)(seen->last_seq + frame->dropped + 1) != frame->seq;
    seen->last_seq = frame->seq;
}

/* With what is right of a frame of this recording, over and over. */
static void check_record(seen_records *seen, const tapemark_record *record)
{
    const true_frame *now = &walk.frames[(seen->last_seq + WALK_FRAMES - 1) % WALK_FRAMES];
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        check_frame(seen, &record->as.frame);
        return;
    case TAPEMARK_RECORD_CM:
        seen->cms++;
        seen->wrong += record->as.cm.seq != seen->last_seq || !truth_has_cm(now, &record->as.cm);
        break;
    case TAPEMARK_RECORD_TM:
        seen->tms++;
        seen->wrong += record->as.tm.seq != seen->last_seq || !truth_has_tm(now, &record->as.tm);
        break;
    case TAPEMARK_RECORD_STATUS:
    case TAPEMARK_RECORD_DEVICE:
    case TAPEMARK_RECORD_ANSWER:
        return;
    default:
        seen->wrong++;
    }
    seen->incomplete += seen->expected == 0;
    seen->expected -= seen->expected > 0;
}

static seen_records watch_walk(const char *encoding)
{
    seen_records seen = {0};
    tapemark_record record;
    start(ARGUMENTS("--camera", WALK, "--serial", "LINE:921600", "--encoding", encoding));
    while (seen.frames < WALK_FRAMES || seen.expected > 0) {
        if (!host_record(&host, SOON_MS, &record))
            fail_msg("after %u frames no record came; the program said: %s", seen.frames, host.said);
        check_record(&seen, &record);
    }
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    return seen;
}

static void assert_walk_is_right(const seen_records *seen)
{
    assert_int_equal(seen->wrong, 0);
    assert_int_equal(seen->incomplete, 0);
    assert_int_equal(seen->dropped, 0);
    assert_true(seen->cms >= 90);
    assert_true(seen->tms >= 8);
    assert_int_equal(host.receiver.damaged, 0);
    assert_int_equal(host.receiver.unknown, 0);
    assert_string_equal(host.said, "");
}

static void sentences_are_right(void **state)
{
    (void)state;
    seen_records seen = watch_walk("nmea");
    assert_walk_is_right(&seen);
}

static void packets_are_right(void **state)
{
    (void)state;
    seen_records seen = watch_walk("cobs");
    assert_walk_is_right(&seen);
}

/* ---- Too slow, too late, gone -------------------------------------------------------------------------------------- */

/* 9600 baud carry a frame in 0.4 s; frames come every 0.1 s. */
static void slow_line_gets_new_frames(void **state)
{
    (void)state;
    const unsigned frame_time_10us = 10000;
    unsigned frames = 0, dropped = 0;
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "LINE:9600", "--encoding", "nmea"));
    while (frames < 6) {
        tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        assert_true(record.as.frame.flags & TAPEMARK_FRAME_TIMED);
        assert_in_range(record.as.frame.age_10us, 0, 2 * frame_time_10us);
        dropped += record.as.frame.dropped;
        frames++;
    }
    assert_true(dropped >= 6);
    tapemark_record status = expect_record(TAPEMARK_RECORD_STATUS);
    assert_true(status.as.status.records_dropped > 0);
    assert_true(status.as.status.frames_dropped >= dropped / 2);
}

/* Nobody takes the bytes for two seconds: then come new frames, not those of then. */
static void stalled_line_comes_back(void **state)
{
    (void)state;
    tapemark_record record;
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--serial", "LINE:921600", "--encoding", "cobs"));
    expect_record(TAPEMARK_RECORD_FRAME);
    host_sleep_ms(500);
    /* As a wire whose other end holds it up: nothing leaves, however long. */
    assert_int_equal(tcflow(host.device, TCOOFF), 0);
    host_sleep_ms(2500);
    assert_int_equal(tcflow(host.device, TCOON), 0);
    host_forget(&host);
    do {
        record = expect_record(TAPEMARK_RECORD_FRAME);
    } while (record.as.frame.dropped == 0);
    assert_true(record.as.frame.dropped >= 20);
    record = expect_record(TAPEMARK_RECORD_FRAME);
    assert_in_range(record.as.frame.age_10us, 0, 10000);
    do {
        record = expect_record(TAPEMARK_RECORD_STATUS);
    } while (!(record.as.status.flags & TAPEMARK_STATUS_PORT_STALLED) && record.as.status.records_dropped == 0);
    assert_int_equal(kill(host.program, 0), 0);
}

/* The port goes away, as an adapter that is pulled out, and comes back under the same name. */
static void lost_line_comes_back(void **state)
{
    (void)state;
    char link_path[] = "/tmp/tapemark-stream-port-XXXXXX";
    assert_int_not_equal(mkstemp(link_path), -1);
    unlink(link_path);
    assert_int_equal(symlink(host.device_path, link_path), 0);
    char argument[100];
    snprintf(argument, sizeof argument, "%s:115200", link_path);
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", argument));
    expect_record(TAPEMARK_RECORD_FRAME);
    host_unplug(&host);
    assert_true(host_says(&host, link_path, SOON_MS));
    stream_host second;
    assert_true(host_open(&second));
    unlink(link_path);
    assert_int_equal(symlink(second.device_path, link_path), 0);
    host.line = second.line;
    host.device = second.device;
    tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
    assert_in_range(record.as.frame.age_10us, 0, 20000);
    expect_record(TAPEMARK_RECORD_CM);
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    unlink(link_path);
}

static void absent_line_is_waited_for(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "/dev/tapemark-is-not-there"));
    assert_true(host_says(&host, "/dev/tapemark-is-not-there", SOON_MS));
    host_sleep_ms(1500);
    assert_int_equal(host_count_said(&host, "\n"), 1);
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
}

/* ---- Being told to end, and to read again --------------------------------------------------------------------------- */

static void term_ends_within_a_frame(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@5", "--repeat", "yes", "--serial", "LINE"));
    expect_record(TAPEMARK_RECORD_FRAME);
    const int64_t told_ns = host_clock_ns();
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    assert_in_range(host_clock_ns() - told_ns, 0, 200000000);
    assert_string_equal(host.said, "");
}

static void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void broken_settings_leave_the_old_ones(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-config-XXXXXX";
    const int file = mkstemp(path);
    assert_int_not_equal(file, -1);
    close(file);
    write_file(path, "# a walk, again and again\ncamera = " WALK "@10\nrepeat = yes\nencoding = nmea\n");
    start(ARGUMENTS("--config", path, "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);

    write_file(path, "encoding = morse\n");
    assert_int_equal(kill(host.program, SIGHUP), 0);
    assert_true(host_says(&host, "line 1: encoding: expected nmea or cobs, not 'morse'\n", SOON_MS));
    host_forget(&host);
    expect_record(TAPEMARK_RECORD_FRAME);

    write_file(path, "camera = " WALK "@10\nrepeat = yes\nencoding = cobs\n");
    host_forget(&host);
    assert_int_equal(kill(host.program, SIGHUP), 0);
    assert_true(host_says(&host, "settings and map were read again\n", SOON_MS));
    host_forget(&host);
    host_command(&host, 7, "GET", "encoding", NULL);
    tapemark_record answer = expect_record(TAPEMARK_RECORD_ANSWER);
    assert_string_equal(answer.as.answer.text, "cobs");
    unlink(path);
}

static const char no_map[] = "{\"walls\": 1}";

static void broken_map_leaves_the_old_one(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-map-XXXXXX", copy[200];
    const int file = mkstemp(path);
    assert_int_not_equal(file, -1);
    close(file);
    snprintf(copy, sizeof copy, "cp '%s' %s", STREAM_DATA "/map.json", path);
    assert_int_equal(system(copy), 0);
    start(ARGUMENTS("--camera", "raw:YUYV:320x180," STREAM_DATA "/room-walk-yuyv-320x180.raw@10", "--repeat", "yes",
                    "--map", path, "--serial", "LINE:921600"));
    tapemark_record place = expect_record(TAPEMARK_RECORD_PLACE);
    assert_true(place.as.place.flags & TAPEMARK_PLACE_HEADED);

    write_file(path, no_map);
    assert_int_equal(kill(host.program, SIGHUP), 0);
    assert_true(host_says(&host, path, SOON_MS));
    tapemark_record record;
    do {
        record = expect_record(TAPEMARK_RECORD_FRAME);
    } while (!(record.as.frame.flags & TAPEMARK_FRAME_MAP_BROKEN));
    expect_record(TAPEMARK_RECORD_PLACE);
    assert_int_equal(host_count_said(&host, "\n"), 1);
    record = expect_record(TAPEMARK_RECORD_STATUS);
    assert_true(record.as.status.flags & TAPEMARK_STATUS_MAP_BROKEN);
    assert_true(record.as.status.flags & TAPEMARK_STATUS_MAP_LOADED);
    assert_true(record.as.status.errors > 0);
    unlink(path);
}

/* ---- Commands ---------------------------------------------------------------------------------------------------- */

static void expect_answer(uint16_t number, const char *result, const char *text)
{
    tapemark_record record = expect_record(TAPEMARK_RECORD_ANSWER);
    assert_int_equal(record.as.answer.number, number);
    assert_string_equal(record.as.answer.result, result);
    assert_string_equal(record.as.answer.text, text);
}

static void commands_are_answered(void **state)
{
    (void)state;
    static const struct {
        const char *verb, *name, *value, *result, *text;
    } exchanges[] = {
        {"PING", NULL, "0123456789", "OK", "0123456789"},
        {"VERSION", NULL, NULL, "OK", "tapemark-stream " STREAM_VERSION},
        {"GET", "encoding", NULL, "OK", "nmea"},
        {"GET", "roi", NULL, "OK", "full"},
        {"SET", "roi", "400x200+10+20", "OK", "400x200+10+20"},
        {"SET", "roi", "4000x200+10+20", "ERR", "outside of 480x270 pixels"},
        {"SET", "roi", "somewhere", "ERR", "WIDTHxHEIGHT+X+Y in pixels or full"},
        {"GET", "roi", NULL, "OK", "400x200+10+20"},
        {"SET", "exposure", "500", "ERR", "is a recording: its exposure and gain ca"},
        {"SET", "exposure", "auto", "OK", "auto"},
        {"SET", "exposure", "0", "ERR", "1 to 10000000 or auto"},
        {"SET", "gain", "auto", "OK", "auto"},
        {"GET", "rate", NULL, "OK", "100"},
        {"GET", "colour", NULL, "ERR", "exposure gain rate encoding or roi"},
        {"DANCE", NULL, NULL, "ERR", "PING VERSION GET or SET"},
    };
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);
    for (uint16_t i = 0; i < sizeof exchanges / sizeof *exchanges; i++) {
        host_command(&host, i, exchanges[i].verb, exchanges[i].name, exchanges[i].value);
        expect_answer(i, exchanges[i].result, exchanges[i].text);
    }
}

/* The answer comes in the old encoding, what follows in the new one. */
static void encoding_changes_behind_the_answer(void **state)
{
    (void)state;
    uint8_t byte = 0;
    tapemark_record record;
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);
    host_command(&host, 1, "SET", "encoding", "cobs");
    expect_answer(1, "OK", "cobs");
    while (host_record(&host, SOON_MS, &record) && record.type != TAPEMARK_RECORD_FRAME)
        continue;
    byte = host.bytes[host.taken - 1];
    assert_int_equal(byte, 0);
    host_command(&host, 2, "SET", "encoding", "nmea");
    expect_answer(2, "OK", "nmea");
    expect_record(TAPEMARK_RECORD_FRAME);
    byte = host.bytes[host.taken - 1];
    assert_int_not_equal(byte, 0);
}

/* What lies outside of the region is not read, and places stay those of the whole picture. */
static void region_is_looked_at_alone(void **state)
{
    (void)state;
    unsigned cms = 0;
    start(ARGUMENTS("--camera", WALK "@30", "--repeat", "yes", "--serial", "LINE:921600", "--roi", "260x270+220+0"));
    for (unsigned frames = 0; frames < WALK_FRAMES; frames++) {
        tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        const uint16_t seq = record.as.frame.seq;
        assert_int_equal(record.as.frame.width_px, 480);
        for (unsigned i = record.as.frame.records; i > 0; i--) {
            assert_true(host_record(&host, SOON_MS, &record));
            if (record.type != TAPEMARK_RECORD_CM)
                continue;
            cms++;
            assert_in_range(record.as.cm.x_tenth_px, 2200, 4800);
            assert_true(truth_has_cm(&walk.frames[(seq - 1) % WALK_FRAMES], &record.as.cm));
        }
    }
    assert_true(cms > 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sentences_are_right, open_host, close_host),
        cmocka_unit_test_setup_teardown(packets_are_right, open_host, close_host),
        cmocka_unit_test_setup_teardown(slow_line_gets_new_frames, open_host, close_host),
        cmocka_unit_test_setup_teardown(stalled_line_comes_back, open_host, close_host),
        cmocka_unit_test_setup_teardown(lost_line_comes_back, open_host, close_host),
        cmocka_unit_test_setup_teardown(absent_line_is_waited_for, open_host, close_host),
        cmocka_unit_test_setup_teardown(term_ends_within_a_frame, open_host, close_host),
        cmocka_unit_test_setup_teardown(broken_settings_leave_the_old_ones, open_host, close_host),
        cmocka_unit_test_setup_teardown(broken_map_leaves_the_old_one, open_host, close_host),
        cmocka_unit_test_setup_teardown(commands_are_answered, open_host, close_host),
        cmocka_unit_test_setup_teardown(encoding_changes_behind_the_answer, open_host, close_host),
        cmocka_unit_test_setup_teardown(region_is_looked_at_alone, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
