/* Recordings: played again they give the same frames; a disk that is full ends them, and what is there stays good. */
#include "../app/test_main.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "recording.h"

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

/* Room for a number of bytes in each file, as the disk might have. */
static unsigned record_into(rlim_t room_bytes, const char *name, const frame_layout *layout)
{
    struct rlimit before, limit;
    error_text error = {""};
    unsigned added = 0;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = room_bytes;
    recording *file = recording_open(in_folder(name), 0, &error);
    assert_non_null(file);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    camera_frame given = frame_of(layout, added);
    while (added < FRAMES && recording_add(file, &given, &error))
        given = frame_of(layout, ++added);
    assert_true(added < FRAMES);
    assert_string_equal(error.text, "the recording ends here: File too large");
    assert_false(recording_add(file, &given, &error));
    bool closed = recording_close(file, &error);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_true(closed);
    return added;
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

static void expect_whole_frames(const char *name, const frame_layout *layout, unsigned count)
{
    enum { Y4M_HEAD_BYTES = 44, Y4M_FRAME_HEAD_BYTES = 6 };
    bool y4m = strstr(name, ".y4m") != NULL;
    size_t frame_bytes = frame_layout_size_bytes(layout) + (y4m ? Y4M_FRAME_HEAD_BYTES : 0);
    error_text error;
    camera_frame got;
    assert_true(size_of(in_folder(name)) == (off_t)(count * frame_bytes) + (y4m ? Y4M_HEAD_BYTES : 0));
    assert_int_equal(lines_of_times(name), 1 + count);
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
    unsigned count;
    (void)state;
    for (rlim_t room = 0; room < 3 * WIDTH * HEIGHT; room += 97) {
        if ((count = record_into(room, "full.raw", &layout)) > 0)
            expect_whole_frames("full.raw", &layout, count);
        if ((count = record_into(room, "full.y4m", &layout)) > 0)
            expect_whole_frames("full.y4m", &layout, count);
    }
    for (rlim_t room = 0; room < 150; room++)
        if ((count = record_into(room, "tiny.raw", &tiny)) > 0)
            expect_whole_frames("tiny.raw", &tiny, count);
}

static void a_device_that_is_full_ends_it(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error;
    (void)state;
    assert_int_equal(symlink("/dev/full", in_folder("link.raw")), 0);
    recording *file = recording_open(in_folder("link.raw"), 0, &error);
    assert_non_null(file);
    camera_frame given = frame_of(&layout, 0);
    assert_false(recording_add(file, &given, &error));
    assert_string_equal(error.text, "the recording ends here: No space left on device");
    recording_close(file, &error);
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
        cmocka_unit_test(another_size_ends_it),
        cmocka_unit_test(where_nothing_can_be_written_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
