/* Recordings: played again they give the same frames; a disk that is full ends them, and what is there stays good. */
#include "../app/test_main.h"

#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "recording.h"

/* The linker gives these names to write() and to what stands for it (--wrap). */
ssize_t __real_write(int descriptor, const void *bytes, size_t size);
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size);

static atomic_int disk_pause_ms;

/* A disk that takes its time; given none, it does as it is told. */
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size)
{
    for (int waited_ms = 0; waited_ms < atomic_load(&disk_pause_ms); waited_ms++)
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    return __real_write(descriptor, bytes, size);
}

enum { WIDTH = 40, HEIGHT = 30, FRAMES = 10 };

static char folder[200];

static const char *in_folder(const char *name)
{
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    const char *where = getenv("TMPDIR");
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
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

/* Bytes that tell frames apart; the camera's numbers have gaps, and its times are 10 ms apart. */
static camera_frame frame_of(const frame_layout *layout, unsigned number)
{
    static uint8_t bytes[1 << 14];
    size_t size = frame_layout_size_bytes(layout);
    assert_in_range(size, 1, sizeof bytes);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(i * 7 + number * 31);
    return (camera_frame){.image = {*layout, bytes, 2 * number, INT64_C(123456789) + 10000000 * (int64_t)number},
                          .exposure_us = (int32_t)(100 * number)};
}

static void record(const char *path, const frame_layout *layout)
{
    error_text error;
    recording *file = recording_open(path, 25, &error);
    assert_non_null(file);
    for (unsigned i = 0; i < FRAMES; i++) {
        camera_frame given = frame_of(layout, i);
        assert_true(recording_add(file, &given, &error));
    }
    assert_true(recording_close(file, &error));
}

static camera *play(const char *path, error_text *error)
{
    char name[320];
    snprintf(name, sizeof name, "file:%s@max", path);
    camera *device = camera_open(name, error);
    if (device == NULL || !camera_configure(device, &(camera_wishes){0}, error))
        fail_msg("%s", error->text);
    return device;
}

static void raw_recordings_are_byte_for_byte(void **state)
{
    static const frame_layout layouts[] = {
        {PIXEL_GREY, WIDTH, HEIGHT, WIDTH + 8}, {PIXEL_Y10P, WIDTH, HEIGHT, 64},
        {PIXEL_YUYV, WIDTH, HEIGHT, 2 * WIDTH}, {PIXEL_NV12, WIDTH, HEIGHT, WIDTH},
        {PIXEL_YU12, WIDTH, HEIGHT, WIDTH},     {PIXEL_SRGGB10, WIDTH, HEIGHT, 96},
    };
    (void)state;
    for (size_t k = 0; k < COUNT_OF(layouts); k++) {
        error_text error;
        camera_frame got;
        record(in_folder("a.raw"), &layouts[k]);
        camera *device = play(in_folder("a.raw"), &error);
        for (unsigned i = 0; i < FRAMES; i++) {
            camera_frame given = frame_of(&layouts[k], i);
            assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_FRAME);
            assert_memory_equal(&got.image.layout, &given.image.layout, sizeof got.image.layout);
            assert_memory_equal(got.image.data, given.image.data, frame_layout_size_bytes(&layouts[k]));
            assert_int_equal(got.exposure_us, given.exposure_us);
            assert_int_equal(got.image.sequence, given.image.sequence);
            assert_int_equal(got.dropped, i > 0);
        }
        assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_END);
        camera_close(device);
    }
}

static void y4m_recordings_are_the_luma(void **state)
{
    static const frame_layout layout = {PIXEL_YUYV, WIDTH, HEIGHT, 2 * WIDTH + 6};
    error_text error;
    camera_frame got;
    (void)state;
    record(in_folder("a.y4m"), &layout);
    char head[64] = "";
    FILE *file = fopen(in_folder("a.y4m"), "rb");
    assert_non_null(fgets(head, sizeof head, file));
    fclose(file);
    assert_string_equal(head, "YUV4MPEG2 W40 H30 F25000:1000 Ip A1:1 Cmono\n");

    camera *device = play(in_folder("a.y4m"), &error);
    for (unsigned i = 0; i < FRAMES; i++) {
        camera_frame given = frame_of(&layout, i);
        assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_FRAME);
        for (size_t y = 0; y < HEIGHT; y++)
            for (size_t x = 0; x < WIDTH; x++)
                assert_int_equal(got.image.data[y * WIDTH + x],
                                 given.image.data[y * layout.stride_bytes + 2 * x]);
    }
    assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_END);
    camera_close(device);
}

