/* Recordings: played again they give the same frames; a disk that is full ends them, and what is there stays good. */
#include "recording_fixture.h"

#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

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
    assert_int_equal(access(in_folder("b.raw"), F_OK), -1);
    assert_true(recording_close(NULL, &error));
}

static void what_is_played_is_not_recorded_over(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error;
    char times[300];
    (void)state;
    record(in_folder("played.raw"), &layout);
    strcpy(times, in_folder("played.raw.times"));
    assert_int_equal(unlink(times), 0);
    char name[320];
    snprintf(name, sizeof name, "raw:GREY:40x30,%s@max", in_folder("played.raw"));
    camera *device = camera_open(name, &error);
    assert_non_null(device);
    assert_null(recording_open(in_folder("played.raw"), 0, &error));
    assert_int_equal(access(times, F_OK), -1);
    camera_close(device);

    record(in_folder("played.raw"), &layout);
    device = play(in_folder("played.raw"), &error);
    assert_null(recording_open(in_folder("played.raw"), 0, &error));
    assert_string_equal(error.text, "cannot be recorded to: it is being played, or recorded to");
    assert_int_equal(size_of(in_folder("played.raw")), FRAMES * WIDTH * HEIGHT);
    assert_int_equal(lines_of_times("played.raw"), 1 + FRAMES);
    camera_close(device);

    recording *file = recording_open(in_folder("played.raw"), 0, &error);
    assert_non_null(file);
    assert_null(recording_open(in_folder("played.raw"), 0, &error));
    assert_true(recording_close(file, &error));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(raw_recordings_are_byte_for_byte),
        cmocka_unit_test(y4m_recordings_are_the_luma),
        cmocka_unit_test(times_are_kept),
        cmocka_unit_test(a_full_disk_ends_it_at_a_whole_frame),
        cmocka_unit_test(a_device_that_is_full_ends_it),
        cmocka_unit_test(what_cannot_begin_destroys_nothing),
        cmocka_unit_test(what_is_played_is_not_recorded_over),
        cmocka_unit_test(another_size_ends_it),
        cmocka_unit_test(where_nothing_can_be_written_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
