/* Recordings and pictures played as cameras: their pace, what is passed over, their end, what is wrong with them. */
#include "../app/test_main.h"

#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <sys/stat.h>
#include <time.h>

#include "camera.h"

enum { WIDTH = 4, HEIGHT = 2, PIXELS = WIDTH * HEIGHT };

typedef struct player {
    camera *device;
    camera_frame got;
    error_text error;
    int64_t start_ns;
} player;

static char folder[200];

static const char *in_folder(const char *name)
{
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Frames of which all pixels are the frame's number. */
static void write_y4m(const char *name, int rate_hz, int frame_count)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    fprintf(file, "YUV4MPEG2 W%d H%d F%d:1 Ip Cmono\n", WIDTH, HEIGHT, rate_hz);
    for (int i = 0; i < frame_count; i++) {
        fputs("FRAME\n", file);
        for (int k = 0; k < PIXELS; k++)
            fputc(i, file);
    }
    assert_int_equal(fclose(file), 0);
}

static void write_raw(const char *name, int frame_count)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    for (int i = 0; i < frame_count * PIXELS; i++)
        fputc(i / PIXELS, file);
    assert_int_equal(fclose(file), 0);
}

static camera *open_in_folder(const char *kind, const char *name, error_text *error)
{
    char text[400];
    snprintf(text, sizeof text, "%s%s/%s", kind, folder, name);
    error->text[0] = '\0';
    return camera_open(text, error);
}

static player play(const char *kind, const char *name)
{
    player p = {0};
    p.device = open_in_folder(kind, name, &p.error);
    if (p.device == NULL || !camera_configure(p.device, &(camera_wishes){0}, &p.error))
        fail_msg("%s", p.error.text);
    p.start_ns = camera_clock_ns();
    return p;
}

static camera_status next(player *p)
{
    return camera_next(p->device, 2000, &p->got, &p->error);
}

