/* The whole program: frames of a recording in, through a terminal that is slow, stalled or gone at times, to the
 * microcontroller's receiver. */
#include "stream_test.h"

/* ---- Every record is right ----------------------------------------------------------------------------------- */

static walk_check watch_walk(const char *encoding)
{
    walk_check check = {.walk = &walk};
    tapemark_record record;
    start(ARGUMENTS("--camera", WALK, "--serial", "LINE:921600", "--encoding", encoding));
    while (next_before_end(&record))
        walk_check_record(&check, &record);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    return check;
}

static void assert_walk_is_right(const walk_check *check)
{
    if (check->wrong > 0)
        fail_msg("%d wrong records; the first: %s", (int)check->wrong, check->complaint);
    assert_int_equal(check->misplaced, 0);
    assert_int_equal(check->incomplete, 0);
    assert_int_equal(check->unexplained + check->spoiled, 0);
    assert_int_equal(host.receiver.damaged, 0);
    assert_int_equal(host.receiver.unknown, 0);
    assert_string_equal(host.said, "");
}

/* Right it is each time; and whole, unless the machine is too busy for some of the frames. */
static void expect_whole_walk(const char *encoding)
{
    walk_check check;
    bool whole = false;
    for (int tries = 0; tries < TRIES_MAX && !whole; tries++) {
        check = watch_walk(encoding);
        assert_walk_is_right(&check);
        whole = check.frames == WALK_FRAMES && check.dropped == 0;
        close_host(NULL);
        assert_int_equal(open_host(NULL), 0);
    }
    assert_true(whole);
    assert_int_equal(check.position, WALK_FRAMES);
    assert_true(check.cms >= 90);
    assert_true(check.tms >= 8);
}

static void sentences_are_right(void **state)
{
    (void)state;
    expect_whole_walk("nmea");
}

static void packets_are_right(void **state)
{
    (void)state;
    expect_whole_walk("cobs");
}

/* ---- Too slow, too late, gone -------------------------------------------------------------------------------- */

/* 9600 baud carry a frame in 0.4 s; frames come every 0.1 s. */
static void slow_line_gets_new_frames(void **state)
{
    (void)state;
    enum { FRAMES = 6, RATE_HZ = 10 };
    const unsigned frame_time_10us = 100000 / RATE_HZ;
    unsigned dropped = 0, oldest_10us = 0, late = 0;
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "LINE:9600", "--encoding", "nmea"));
    for (int frames = 0; frames < FRAMES; frames++) {
        tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        assert_true(record.as.frame.flags & TAPEMARK_FRAME_TIMED);
        assert_false(is_too_old(&record.as.frame, RATE_HZ));
        late += record.as.frame.age_10us > 2 * frame_time_10us;
        oldest_10us = record.as.frame.age_10us > oldest_10us ? record.as.frame.age_10us : oldest_10us;
        dropped += record.as.frame.dropped;
    }
    assert_true(dropped >= FRAMES);
    /* On a busy machine, a frame of the camera may be one of its own. */
    assert_true(late <= FRAMES / 2);
    /* Some of them have waited for the line. */
    assert_true(oldest_10us > frame_time_10us / 10);
    tapemark_record status = expect_record(TAPEMARK_RECORD_STATUS);
    assert_true(status.as.status.records_dropped > 0);
    assert_true(status.as.status.frames_dropped >= dropped / 2);
}

/* How long nobody takes the bytes once that was noticed; TAPEMARK_STALL_S in the environment makes it a minute, or
 * whatever. */
static int stall_ms(void)
{
    const char *seconds = getenv("TAPEMARK_STALL_S");
    return seconds != NULL ? 1000 * atoi(seconds) : 1500;
}

/* What was sent before comes first; then a frame tells of those that were left out, and is none of them. */
static void expect_stall_told(unsigned rate_hz)
{
    enum { LEFT_OUT = 20 };
    bool frame = false, status = false, too_old = false;
    tapemark_record record;
    for (int i = 0; i < 2000 && !(frame && status); i++) {
        assert_true(host_record(&host, SOON_MS, &record));
        if (record.type == TAPEMARK_RECORD_FRAME) {
            too_old = is_too_old(&record.as.frame, rate_hz) || too_old;
            frame = frame || record.as.frame.dropped >= LEFT_OUT;
        }
        if (record.type == TAPEMARK_RECORD_STATUS)
            status = status || ((record.as.status.flags & TAPEMARK_STATUS_PORT_STALLED) != 0 &&
                                record.as.status.records_dropped > LEFT_OUT);
    }
    assert_true(frame && status);
    assert_false(too_old);
}

/* Nobody takes the bytes for a while: then come new frames, not those of then. */
static void stalled_line_comes_back(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--serial", "LINE:921600", "--encoding", "cobs"));
    expect_record(TAPEMARK_RECORD_FRAME);
    /* As a wire whose other end holds it up: nothing leaves, however long. */
    assert_int_equal(tcflow(host.device, TCOOFF), 0);
    assert_true(host_says(&host, "takes no bytes", SOON_MS));
    host_sleep_ms(stall_ms());
    assert_int_equal(tcflow(host.device, TCOON), 0);
    expect_stall_told(20);
    assert_true(host_says(&host, "is back", SOON_MS));
    const tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
    assert_false(is_too_old(&record.as.frame, 20));
    assert_int_equal(host_count_said(&host, "\n"), 2);
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
    unlink(link_path);
    host_unplug(&host);
    assert_true(host_says(&host, link_path, SOON_MS));
    stream_host second;
    assert_true(host_open(&second));
    assert_int_equal(symlink(second.device_path, link_path), 0);
    host.line = second.line;
    host.device = second.device;
    for (int i = 0; i < 3; i++) {
        const tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        assert_false(is_too_old(&record.as.frame, 10));
    }
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

/* There is no camera: the line does not fall silent, and nothing on it looks like a picture. */
static void absent_camera_is_told_twice_a_second(void **state)
{
    (void)state;
    enum { FRAMES = 4 };
    uint16_t last_seq = 0;
    int in_time = 0;
    start(ARGUMENTS("--camera", "v4l2:/dev/tapemark-is-not-there", "--serial", "LINE"));
    expect_record(TAPEMARK_RECORD_FRAME);
    int64_t last_ns = host.record_ns;
    for (int i = 0; i < FRAMES * TRIES_MAX && in_time < FRAMES; i++) {
        const tapemark_record record = expect_record(TAPEMARK_RECORD_FRAME);
        assert_true(record.as.frame.flags & TAPEMARK_FRAME_CAMERA_LOST);
        assert_false(record.as.frame.flags & (TAPEMARK_FRAME_TIMED | TAPEMARK_FRAME_NOTHING_SEEN));
        assert_int_equal(record.as.frame.width_px, 0);
        assert_int_equal(record.as.frame.records, 0);
        assert_true(i == 0 || record.as.frame.seq == last_seq + 1);
        last_seq = record.as.frame.seq;
        in_time += host.record_ns - last_ns <= 500000000;
        last_ns = host.record_ns;
    }
    assert_int_equal(in_time, FRAMES);
    const tapemark_record last = expect_record(TAPEMARK_RECORD_STATUS);
    assert_true(last.as.status.flags & TAPEMARK_STATUS_CAMERA_LOST);
    assert_int_equal(host_count_said(&host, "\n"), 1);
    assert_true(host_says(&host, "camera v4l2:/dev/tapemark-is-not-there: ", 0));
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
        cmocka_unit_test_setup_teardown(absent_camera_is_told_twice_a_second, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
