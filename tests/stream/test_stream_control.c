/* The whole program: what it is told by signals, files and commands. */
#include "stream_test.h"

#include <netinet/in.h>
#include <sys/socket.h>

/* ---- Being told to end, and to read again -------------------------------------------------------------------- */

static void term_ends_within_a_frame(void **state)
{
    (void)state;
    /* The next one comes after 100 s. */
    start(ARGUMENTS("--camera", WALK "@0.01", "--serial", "LINE"));
    expect_record(TAPEMARK_RECORD_FRAME);
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    assert_string_equal(host.said, "");
}

static int64_t time_of_run(const char *const *arguments)
{
    const int64_t begin_ns = host_clock_ns();
    start(arguments);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    assert_string_equal(host.said, "");
    return host_clock_ns() - begin_ns;
}

/* With the last byte, and not after the time that this is given at most. A run that only begins and ends tells how
 * long that takes on a busy machine. */
static void recordings_end_at_once(void **state)
{
    (void)state;
    enum { PATIENCE_MS = 2000 };
    const int null_device = open("/dev/null", O_WRONLY | O_CLOEXEC);
    bool at_once = false;
    host.output = null_device;
    for (int tries = 0; tries < TRIES_MAX && !at_once; tries++) {
        const int64_t begin_ns = time_of_run(ARGUMENTS("--version"));
        const int64_t whole_ns = time_of_run(ARGUMENTS("--camera", WALK "@max", "--output", "file:/dev/null"));
        at_once = whole_ns - begin_ns < INT64_C(1000000) * PATIENCE_MS * 3 / 4;
    }
    close(null_device);
    assert_true(at_once);
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
    assert_true(host_says(&host, "line 1: encoding: expected nmea or cobs, not \"morse\"\n", SOON_MS));
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

static bool tells_broken_map(const tapemark_frame_record *head)
{
    return (head->flags & TAPEMARK_FRAME_MAP_BROKEN) != 0;
}

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
    expect_frame(tells_broken_map, "tells of the broken map");
    expect_record(TAPEMARK_RECORD_PLACE);
    assert_int_equal(host_count_said(&host, "\n"), 1);
    tapemark_record record = expect_record(TAPEMARK_RECORD_STATUS);
    assert_true(record.as.status.flags & TAPEMARK_STATUS_MAP_BROKEN);
    assert_true(record.as.status.flags & TAPEMARK_STATUS_MAP_LOADED);
    assert_true(record.as.status.errors > 0);
    unlink(path);
}

/* ---- Commands ------------------------------------------------------------------------------------------------ */

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
        {"SET", "exposure", "500", "ERR", "is a recording: its light cannot be set"},
        {"SET", "exposure", "auto", "OK", "auto"},
        {"SET", "exposure", "0", "ERR", "1 to 10000000 or auto"},
        {"SET", "gain", "auto", "OK", "auto"},
        {"GET", "rate", NULL, "OK", "100"},
        {"SET", "rate", "200", "ERR", "is a recording: its rate cannot be set"},
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

/* ---- What else is done with frames --------------------------------------------------------------------------- */

/* What was recorded tells the same when it is played again. */
static void recording_tells_the_same(void **state)
{
    (void)state;
    char folder[] = "/tmp/tapemark-stream-record-XXXXXX", path[100], camera_name[120], times[100];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/seen.y4m", folder);
    snprintf(times, sizeof times, "%s/seen.times", folder);
    snprintf(camera_name, sizeof camera_name, "file:%s@10", path);
    start(ARGUMENTS("--camera", WALK "@max", "--record", path, "--output", "file:/dev/null"));
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    assert_string_equal(host.said, "");
    assert_true(host_start(&host, STREAM_PROGRAM, ARGUMENTS("--camera", camera_name, "--serial", "LINE:921600")));
    walk_check check = {.walk = &walk};
    tapemark_record record;
    while (next_before_end(&record))
        walk_check_record(&check, &record);
    /* A busy machine may leave out some, the last one among them. */
    assert_int_equal(check.wrong + check.misplaced + check.unexplained, 0);
    assert_in_range(check.frames, WALK_FRAMES / 3, WALK_FRAMES);
    assert_true(check.cms >= 5 * check.frames / 2);
    unlink(path);
    unlink(times);
    rmdir(folder);
}

/* It ends with one message, and the rest goes on. */
static void recording_on_a_full_disk_ends(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--record", "/dev/full", "--serial", "LINE:921600"));
    assert_true(host_says(&host, "/dev/full: ", SOON_MS));
    host_forget(&host);
    for (int i = 0; i < 10; i++)
        expect_record(TAPEMARK_RECORD_FRAME);
    assert_int_equal(host_count_said(&host, "\n"), 1);
}

/* A picture from the preview's page, whose port is the one that the program tells. */
static void preview_shows_a_picture(void **state)
{
    (void)state;
    static const char request[] = "GET /frame.jpg HTTP/1.1\r\nHost: localhost\r\n\r\n", told[] = "http://127.0.0.1:";
    uint8_t answer[65536];
    size_t size = 0;
    start(ARGUMENTS("--camera", WALK "@10", "--repeat", "yes", "--serial", "LINE:921600", "--preview", "0"));
    assert_true(host_says(&host, told, SOON_MS));
    expect_record(TAPEMARK_RECORD_FRAME);
    const struct sockaddr_in address = {
        .sin_family = AF_INET,
        .sin_port = htons((uint16_t)atoi(strstr(host.said, told) + sizeof told - 1)),
        .sin_addr = {htonl(INADDR_LOOPBACK)}};
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    assert_int_equal(connect(connection, (const struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(write(connection, request, sizeof request - 1), sizeof request - 1);
    for (ssize_t count = 1; count > 0 && size < sizeof answer; size += (size_t)(count > 0 ? count : 0))
        count = read(connection, answer + size, sizeof answer - size);
    close(connection);
    assert_memory_equal(answer, "HTTP/1.", 7);
    assert_memory_equal(answer + 8, " 200 ", 5);
    const uint8_t *picture = memmem(answer, size, "\r\n\r\n", 4);
    assert_non_null(picture);
    assert_memory_equal(picture + 4, "\xff\xd8\xff", 3);
    assert_true(size > 5000);
    /* Frames go on meanwhile. */
    expect_record(TAPEMARK_RECORD_FRAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(term_ends_within_a_frame, open_host, close_host),
        cmocka_unit_test_setup_teardown(recordings_end_at_once, open_host, close_host),
        cmocka_unit_test_setup_teardown(broken_settings_leave_the_old_ones, open_host, close_host),
        cmocka_unit_test_setup_teardown(broken_map_leaves_the_old_one, open_host, close_host),
        cmocka_unit_test_setup_teardown(commands_are_answered, open_host, close_host),
        cmocka_unit_test_setup_teardown(encoding_changes_behind_the_answer, open_host, close_host),
        cmocka_unit_test_setup_teardown(region_is_looked_at_alone, open_host, close_host),
        cmocka_unit_test_setup_teardown(preview_shows_a_picture, open_host, close_host),
        cmocka_unit_test_setup_teardown(recording_tells_the_same, open_host, close_host),
        cmocka_unit_test_setup_teardown(recording_on_a_full_disk_ends, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
