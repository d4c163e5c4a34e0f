/* What the tests of recordings share: a folder of their own, frames that can be told apart, and playing again. */
#ifndef RECORDING_FIXTURE_H
#define RECORDING_FIXTURE_H

#include "../app/test_main.h"

#include "recording.h"

#include <signal.h>
#include <sys/stat.h>

enum { WIDTH = 40, HEIGHT = 30, FRAMES = 10 };

static char folder[200];

static inline const char *in_folder(const char *name)
{
    static char path[300];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static inline int make_folder(void **state)
{
    const char *where = getenv("TMPDIR");
    (void)state;
    signal(SIGXFSZ, SIG_IGN);
    snprintf(folder, sizeof folder, "%s/tapemark-test-XXXXXX", where != NULL ? where : "/tmp");
    return mkdtemp(folder) != NULL ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* Bytes that tell frames apart; the camera's numbers have gaps, and its times are 10 ms apart. */
static inline camera_frame frame_of(const frame_layout *layout, unsigned number)
{
    static uint8_t bytes[1 << 14];
    size_t size = frame_layout_size_bytes(layout);
    assert_in_range(size, 1, sizeof bytes);
    for (size_t i = 0; i < size; i++)
        bytes[i] = (uint8_t)(i * 7 + number * 31);
    return (camera_frame){.image = {*layout, bytes, 2 * number, INT64_C(123456789) + 10000000 * (int64_t)number},
                          .exposure_us = (int32_t)(100 * number)};
}

static inline void record(const char *path, const frame_layout *layout)
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

static inline camera *play(const char *path, error_text *error)
{
    char name[320];
    snprintf(name, sizeof name, "file:%s@max", path);
    camera *device = camera_open(name, error);
    if (device == NULL || !camera_configure(device, &(camera_wishes){0}, error))
        fail_msg("%s", error->text);
    return device;
}

static inline off_t size_of(const char *path)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return status.st_size;
}

#endif