static void times_are_kept(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error;
    recording_times *times;
    recorded_frame got;
    (void)state;
    record(in_folder("a.raw"), &layout);
    assert_true(recording_times_open(in_folder("a.raw"), &times, &error));
    assert_memory_equal(recording_times_layout(times), &layout, sizeof layout);
    for (unsigned i = 0; i < FRAMES; i++) {
        assert_int_equal(recording_times_next(times, &got, &error), TIMES_FRAME);
        assert_int_equal(got.time_ns, 123456789 + 10000000 * (int64_t)i);
    }
    assert_int_equal(recording_times_next(times, &got, &error), TIMES_END);
    recording_times_close(times);
    assert_true(recording_times_open(in_folder("missing"), &times, &error));
    assert_null(times);
}

static off_t size_of(const char *path)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return status.st_size;
}

/* Room for a number of bytes in each file, as the disk might have. The failure is told once, now or at the end. */
static void record_into(rlim_t room_bytes, const char *name, const frame_layout *layout)
{
    struct rlimit before, limit;
    error_text error = {""};
    bool told = false;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = room_bytes;
    recording *file = recording_open(in_folder(name), 0, &error);
    assert_non_null(file);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    for (unsigned i = 0; i < FRAMES && !told; i++) {
        camera_frame given = frame_of(layout, i);
        told = !recording_add(file, &given, &error);
    }
    assert_true(recording_close(file, &error) == told);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_string_equal(error.text, "the recording ends here: File too large");
}

/* Lines of the times of a recording; all have to be ended. */
static unsigned lines_of_times(const char *name)
{
    char path[400];
    snprintf(path, sizeof path, "%s.times", in_folder(name));
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    unsigned lines = 0;
    int last = '\n';
    for (int byte = fgetc(file); byte != EOF; byte = fgetc(file)) {
        lines += byte == '\n';
        last = byte;
    }
    fclose(file);
    assert_int_equal(last, '\n');
    return lines;
}

static void expect_whole_frames(const char *name, const frame_layout *layout)
{
    enum { Y4M_HEAD_BYTES = 44, Y4M_FRAME_HEAD_BYTES = 6 };
    bool y4m = strstr(name, ".y4m") != NULL;
    size_t frame_bytes = frame_layout_size_bytes(layout) + (y4m ? Y4M_FRAME_HEAD_BYTES : 0);
    error_text error;
    camera_frame got;
    if (size_of(in_folder(name)) <= (y4m ? Y4M_HEAD_BYTES : 0))
        return;
    unsigned count = lines_of_times(name) - 1;
    assert_in_range(count, 1, FRAMES - 1);
    assert_true(size_of(in_folder(name)) == (off_t)(count * frame_bytes) + (y4m ? Y4M_HEAD_BYTES : 0));
    camera *device = play(in_folder(name), &error);
    for (unsigned i = 0; i < count; i++)
        assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_FRAME);
    assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_END);
    camera_close(device);
}

static void a_full_disk_ends_it_at_a_whole_frame(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    /* Of which the times take more room than the frames. */
    static const frame_layout tiny = {PIXEL_GREY, 2, 1, 2};
    (void)state;
    for (rlim_t room = 0; room < 3 * WIDTH * HEIGHT; room += 97) {
        record_into(room, "full.raw", &layout);
        expect_whole_frames("full.raw", &layout);
        record_into(room, "full.y4m", &layout);
        expect_whole_frames("full.y4m", &layout);
    }
    assert_int_equal(size_of(in_folder("full.raw")), 2 * WIDTH * HEIGHT);
    for (rlim_t room = 0; room < 150; room++) {
        record_into(room, "tiny.raw", &tiny);
        expect_whole_frames("tiny.raw", &tiny);
    }
}

