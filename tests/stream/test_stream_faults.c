/* The whole program, treated badly: signals at any time, inputs that hang, files that break, floods of commands. */
#include "stream_test.h"

#include <sys/ioctl.h>
#include <time.h>

static void fill_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static size_t read_file(const char *path, char *bytes, size_t room)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, room, file);
    fclose(file);
    return size;
}

static void end_program(void)
{
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
}

/* ---- Signals ------------------------------------------------------------------------------------------------- */

static void expect_whole_recording(const char *path)
{
    char camera_name[120];
    stream_host player;
    snprintf(camera_name, sizeof camera_name, "file:%s@max", path);
    assert_true(host_open(&player));
    assert_true(host_start(&player, STREAM_PROGRAM, ARGUMENTS("--camera", camera_name, "--output",
                                                             "file:/dev/null")));
    if (host_wait(&player, SOON_MS) != 0)
        fail_msg("%s", player.said);
    assert_string_equal(player.said, "");
    host_close(&player);
}

/* Whatever it was doing: it ends well, its last record is whole, and its recording can be played. */
static void term_at_any_moment(void **state)
{
    (void)state;
    enum { TIMES = 5 };
    char folder[] = "/tmp/tapemark-stream-faults-XXXXXX", path[100], times[110];
    tapemark_record record;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/seen.y4m", folder);
    snprintf(times, sizeof times, "%s.times", path);
    for (int i = 0; i < TIMES; i++) {
        start(ARGUMENTS("--camera", WALK "@200", "--repeat", "yes", "--serial", "LINE:921600", "--encoding", "cobs",
                        "--record", path));
        /* The recording begins behind the first of them. */
        for (int frames = 0; frames < 3; frames++)
            expect_record(TAPEMARK_RECORD_FRAME);
        nanosleep(&(struct timespec){0, rand() % 40000000}, NULL);
        assert_int_equal(kill(host.program, SIGTERM), 0);
        assert_int_equal(host_wait(&host, SOON_MS), 0);
        assert_string_equal(host.said, "");
        while (host_record(&host, 50, &record))
            continue;
        assert_int_equal(host.receiver.damaged, 0);
        assert_int_equal(host.size > 0 ? host.bytes[host.size - 1] : 0, 0);
        expect_whole_recording(path);
        close_host(NULL);
        assert_int_equal(open_host(NULL), 0);
    }
    unlink(path);
    unlink(times);
    rmdir(folder);
}

