/* The time of day is set while the program runs, as it is when a network is found, or by people: nothing that it says
 * or does hangs on that. */
#include "stream_test.h"

static int open_jumping(void **state)
{
    /* Sanitizers want to be loaded first, unless told. */
    setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 0);
    setenv("LD_PRELOAD", JUMPING_CLOCK, 1);
    return open_host(state);
}

static int close_jumping(void **state)
{
    unsetenv("LD_PRELOAD");
    return close_host(state);
}

/* It may be early by what the machine was late before. */
static void frames_keep_their_times(void **state)
{
    (void)state;
    enum { FRAMES = 40 };
    walk_check check = {.walk = &walk};
    tapemark_record record;
    uint32_t last_us = 0;
    unsigned statuses = 0, young = 0;
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--serial", "LINE:921600"));
    while (check.frames < FRAMES) {
        assert_true(host_record(&host, SOON_MS, &record));
        walk_check_record(&check, &record);
        statuses += record.type == TAPEMARK_RECORD_STATUS;
        if (record.type != TAPEMARK_RECORD_FRAME || (record.as.frame.flags & TAPEMARK_FRAME_TIMED) == 0)
            continue;
        /* A busy machine takes seconds; the clock jumps by hours and more. */
        const uint32_t step_us = record.as.frame.capture_us - last_us;
        young += record.as.frame.age_10us > 0 && record.as.frame.age_10us < UINT16_MAX;
        if (last_us != 0)
            assert_in_range(step_us, 1, 60 * 1000000);
        last_us = record.as.frame.capture_us;
    }
    assert_int_equal(check.wrong + check.misplaced, 0);
    assert_true(statuses > 0 && young > FRAMES / 2);
    expect_silence();
}

static bool tells_lost_camera(const tapemark_frame_record *head)
{
    return (head->flags & TAPEMARK_FRAME_CAMERA_LOST) != 0;
}

static bool tells_picture(const tapemark_frame_record *head)
{
    return head->width_px == 480;
}

/* A wait that ended by the time of day would last for hours. */
static void a_silent_pipe_is_not_waited_for(void **state)
{
    (void)state;
    enum { FRAME_BYTES = 480 * 270 * 3 / 2 };
    static char bytes[4 * FRAME_BYTES];
    char path[] = "/tmp/tapemark-stream-clock-XXXXXX", camera_name[64];
    FILE *recording = fopen(STREAM_DATA "/walk.y4m", "rb");
    assert_non_null(recording);
    const size_t size = fread(bytes, 1, sizeof bytes, recording);
    fclose(recording);
    assert_int_not_equal(close(mkstemp(path)), -1);
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    snprintf(camera_name, sizeof camera_name, "file:%s@50", path);
    const int end = open(path, O_RDWR | O_CLOEXEC);
    start(ARGUMENTS("--camera", camera_name, "--serial", "LINE:921600"));
    assert_int_equal(write(end, bytes, size), size);
    expect_frame(tells_picture, "from the pipe");
    expect_frame(tells_lost_camera, "once nothing comes any more");
    for (uint16_t i = 0; i < 8; i++) {
        host_command(&host, i, "SET", "exposure", "500");
        const tapemark_record answer = expect_record(TAPEMARK_RECORD_ANSWER);
        assert_int_equal(answer.as.answer.number, i);
        assert_string_equal(answer.as.answer.text, "does not answer");
    }
    assert_int_equal(kill(host.program, SIGTERM), 0);
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    close(end);
    unlink(path);
}

/* What is recorded meanwhile has the times of the frames, and is played at their pace. */
static void recordings_keep_their_times(void **state)
{
    (void)state;
    char folder[] = "/tmp/tapemark-stream-clock-XXXXXX", path[100], times[110], line[200];
    long long sequence = 0, time_ns = 0, last_ns = 0;
    unsigned frames = 0;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/seen.y4m", folder);
    snprintf(times, sizeof times, "%s.times", path);
    start(ARGUMENTS("--camera", WALK "@50", "--output", "file:/dev/null", "--record", path));
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    FILE *file = fopen(times, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "%lld %lld", &sequence, &time_ns) != 2)
            continue;
        assert_true(last_ns == 0 || (time_ns > last_ns && time_ns - last_ns < INT64_C(60000000000)));
        last_ns = time_ns;
        frames++;
    }
    fclose(file);
    assert_in_range(frames, 2, WALK_FRAMES);
    unlink(path);
    unlink(times);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(frames_keep_their_times, open_jumping, close_jumping),
        cmocka_unit_test_setup_teardown(a_silent_pipe_is_not_waited_for, open_jumping, close_jumping),
        cmocka_unit_test_setup_teardown(recordings_keep_their_times, open_jumping, close_jumping),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