static void a_device_that_is_full_ends_it(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    const struct timespec moment = {0, 1000000};
    error_text error;
    (void)state;
    assert_int_equal(symlink("/dev/full", in_folder("link.raw")), 0);
    recording *file = recording_open(in_folder("link.raw"), 0, &error);
    assert_non_null(file);
    camera_frame given = frame_of(&layout, 0);
    for (int i = 0; i < 5000 && recording_add(file, &given, &error); i++)
        nanosleep(&moment, NULL);
    assert_string_equal(error.text, "the recording ends here: No space left on device");
    assert_false(recording_add(file, &given, &error));
    /* It was told already. */
    assert_true(recording_close(file, &error));
}

static int64_t ms_since(int64_t start_ns)
{
    return (camera_clock_ns() - start_ns) / 1000000;
}

/* Frames of half a megabyte, of which a queue holds as many as its bytes allow. */
static camera_frame large_frame(unsigned number)
{
    enum { SIDE = 724 };
    static uint8_t bytes[SIDE * SIDE];
    memset(bytes, (int)number, sizeof bytes);
    return (camera_frame){.image = {{PIXEL_GREY, SIDE, SIDE, SIDE}, bytes, number, (int64_t)number * 1000000}};
}

/* The frame path goes on, whatever the disk does; what it cannot take is counted and left out. */
static void a_slow_disk_keeps_nobody_waiting(void **state)
{
    enum { GIVEN = 200 };
    error_text error;
    camera_frame got;
    int64_t slowest_ms = 0;
    (void)state;
    recording *file = recording_open(in_folder("slow.raw"), 0, &error);
    assert_non_null(file);
    atomic_store(&disk_pause_ms, 300);
    for (unsigned i = 0; i < GIVEN; i++) {
        camera_frame given = large_frame(i);
        int64_t start_ns = camera_clock_ns();
        assert_true(recording_add(file, &given, &error));
        slowest_ms = ms_since(start_ns) > slowest_ms ? ms_since(start_ns) : slowest_ms;
    }
    assert_in_range(slowest_ms, 0, 250);
    assert_in_range(recording_left_out(file), GIVEN - 70, GIVEN - 60);
    atomic_store(&disk_pause_ms, 0);
    assert_false(recording_close(file, &error));
    assert_non_null(strstr(error.text, "lacks"));

    camera *device = play(in_folder("slow.raw"), &error);
    for (unsigned i = 0; i < 60; i++) {
        assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_FRAME);
        assert_int_equal(got.image.sequence, i);
        assert_int_equal(got.image.data[0], i);
    }
    camera_close(device);
}

static void a_disk_that_does_not_answer_is_left(void **state)
{
    error_text error;
    (void)state;
    recording *file = recording_open(in_folder("dead.raw"), 0, &error);
    assert_non_null(file);
    atomic_store(&disk_pause_ms, 60000);
    camera_frame given = large_frame(0);
    assert_true(recording_add(file, &given, &error));
    int64_t start_ns = camera_clock_ns();
    assert_false(recording_close(file, &error));
    assert_string_equal(error.text, "the recording is not whole: the disk does not answer");
    assert_in_range(ms_since(start_ns), 1900, 4000);
    /* So that its thread comes to its end as well. */
    atomic_store(&disk_pause_ms, 0);
    nanosleep(&(struct timespec){0, 300000000}, NULL);
    assert_int_equal(size_of(in_folder("dead.raw")), given.image.layout.stride_bytes * 724);
}

static void pipes_are_written_as_they_are_read(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    static uint8_t bytes[2 * WIDTH * HEIGHT];
    error_text error;
    (void)state;
    assert_int_equal(mkfifo(in_folder("pipe.raw"), 0600), 0);
    assert_null(recording_open(in_folder("pipe.raw"), 0, &error));
    assert_string_equal(error.text, "cannot be recorded to: it is a pipe that nobody reads");

    int reader = open(in_folder("pipe.raw"), O_RDONLY | O_NONBLOCK);
    recording *file = recording_open(in_folder("pipe.raw"), 0, &error);
    assert_non_null(file);
    camera_frame given = large_frame(7);
    assert_true(recording_add(file, &given, &error));
    int64_t start_ns = camera_clock_ns();
    assert_false(recording_close(file, &error));
    assert_in_range(ms_since(start_ns), 900, 3000);
    assert_in_range(read(reader, bytes, sizeof bytes), 1, (long)sizeof bytes);

    file = recording_open(in_folder("pipe.raw"), 0, &error);
    while (read(reader, bytes, sizeof bytes) > 0)
        continue;
    given = frame_of(&layout, 3);
    assert_true(recording_add(file, &given, &error));
    assert_true(recording_close(file, &error));
    assert_int_equal(read(reader, bytes, sizeof bytes), WIDTH * HEIGHT);
    assert_memory_equal(bytes, given.image.data, WIDTH * HEIGHT);
    close(reader);
}