static void sleep_ms(long ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

static int make_folder(void **state)
{
    const char *where = getenv("TMPDIR");
    (void)state;
    snprintf(folder, sizeof folder, "%s/tapemark-test-XXXXXX", where != NULL ? where : "/tmp");
    return mkdtemp(folder) != NULL ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* Plays to the end, on a machine that may be too busy to take all frames: those that come are right, and come when
 * they are due. Returns how many there were, those passed over among them. */
static unsigned play_to_the_end(player *p, int64_t period_ns, const uint8_t *values)
{
    camera_status status;
    uint64_t wanted = 0;
    int64_t first_ns = 0;
    while ((status = next(p)) == CAMERA_FRAME) {
        uint64_t number = p->got.image.sequence;
        assert_int_equal(number, wanted + p->got.dropped);
        assert_int_equal(p->got.image.data[0], values != NULL ? values[number] : number);
        assert_true(camera_clock_ns() >= p->got.image.time_ns);
        first_ns = wanted == 0 ? p->got.image.time_ns - (int64_t)number * period_ns : first_ns;
        assert_int_equal(p->got.image.time_ns - first_ns, (int64_t)number * period_ns);
        wanted = number + 1;
    }
    assert_int_equal(status, CAMERA_END);
    assert_int_equal(next(p), CAMERA_END);
    return (unsigned)wanted;
}

static void frames_come_at_their_pace(void **state)
{
    (void)state;
    write_y4m("a.y4m", 50, 6);
    player p = play("file:", "a.y4m");
    assert_int_equal(camera_settings_of(p.device)->mode.width_px, WIDTH);
    assert_true(camera_settings_of(p.device)->mode.rate_hz == 0);
    assert_int_equal(play_to_the_end(&p, 20000000, NULL), 6);
    assert_true(camera_clock_ns() - p.start_ns >= INT64_C(95000000));
    assert_true(fabs(camera_settings_of(p.device)->mode.rate_hz - 50) < 0.01);
    camera_close(p.device);
}

static void a_rate_takes_the_place_of_the_recorded_one(void **state)
{
    (void)state;
    write_y4m("a.y4m", 1, 4);
    player p = play("file:", "a.y4m@100");
    assert_true(camera_settings_of(p.device)->mode.rate_hz == 100);
    assert_int_equal(play_to_the_end(&p, 10000000, NULL), 4);
    assert_in_range(camera_clock_ns() - p.start_ns, 29000000, INT64_C(30000000000));
    camera_close(p.device);
}

static void flat_out_nothing_is_waited_for_or_left_out(void **state)
{
    (void)state;
    write_y4m("a.y4m", 1, 200);
    player p = play("file:", "a.y4m@max");
    for (int i = 0; i < 200; i++) {
        if (i == 100)
            sleep_ms(50);
        assert_int_equal(camera_next(p.device, 0, &p.got, &p.error), CAMERA_FRAME);
        assert_int_equal(p.got.image.sequence, i);
    }
    assert_int_equal(camera_counts_of(p.device).dropped, 0);
    assert_int_equal(next(&p), CAMERA_END);
    camera_close(p.device);
}

static void who_is_slow_gets_the_newest_frame(void **state)
{
    (void)state;
    const int64_t period_ns = 4000000;
    write_y4m("a.y4m", 250, 250);
    player p = play("file:", "a.y4m");
    assert_int_equal(next(&p), CAMERA_FRAME);
    uint64_t first = p.got.image.sequence;
    sleep_ms(105);
    int64_t asked_ns = camera_clock_ns();
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_true(p.got.image.sequence >= 25);
    assert_int_equal(p.got.image.data[0], p.got.image.sequence);
    assert_int_equal(p.got.dropped, p.got.image.sequence - first - 1);
    assert_true(asked_ns - p.got.image.time_ns < 2 * period_ns);
    assert_int_equal(camera_counts_of(p.device).dropped, first + p.got.dropped);
    camera_close(p.device);
}

/* A frame that nothing has followed yet is the newest, however old; and so is the last one. */
static void the_newest_frame_stays_until_the_next_one(void **state)
{
    (void)state;
    write_raw("a.raw", 4);
    write_text("a.raw.times", "# tapemark times 1 GREY:4x2:4\n0 0 0\n1 10000000 0\n2 20000000 0\n3 1000000000 0\n");
    player p = play("file:", "a.raw");
    sleep_ms(100);
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(p.got.image.sequence, 2);
    assert_int_equal(p.got.image.data[0], 2);
    assert_int_equal(camera_next(p.device, 0, &p.got, &p.error), CAMERA_TIMEOUT);
    sleep_ms(1000);
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(p.got.image.data[0], 3);
    assert_int_equal(p.got.dropped, 0);
    assert_int_equal(next(&p), CAMERA_END);
    camera_close(p.device);
}

static void a_frame_that_is_not_due_times_out(void **state)
{
    (void)state;
    write_y4m("a.y4m", 1, 2);
    player p = play("file:", "a.y4m");
    assert_int_equal(next(&p), CAMERA_FRAME);
    int64_t start_ns = camera_clock_ns();
    assert_int_equal(camera_next(p.device, 30, &p.got, &p.error), CAMERA_TIMEOUT);
    assert_in_range(camera_clock_ns() - start_ns, 29000000, 900000000);
    assert_int_equal(camera_next(p.device, 0, &p.got, &p.error), CAMERA_TIMEOUT);
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(p.got.image.sequence, 1);
    camera_close(p.device);
}

static void poll_tells_when_a_frame_is_due(void **state)
{
    (void)state;
    write_y4m("a.y4m", 4, 3);
    player p = play("file:", "a.y4m");
    for (int i = 0; i < 3; i++) {
        struct pollfd due = {.fd = camera_descriptor(p.device), .events = POLLIN};
        assert_int_equal(poll(&due, 1, 1000), 1);
        assert_int_equal(camera_next(p.device, 0, &p.got, &p.error), CAMERA_FRAME);
        camera_release(p.device);
        assert_int_equal(poll(&due, 1, 0), i == 2);
    }
    /* The end is told of as well. */
    assert_int_equal(camera_next(p.device, 0, &p.got, &p.error), CAMERA_END);
    camera_close(p.device);
}

static void recorded_times_set_the_pace_and_the_numbers(void **state)
{
    (void)state;
    write_raw("a.raw", 4);
    write_text("a.raw.times", "# tapemark times 1 GREY:4x2:4\n7 1000000000 500\n8 1300000000 600\n12 1900000000 0\n");
    player p = play("file:", "a.raw");
    assert_int_equal(next(&p), CAMERA_FRAME);
    int64_t first_ns = p.got.image.time_ns;
    assert_int_equal(p.got.exposure_us, 500);
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(p.got.image.time_ns - first_ns, 300000000);
    assert_int_equal(p.got.exposure_us, 600);
    assert_int_equal(p.got.dropped, 0);
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(p.got.image.time_ns - first_ns, 900000000);
    assert_int_equal(p.got.dropped, 3);
    assert_int_equal(p.got.image.data[0], 2);
    /* The fourth frame was not whole when the recording ended. */
    assert_int_equal(next(&p), CAMERA_END);
    camera_close(p.device);
}

static void times_that_jump_do_not_stop_it(void **state)
{
    (void)state;
    write_raw("a.raw", 4);
    write_text("a.raw.times", "# tapemark times 1 GREY:4x2:4\n0 4000000000000000000 0\n1 5 0\n"
                              "2 4000000000000000001 0\n3 4611686018427387903 0\n");
    player p = play("file:", "a.raw");
    camera_status status;
    do
        status = camera_next(p.device, 100, &p.got, &p.error);
    while (status == CAMERA_FRAME && p.got.image.sequence < 2);
    assert_int_equal(status, CAMERA_FRAME);
    assert_int_equal(camera_next(p.device, 1, &p.got, &p.error), CAMERA_TIMEOUT);
    camera_close(p.device);
}

static void a_cut_line_of_times_is_the_end(void **state)
{
    (void)state;
    write_raw("a.raw", 2);
    write_text("a.raw.times", "# tapemark times 1 GREY:4x2:4\n0 1000 0\n1 20");
    player p = play("file:", "a.raw");
    assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(next(&p), CAMERA_END);
    camera_close(p.device);
}

static void expect_refusal(const char *kind, const char *name, const char *text)
{
    error_text error;
    camera_frame got;
    camera_status status = CAMERA_FRAME;
    camera *device = open_in_folder(kind, name, &error);
    if (device != NULL && camera_configure(device, &(camera_wishes){0}, &error)) {
        while (status == CAMERA_FRAME)
            status = camera_next(device, 100, &got, &error);
        assert_int_equal(status, CAMERA_FAILED);
    }
    if (strstr(error.text, text) == NULL || strchr(error.text, '\n') != NULL)
        fail_msg("'%s' instead of '%s'", error.text, text);
    camera_close(device);
}

static void what_is_wrong_is_told(void **state)
{
    static const struct {
        const char *times;
        const char *text;
    } cases[] = {
        {"", ".times does not begin with"},
        {"# tapemark times 2 GREY:4x2:4\n", ".times does not begin with"},
        {"# tapemark times 1 GREY:0x2\n", "the layout in its .times file"},
        {"# tapemark times 1 GREY:4x2:4\nx\n", "line 2 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 0 0\n0 1 0\n", "line 3 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 -5 0\n", "line 2 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 99999999999999999999999999 0\n", "line 2 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 0 99999999999\n", "line 2 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 0 0 0\n", "line 2 of its .times file"},
        {"# tapemark times 1 GREY:4x2:4\n0 0 0\n1 0 0\n2 0 0\n", "is cut short"},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        FILE *file = fopen(in_folder("b.raw"), "wb");
        fwrite("0123456789", 1, 10, file);
        fclose(file);
        write_text("b.raw.times", cases[i].times);
        expect_refusal("file:", "b.raw@max", cases[i].text);
    }
    expect_refusal("file:", "missing.y4m", "No such file");
    expect_refusal("file:", "missing.y4m@30", "No such file");
    expect_refusal("file:", "missing.y4m@fast", "no rate");
    expect_refusal("file:", "missing.y4m@0", "no rate");
    expect_refusal("file:", "missing.y4m@nan", "no rate");
    expect_refusal("file:", "missing.y4m@1e99", "no rate");
    write_text("empty", "");
    expect_refusal("file:", "empty", "is empty");
    expect_refusal("raw:", "GREY", "expected raw:LAYOUT,PATH");
    expect_refusal("raw:GREY:4xx2,", "b.raw", "expected FORMAT:WIDTHxHEIGHT");
    mkdir(in_folder("nothing"), 0700);
    expect_refusal("file:", "nothing", "");
}

static void headless_frames_are_played(void **state)
{
    (void)state;
    write_raw("c@2.bin", 3);
    player p = play("raw:GREY:4x2,", "c@2.bin@max");
    for (int i = 0; i < 3; i++) {
        assert_int_equal(next(&p), CAMERA_FRAME);
        assert_int_equal(p.got.image.data[PIXELS - 1], i);
    }
    assert_int_equal(next(&p), CAMERA_END);
    camera_close(p.device);
    /* A rate is only what follows the name of something that is there. */
    p = play("raw:GREY:4x2,", "c@2.bin");
    assert_int_equal(next(&p), CAMERA_FRAME);
    camera_close(p.device);
}

static void a_directory_is_played_in_order(void **state)
{
    (void)state;
    mkdir(in_folder("d"), 0700);
    write_y4m("d/1.y4m", 100, 3);
    write_y4m("d/2.y4m", 100, 2);
    write_text("d/3.pgm", "P2 4 2 255 9 9 9 9 9 9 9 9\n");
    player p = play("file:", "d");
    static const uint8_t values[] = {0, 1, 2, 0, 1, 9};
    assert_int_equal(play_to_the_end(&p, 10000000, values), COUNT_OF(values));
    camera_close(p.device);

    write_text("d/2.y4m", "YUV4MPEG2 W4 H2 Cmono\nFRAME\n12");
    p = play("file:", "d@max");
    for (int i = 0; i < 3; i++)
        assert_int_equal(next(&p), CAMERA_FRAME);
    assert_int_equal(next(&p), CAMERA_FAILED);
    assert_non_null(strstr(p.error.text, "2.y4m: "));
    camera_close(p.device);
}

static void a_recording_keeps_its_rate(void **state)
{
    (void)state;
    write_y4m("a.y4m", 50, 4);
    player p = play("file:", "a.y4m");
    assert_true(camera_configure(p.device, &(camera_wishes){0}, &p.error));
    assert_false(camera_configure(p.device, &(camera_wishes){.rate_hz = 20}, &p.error));
    assert_string_equal(p.error.text, "is a recording: its rate cannot be set");
    assert_int_equal(play_to_the_end(&p, 20000000, NULL), 4);
    camera_close(p.device);
}

static void a_recording_has_no_light_to_set(void **state)
{
    (void)state;
    write_y4m("a.y4m", 50, 2);
    player p = play("file:", "a.y4m");
    assert_false(camera_set_light(p.device, 1000, 0, &p.error));
    assert_true(camera_set_light(p.device, 0, 0, &p.error));
    camera_close(p.device);
    camera *device = open_in_folder("file:", "a.y4m", &p.error);
    assert_int_equal(camera_descriptor(device), -1);
    assert_int_equal(camera_next(device, 0, &p.got, &p.error), CAMERA_FAILED);
    camera_close(device);
    camera_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_come_at_their_pace),
        cmocka_unit_test(a_rate_takes_the_place_of_the_recorded_one),
        cmocka_unit_test(flat_out_nothing_is_waited_for_or_left_out),
        cmocka_unit_test(who_is_slow_gets_the_newest_frame),
        cmocka_unit_test(the_newest_frame_stays_until_the_next_one),
        cmocka_unit_test(a_frame_that_is_not_due_times_out),
        cmocka_unit_test(poll_tells_when_a_frame_is_due),
        cmocka_unit_test(recorded_times_set_the_pace_and_the_numbers),
        cmocka_unit_test(times_that_jump_do_not_stop_it),
        cmocka_unit_test(a_cut_line_of_times_is_the_end),
        cmocka_unit_test(what_is_wrong_is_told),
        cmocka_unit_test(headless_frames_are_played),
        cmocka_unit_test(a_directory_is_played_in_order),
        cmocka_unit_test(a_recording_keeps_its_rate),
        cmocka_unit_test(a_recording_has_no_light_to_set),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