static void storm_of_hangups(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-storm-XXXXXX";
    static const char text[] = "camera = " WALK "@30\nrepeat = yes\nmap = " STREAM_DATA "/map.json\n";
    assert_int_not_equal(close(mkstemp(path)), -1);
    fill_file(path, text, sizeof text - 1);
    start(ARGUMENTS("--config", path, "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);
    for (int i = 0; i < 300; i++) {
        assert_int_equal(kill(host.program, SIGHUP), 0);
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    }
    host_forget(&host);
    for (int i = 0; i < 10; i++)
        expect_record(TAPEMARK_RECORD_FRAME);
    end_program();
    unlink(path);
}

/* Pictures that OpenCV decodes, all the time: it is kept from talking, and the program is not. */
static void each_reload_is_told_of(void **state)
{
    (void)state;
    enum { TIMES = 40, PICTURES = 40 };
    char folder[] = "/tmp/tapemark-stream-stills-XXXXXX", picture[100], config[100], camera[110];
    assert_non_null(mkdtemp(folder));
    snprintf(config, sizeof config, "%s/stream.conf", folder);
    snprintf(camera, sizeof camera, "file:%s@max", folder);
    for (int i = 0; i < PICTURES; i++) {
        snprintf(picture, sizeof picture, "%s/%02d.png", folder, i);
        assert_int_equal(symlink(STREAM_DATA "/simulated-room.png", picture), 0);
    }
    fill_file(config, "repeat = yes\n", 13);
    start(ARGUMENTS("--config", config, "--camera", camera, "--serial", "LINE:921600"));
    for (unsigned i = 0; i < TIMES; i++) {
        expect_record(TAPEMARK_RECORD_FRAME);
        host_sleep_ms(rand() % 9);
        assert_int_equal(kill(host.program, SIGHUP), 0);
        const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
        while (host_count_said(&host, "were read again\n") < i + 1 && host_clock_ns() < deadline_ns)
            expect_record(TAPEMARK_RECORD_FRAME);
        assert_int_equal(host_count_said(&host, "were read again\n"), i + 1);
    }
    end_program();
    for (int i = 0; i < PICTURES; i++) {
        snprintf(picture, sizeof picture, "%s/%02d.png", folder, i);
        unlink(picture);
    }
    unlink(config);
    rmdir(folder);
}

/* An answer shows that the loop came round since. */
static void reload_and_wait(uint16_t number)
{
    assert_int_equal(kill(host.program, SIGHUP), 0);
    host_command(&host, number, "VERSION", NULL, NULL);
    expect_record(TAPEMARK_RECORD_ANSWER);
}

static int unread_bytes(void)
{
    int bytes = 0;
    assert_int_equal(ioctl(host.said_pipe, FIONREAD, &bytes), 0);
    return bytes;
}

/* Whoever started it does not read what it says, or no more: it goes on. */
static void messages_that_nobody_reads(void **state)
{
    (void)state;
    enum { ROOM_BYTES = 4096, LINE_BYTES = 100, TIMES_MAX = 1000, MORE = 5 };
    char config[] = "/tmp/tapemark-stream-unread-XXXXXX";
    uint16_t times = 0;
    assert_int_not_equal(close(mkstemp(config)), -1);
    fill_file(config, "repeat = yes\n", 13);
    start(ARGUMENTS("--config", config, "--camera", WALK "@50", "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);
    assert_int_equal(fcntl(host.said_pipe, F_SETPIPE_SZ, ROOM_BYTES), ROOM_BYTES);
    while (unread_bytes() < ROOM_BYTES - LINE_BYTES && times < TIMES_MAX)
        reload_and_wait(times++);
    assert_true(times < TIMES_MAX);
    for (unsigned i = 0; i < MORE; i++)
        reload_and_wait(times++);
    for (unsigned i = 0; i < 10; i++)
        expect_record(TAPEMARK_RECORD_FRAME);
    assert_true(host_says(&host, "were read again\n", SOON_MS));
    assert_true(host_count_said(&host, "\n") < times);
    assert_int_equal(kill(host.program, SIGHUP), 0);
    assert_true(host_says(&host, " messages were left out here: nobody read them\n", SOON_MS));
    end_program();
    unlink(config);
}

/* ---- Inputs that hang ---------------------------------------------------------------------------------------- */

static bool tells_lost_camera(const tapemark_frame_record *head)
{
    return (head->flags & TAPEMARK_FRAME_CAMERA_LOST) != 0;
}

static bool tells_picture(const tapemark_frame_record *head)
{
    return head->width_px == 480;
}

/* A pipe into which somebody writes a few frames, and then no more: it is the program that must not hang. */
static void pipe_that_falls_silent(void **state)
{
    (void)state;
    enum { FRAME_BYTES = 480 * 270 * 3 / 2 };
    static char bytes[4 * FRAME_BYTES];
    char path[] = "/tmp/tapemark-stream-pipe-XXXXXX", camera_name[64];
    const size_t size = read_file(STREAM_DATA "/walk.y4m", bytes, sizeof bytes);
    assert_int_not_equal(close(mkstemp(path)), -1);
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    snprintf(camera_name, sizeof camera_name, "file:%s@50", path);
    start(ARGUMENTS("--camera", camera_name, "--serial", "LINE:921600"));
    expect_frame(tells_lost_camera, "while nobody has opened the pipe");
    const int end = open(path, O_RDWR | O_CLOEXEC);
    assert_int_not_equal(end, -1);
    assert_int_equal(write(end, bytes, size), size);
    expect_frame(tells_picture, "from the pipe");
    expect_frame(tells_lost_camera, "once nothing comes any more");
    host_command(&host, 1, "SET", "exposure", "500");
    tapemark_record answer = expect_record(TAPEMARK_RECORD_ANSWER);
    assert_string_equal(answer.as.answer.text, "does not answer");
    end_program();
    close(end);
    unlink(path);
}

static void pipe_that_nobody_writes_to(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-pipe-XXXXXX", camera_name[64];
    assert_int_not_equal(close(mkstemp(path)), -1);
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    snprintf(camera_name, sizeof camera_name, "file:%s", path);
    start(ARGUMENTS("--camera", camera_name, "--serial", "LINE:921600"));
    expect_frame(tells_lost_camera, "while nobody has opened the pipe");
    end_program();
    unlink(path);
}

/* ---- Doing nothing ------------------------------------------------------------------------------------------- */

static double processor_seconds(void)
{
    char path[64], text[1024];
    unsigned long user = 0, kernel = 0;
    snprintf(path, sizeof path, "/proc/%d/stat", (int)host.program);
    text[read_file(path, text, sizeof text - 1)] = '\0';
    const char *rest = strrchr(text, ')');
    assert_non_null(rest);
    assert_int_equal(sscanf(rest, ") %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu", &user, &kernel), 2);
    return (double)(user + kernel) / (double)sysconf(_SC_CLK_TCK);
}

/* Neither camera nor port: both are looked for, and that is all. */
static void waiting_costs_next_to_nothing(void **state)
{
    (void)state;
    enum { WATCHED_MS = 2000 };
    double least_s = 1;
    start(ARGUMENTS("--camera", "v4l2:/dev/tapemark-is-not-there", "--serial", "/dev/tapemark-is-not-there"));
    assert_true(host_says(&host, "camera v4l2:", SOON_MS));
    /* The first time, it may still be about to begin. */
    for (int tries = 0; tries < TRIES_MAX && least_s > 0.02; tries++) {
        const double before_s = processor_seconds();
        host_sleep_ms(WATCHED_MS);
        const double taken_s = processor_seconds() - before_s;
        least_s = taken_s < least_s ? taken_s : least_s;
    }
    assert_true(least_s <= 0.02);
    end_program();
}

/* ---- Files that break ---------------------------------------------------------------------------------------- */

static bool tells_broken_map(const tapemark_frame_record *head)
{
    return (head->flags & TAPEMARK_FRAME_MAP_BROKEN) != 0;
}

/* As it is read while an editor is still writing it. */
static void half_a_map_leaves_the_old_one(void **state)
{
    (void)state;
    enum { CUTS = 6 };
    static char map[1 << 20];
    char path[] = "/tmp/tapemark-stream-half-XXXXXX";
    const size_t size = read_file(STREAM_DATA "/map.json", map, sizeof map);
    assert_int_not_equal(close(mkstemp(path)), -1);
    fill_file(path, map, size);
    start(ARGUMENTS("--camera", "raw:YUYV:320x180," STREAM_DATA "/room-walk-yuyv-320x180.raw@30", "--repeat", "yes",
                    "--map", path, "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_PLACE);
    for (unsigned i = 0; i < CUTS; i++) {
        fill_file(path, map, size * i / CUTS);
        assert_int_equal(kill(host.program, SIGHUP), 0);
        const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
        while (host_count_said(&host, "\n") < i + 1 && host_clock_ns() < deadline_ns)
            expect_record(TAPEMARK_RECORD_FRAME);
        assert_int_equal(host_count_said(&host, "\n"), i + 1);
        assert_int_equal(host_count_said(&host, path), i + 1);
        host_forget(&host);
        expect_frame(tells_broken_map, "tells of the broken map");
        expect_record(TAPEMARK_RECORD_PLACE);
    }
    fill_file(path, map, size);
    assert_int_equal(kill(host.program, SIGHUP), 0);
    assert_true(host_says(&host, "settings and map were read again\n", SOON_MS));
    unlink(path);
}

static bool tells_small_picture(const tapemark_frame_record *head)
{
    return head->width_px == 320;
}

static void settings_of_everything_change_while_it_runs(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-all-XXXXXX", text[600];
    stream_host second;
    assert_true(host_open(&second));
    assert_int_not_equal(close(mkstemp(path)), -1);
    int length = snprintf(text, sizeof text, "camera = " WALK "@30\nrepeat = yes\nserial = %s:921600\n",
                          host.device_path);
    fill_file(path, text, (size_t)length);
    start(ARGUMENTS("--config", path));
    expect_frame(tells_picture, "of the first recording");
    length = snprintf(text, sizeof text,
                      "camera = raw:YUYV:320x180," STREAM_DATA "/room-walk-yuyv-320x180.raw@30\nrepeat = yes\n"
                      "encoding = cobs\nmarkers = 1\nserial = %s:115200\nmap = " STREAM_DATA "/map.json\n",
                      second.device_path);
    fill_file(path, text, (size_t)length);
    assert_int_equal(kill(host.program, SIGHUP), 0);
    const int first_line = host.line;
    host.line = second.line;
    expect_frame(tells_small_picture, "of the second recording");
    expect_record(TAPEMARK_RECORD_PLACE);
    host.line = first_line;
    end_program();
    host_close(&second);
    unlink(path);
}

/* A recording in place of a recording that is not there is as wrong as at the beginning. */
static void absent_recording_ends_it(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", "file:/tapemark-is-not-there.y4m", "--serial", "LINE:921600"));
    assert_int_equal(host_wait(&host, SOON_MS), 1);
    assert_int_equal(host_count_said(&host, "\n"), 1);
    assert_true(host_says(&host, "/tapemark-is-not-there.y4m: cannot be opened: No such file or directory\n", 0));
}

/* All at once: each waits for the last bytes to leave. */
static void outputs_that_take_nothing(void **state)
{
    (void)state;
    enum { OUTPUTS = 5 };
    static const char *const outputs[OUTPUTS] = {"file:/dev/full", "serial:/tmp", "serial:/dev/null", "file:/tmp",
                                                 "pty:/proc/tapemark"};
    static stream_host hosts[OUTPUTS];
    for (size_t i = 0; i < OUTPUTS; i++) {
        assert_true(host_open(&hosts[i]));
        assert_true(host_start(&hosts[i], STREAM_PROGRAM, ARGUMENTS("--camera", WALK "@100", "--output",
                                                                   outputs[i])));
    }
    for (size_t i = 0; i < OUTPUTS; i++) {
        assert_int_equal(host_wait(&hosts[i], SOON_MS), 1);
        if (host_count_said(&hosts[i], "\n") != 1 || !host_says(&hosts[i], outputs[i], 0))
            fail_msg("%s: %s", outputs[i], hosts[i].said);
        host_close(&hosts[i]);
    }
}

/* ---- Commands ------------------------------------------------------------------------------------------------ */

static void commands_without_sense_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name, *value;
    } wrong[] = {
        {"exposure", "-1"}, {"exposure", "10000001"}, {"exposure", "99999999999999999999"}, {"exposure", "nan"},
        {"exposure", "1e3"}, {"exposure", ""}, {"exposure", " 5"}, {"exposure", "5 "}, {"gain", "0"},
        {"gain", "65536"}, {"gain", "-5"}, {"gain", "inf"}, {"gain", "0x10"}, {"rate", "0"}, {"rate", "65536"},
        {"rate", "nan"}, {"rate", "-30"}, {"encoding", ""}, {"encoding", "COBS"}, {"encoding", "cobsnmea"},
        {"roi", "0x0+0+0"}, {"roi", "-1x10+0+0"}, {"roi", "10x10"}, {"roi", "10x10+480+0"}, {"roi", "10x10+0+270"},
        {"roi", "70000x10+0+0"}, {"roi", "10x10+0+0+0"}, {"roi", "99999999999999999999x1+0+0"}, {"", "1"},
        {"exposures", "1"}, {"map", "/etc/passwd"}, {"record", "x"}, {"output", "-"}, {"camera", "auto"},
        {"EXPOSURE", "auto"},
    };
    start(ARGUMENTS("--camera", WALK "@30", "--repeat", "yes", "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_CM);
    for (uint16_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        host_command(&host, i, "SET", wrong[i].name, wrong[i].value);
        tapemark_record record = expect_record(TAPEMARK_RECORD_ANSWER);
        if (record.as.answer.number != i || strcmp(record.as.answer.result, "ERR") != 0)
            fail_msg("SET %s %s: %s %s", wrong[i].name, wrong[i].value, record.as.answer.result,
                     record.as.answer.text);
        assert_true(record.as.answer.text[0] != '\0');
    }
    host_forget(&host);
    expect_record(TAPEMARK_RECORD_CM);
    expect_silence();
}

/* Ten thousand a second and more: all that the line can carry. */
static void flood_of_commands(void **state)
{
    (void)state;
    enum { RATE_HZ = 20, FRAMES = 30, ANSWERS = 50 };
    static char flood[4096];
    size_t size = 0;
    unsigned frames = 0, answers = 0, too_old = 0;
    uint64_t commands = 0;
    tapemark_record record;
    for (uint16_t i = 0; size < sizeof flood - TAPEMARK_SENTENCE_MAX_BYTES; i++)
        size += tapemark_command_write(flood + size, sizeof flood - size, i, i % 2 ? "GET" : "SET", "exposure",
                                       i % 2 ? NULL : "auto");
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--serial", "LINE:921600"));
    expect_record(TAPEMARK_RECORD_FRAME);
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
    while ((frames < FRAMES || answers < ANSWERS) && host_clock_ns() < deadline_ns) {
        const ssize_t count = write(host.line, flood, size);
        commands += count > 0 ? (uint64_t)count / 30 : 0;
        while (host_record(&host, 1, &record)) {
            answers += record.type == TAPEMARK_RECORD_ANSWER;
            frames += record.type == TAPEMARK_RECORD_FRAME;
            too_old += record.type == TAPEMARK_RECORD_FRAME && is_too_old(&record.as.frame, RATE_HZ);
        }
    }
    print_message("%u frames and %u answers while %llu commands were taken\n", frames, answers,
                  (unsigned long long)commands);
    assert_true(frames >= FRAMES && answers >= ANSWERS);
    assert_int_equal(too_old, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(term_at_any_moment, open_host, close_host),
        cmocka_unit_test_setup_teardown(storm_of_hangups, open_host, close_host),
        cmocka_unit_test_setup_teardown(each_reload_is_told_of, open_host, close_host),
        cmocka_unit_test_setup_teardown(messages_that_nobody_reads, open_host, close_host),
        cmocka_unit_test_setup_teardown(pipe_that_falls_silent, open_host, close_host),
        cmocka_unit_test_setup_teardown(pipe_that_nobody_writes_to, open_host, close_host),
        cmocka_unit_test_setup_teardown(waiting_costs_next_to_nothing, open_host, close_host),
        cmocka_unit_test_setup_teardown(half_a_map_leaves_the_old_one, open_host, close_host),
        cmocka_unit_test_setup_teardown(settings_of_everything_change_while_it_runs, open_host, close_host),
        cmocka_unit_test_setup_teardown(absent_recording_ends_it, open_host, close_host),
        cmocka_unit_test_setup_teardown(outputs_that_take_nothing, open_host, close_host),
        cmocka_unit_test_setup_teardown(commands_without_sense_are_refused, open_host, close_host),
        cmocka_unit_test_setup_teardown(flood_of_commands, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
