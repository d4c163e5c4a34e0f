/* Recordings on disks that take their time, do not answer, or are pipes; and of programs that are killed. */
#include "recording_fixture.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The linker gives these names to write() and ftruncate() and to what stands for them (--wrap). */
ssize_t __real_write(int descriptor, const void *bytes, size_t size);
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size);
int __real_ftruncate64(int descriptor, off_t size);
int __wrap_ftruncate64(int descriptor, off_t size);

static atomic_int disk_pause_ms;
static atomic_int failing_errno;   /* 0: the disk does not fail */
static atomic_int writes_before;   /* that are still done */
static atomic_size_t most_bytes;   /* that it takes at once; 0: all */

static bool fails(void)
{
    if (atomic_load(&failing_errno) == 0 || atomic_fetch_sub(&writes_before, 1) > 0)
        return false;
    errno = atomic_load(&failing_errno);
    return true;
}

/* A disk that takes its time, takes little at once, or fails; else it does as it is told. */
ssize_t __wrap_write(int descriptor, const void *bytes, size_t size)
{
    const size_t most = atomic_load(&most_bytes);
    for (int waited_ms = 0; waited_ms < atomic_load(&disk_pause_ms); waited_ms++)
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    if (fails())
        return -1;
    return __real_write(descriptor, bytes, most > 0 && size > most ? most : size);
}

/* What cannot be written any more cannot be cut off either. */
int __wrap_ftruncate64(int descriptor, off_t size)
{
    if (atomic_load(&failing_errno) != 0 && atomic_load(&writes_before) < 0) {
        errno = atomic_load(&failing_errno);
        return -1;
    }
    return __real_ftruncate64(descriptor, size);
}

static int64_t ms_since(int64_t start_ns)
{
    return (camera_clock_ns() - start_ns) / 1000000;
}

/* Frames of half a megabyte, of which a queue holds as many as its bytes allow. */
enum { SIDE = 724 };

static camera_frame large_frame(unsigned number)
{
    static uint8_t bytes[SIDE * SIDE];
    memset(bytes, (int)number, sizeof bytes);
    return (camera_frame){.image = {{PIXEL_GREY, SIDE, SIDE, SIDE}, bytes, number, (int64_t)number * 1000000}};
}

static void wait_for_size(const char *path, off_t bytes)
{
    for (int i = 0; i < 3000 && size_of(path) < bytes; i++)
        nanosleep(&(struct timespec){0, 10000000}, NULL);
    assert_in_range(size_of(path), bytes, INT64_MAX);
}

/* The frame path goes on, whatever the disk does; what it cannot take is counted and left out. */
static void a_slow_disk_keeps_nobody_waiting(void **state)
{
    enum { GIVEN = 200, KEPT = 64 };
    error_text error;
    camera_frame got;
    (void)state;
    recording *file = recording_open(in_folder("slow.raw"), 0, &error);
    assert_non_null(file);
    atomic_store(&disk_pause_ms, 60000);
    int64_t start_ns = camera_clock_ns();
    for (unsigned i = 0; i < GIVEN; i++) {
        camera_frame given = large_frame(i);
        assert_true(recording_add(file, &given, &error));
    }
    assert_in_range(ms_since(start_ns), 0, 30000);
    assert_int_equal(recording_left_out(file), GIVEN - KEPT);
    atomic_store(&disk_pause_ms, 0);
    wait_for_size(in_folder("slow.raw"), KEPT * SIDE * SIDE);
    assert_false(recording_close(file, &error));
    assert_string_equal(error.text, "the recording lacks 136 frames: the disk was too slow");

    camera *device = play(in_folder("slow.raw"), &error);
    for (unsigned i = 0; i < KEPT; i++) {
        assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_FRAME);
        assert_int_equal(got.image.sequence, i);
        assert_int_equal(got.image.data[0], i);
    }
    assert_int_equal(camera_next(device, 100, &got, &error), CAMERA_END);
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
    assert_in_range(ms_since(start_ns), 1900, 30000);
    /* Its thread comes to its end all the same. */
    atomic_store(&disk_pause_ms, 0);
    wait_for_size(in_folder("dead.raw"), SIDE * SIDE);
    nanosleep(&(struct timespec){0, 300000000}, NULL);
}