/* Records until it is killed. */
static void record_for_ever(const char *path)
{
    error_text error;
    recording *file = recording_open(path, 0, &error);
    for (unsigned i = 0; file != NULL; i++) {
        camera_frame given = large_frame(i);
        recording_add(file, &given, &error);
        nanosleep(&(struct timespec){0, 200000}, NULL);
    }
    _exit(1);
}

static void what_a_killed_program_recorded_is_played(void **state)
{
    static const char *const names[] = {"killed.raw", "killed.y4m"};
    error_text error;
    camera_frame got;
    camera_status status;
    (void)state;
    for (unsigned round = 0; round < 6; round++) {
        const char *path = in_folder(names[round % 2]);
        pid_t child = fork();
        if (child == 0)
            record_for_ever(path);
        nanosleep(&(struct timespec){0, 60000000 + 7100000 * (long)round}, NULL);
        kill(child, SIGKILL);
        assert_int_equal(waitpid(child, NULL, 0), child);
        camera *device = play(path, &error);
        unsigned count = 0;
        while ((status = camera_next(device, 100, &got, &error)) == CAMERA_FRAME) {
            assert_int_equal(got.image.data[0], got.image.sequence & 0xff);
            assert_int_equal(got.image.data[724 * 724 - 1], got.image.sequence & 0xff);
            count++;
        }
        assert_int_equal(status, CAMERA_END);
        assert_in_range(count, 1, 100000);
        camera_close(device);
    }
}

/* A recording that cannot begin leaves the one that is there. */
static void what_cannot_begin_destroys_nothing(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error;
    (void)state;
    record(in_folder("kept.raw"), &layout);
    assert_int_equal(remove(in_folder("kept.raw.times")), 0);
    assert_int_equal(mkdir(in_folder("kept.raw.times"), 0700), 0);
    assert_null(recording_open(in_folder("kept.raw"), 0, &error));
    assert_int_equal(size_of(in_folder("kept.raw")), FRAMES * WIDTH * HEIGHT);
}

static void another_size_ends_it(void **state)
{
    static const frame_layout first = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    static const frame_layout second = {PIXEL_GREY, HEIGHT, WIDTH, HEIGHT};
    error_text error;
    (void)state;
    recording *file = recording_open(in_folder("size.raw"), 0, &error);
    camera_frame given = frame_of(&first, 0);
    assert_true(recording_add(file, &given, &error));
    given = frame_of(&second, 1);
    assert_false(recording_add(file, &given, &error));
    assert_non_null(strstr(error.text, "another size"));
    assert_true(recording_close(file, &error));
    assert_int_equal(size_of(in_folder("size.raw")), WIDTH * HEIGHT);
}

static void where_nothing_can_be_written_is_told(void **state)
{
    error_text error;
    (void)state;
    assert_null(recording_open(in_folder("no/such/folder.raw"), 0, &error));
    assert_string_equal(error.text, "cannot be recorded to: No such file or directory");
    mkdir(in_folder("b.raw.times"), 0700);
    assert_null(recording_open(in_folder("b.raw"), 0, &error));
    assert_true(recording_close(NULL, &error));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raw_recordings_are_byte_for_byte),
        cmocka_unit_test(y4m_recordings_are_the_luma),
        cmocka_unit_test(times_are_kept),
        cmocka_unit_test(a_full_disk_ends_it_at_a_whole_frame),
        cmocka_unit_test(a_device_that_is_full_ends_it),
        cmocka_unit_test(a_slow_disk_keeps_nobody_waiting),
        cmocka_unit_test(a_disk_that_does_not_answer_is_left),
        cmocka_unit_test(pipes_are_written_as_they_are_read),
        cmocka_unit_test(what_a_killed_program_recorded_is_played),
        cmocka_unit_test(what_cannot_begin_destroys_nothing),
        cmocka_unit_test(another_size_ends_it),
        cmocka_unit_test(where_nothing_can_be_written_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