/* Plays what there is; the frames have to be those from 0 on. */
static unsigned count_played(const char *path)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error;
    camera_frame got;
    unsigned count = 0;
    char name[320];
    snprintf(name, sizeof name, "file:%s@max", path);
    camera *device = camera_open(name, &error);
    if (device == NULL || !camera_configure(device, &(camera_wishes){0}, &error)) {
        camera_close(device);
        return 0;
    }
    camera_status status;
    while ((status = camera_next(device, 100, &got, &error)) == CAMERA_FRAME) {
        const camera_frame given = frame_of(&layout, count++);
        assert_memory_equal(got.image.data, given.image.data, WIDTH * HEIGHT);
    }
    assert_int_equal(status, CAMERA_END);
    camera_close(device);
    return count;
}

/* Records until it cannot, or all were taken. */
static void record_on_failing_disk(const char *path, int failure, int after, size_t most)
{
    static const frame_layout layout = {PIXEL_GREY, WIDTH, HEIGHT, WIDTH};
    error_text error = {""};
    recording *file = recording_open(path, 25, &error);
    assert_non_null(file);
    atomic_store(&most_bytes, most);
    atomic_store(&writes_before, after);
    atomic_store(&failing_errno, failure);
    bool good = true;
    for (unsigned i = 0; good && i < FRAMES; i++) {
        const camera_frame given = frame_of(&layout, i);
        good = recording_add(file, &given, &error);
    }
    good = recording_close(file, &error) && good;
    const bool failed = atomic_load(&writes_before) < 0;
    atomic_store(&failing_errno, 0);
    atomic_store(&most_bytes, 0);
    assert_int_equal(good, !failed);
    if (failed)
        assert_non_null(strstr(error.text, strerror(failure)));
}

/* It becomes read-only, breaks, or a quota is used up: what was whole before is played. */
static void a_disk_that_fails_leaves_what_was_whole(void **state)
{
    static const int failures[] = {EROFS, EIO, ENOSPC, EDQUOT, EBADF, EPERM, ENXIO};
    static const char *const names[] = {"failing.raw", "failing.y4m"};
    (void)state;
    for (size_t k = 0; k < COUNT_OF(names); k++)
        for (size_t f = 0; f < COUNT_OF(failures); f++) {
            unsigned last = 0;
            for (int after = 0; after < 4 * FRAMES; after++) {
                record_on_failing_disk(in_folder(names[k]), failures[f], after, WIDTH * HEIGHT / 2);
                const unsigned count = count_played(in_folder(names[k]));
                assert_in_range(count, last, FRAMES);
                last = count;
            }
            assert_in_range(last, FRAMES / 2, FRAMES);
        }
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
    assert_in_range(ms_since(start_ns), 900, 30000);
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
    bool going_on = file != NULL;
    for (unsigned i = 0; going_on; i++) {
        camera_frame given = large_frame(i);
        going_on = recording_add(file, &given, &error);
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
        nanosleep(&(struct timespec){0, 200000000}, NULL);
        wait_for_size(path, 4 * SIDE * SIDE + 1000 * (off_t)round);
        kill(child, SIGKILL);
        assert_int_equal(waitpid(child, NULL, 0), child);
        camera *device = play(path, &error);
        unsigned count = 0;
        while ((status = camera_next(device, 100, &got, &error)) == CAMERA_FRAME) {
            assert_int_equal(got.image.data[0], got.image.sequence & 0xff);
            assert_int_equal(got.image.data[SIDE * SIDE - 1], got.image.sequence & 0xff);
            count++;
        }
        assert_int_equal(status, CAMERA_END);
        assert_in_range(count, 3, 100000);
        camera_close(device);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_slow_disk_keeps_nobody_waiting),
        cmocka_unit_test(a_disk_that_does_not_answer_is_left),
        cmocka_unit_test(a_disk_that_fails_leaves_what_was_whole),
        cmocka_unit_test(pipes_are_written_as_they_are_read),
        cmocka_unit_test(what_a_killed_program_recorded_is_played),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
