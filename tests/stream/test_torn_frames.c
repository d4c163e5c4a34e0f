/* Frames that a camera or a wire has torn: above from one picture, below from the next; or with a piece missing, so
 * that the rest is moved. What is read in them is in one of the two pictures. */
#include "stream_test.h"

#include <math.h>

#include "recorded_walk.h"

enum { WIDTH_PX = 480, HEIGHT_PX = 270, FRAME_BYTES = WIDTH_PX * HEIGHT_PX, TEARS = 6 };

static const char stream_head[] = "YUV4MPEG2 W480 H270 F25:1 Ip A1:1 Cmono\n", frame_head[] = "FRAME\n";

static const uint8_t *pixels_of(const recorded_walk *pictures, size_t index)
{
    const size_t head = sizeof frame_head - 1;
    return pictures->bytes + pictures->begin + index % WALK_FRAMES * (head + FRAME_BYTES) + head;
}

/* The tear goes through tapes in most of the pictures, at another row each time. */
static void write_torn(FILE *file, const recorded_walk *pictures, size_t index, unsigned tear)
{
    static uint8_t torn[FRAME_BYTES];
    const size_t row = 60 + 25 * tear + 3 * index % 25, at = row * WIDTH_PX;
    const size_t missing = tear % 2 == 0 ? 0 : 16 * (tear + index) + 7;
    memcpy(torn, pixels_of(pictures, index), at);
    if (missing == 0)
        memcpy(torn + at, pixels_of(pictures, index + 1) + at, FRAME_BYTES - at);
    else
        memcpy(torn + at, pixels_of(pictures, index) + at + missing, FRAME_BYTES - at - missing);
    assert_int_equal(fwrite(frame_head, 1, sizeof frame_head - 1, file), sizeof frame_head - 1);
    assert_int_equal(fwrite(torn, 1, FRAME_BYTES, file), FRAME_BYTES);
}

static void write_recording(const char *path)
{
    recorded_walk pictures;
    assert_true(recorded_walk_read(&pictures, STREAM_DATA "/walk.y4m"));
    assert_int_equal(pictures.frame_count, WALK_FRAMES);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(stream_head, 1, sizeof stream_head - 1, file), sizeof stream_head - 1);
    for (unsigned tear = 0; tear < TEARS; tear++)
        for (size_t i = 0; i < WALK_FRAMES; i++)
            write_torn(file, &pictures, i, tear);
    assert_int_equal(fclose(file), 0);
    recorded_walk_release(&pictures);
}

/* In either of the two, whatever the tear has done to its place. */
static bool is_in_view(size_t index, const tapemark_record *record)
{
    const true_frame *frames[] = {&walk.frames[index % WALK_FRAMES], &walk.frames[(index + 1) % WALK_FRAMES]};
    for (int i = 0; i < 2; i++) {
        const double off_px = record->type == TAPEMARK_RECORD_CM ? truth_cm_off_px(frames[i], &record->as.cm)
                                                                  : truth_tm_off_px(frames[i], &record->as.tm);
        if (off_px < INFINITY)
            return true;
    }
    return false;
}

static void torn_frames_tell_nothing_that_is_not_there(void **state)
{
    (void)state;
    char path[] = "/tmp/tapemark-stream-torn-XXXXXX.y4m", camera_name[64];
    tapemark_record record;
    unsigned markers = 0, frames = 0;
    size_t index = 0;
    assert_int_not_equal(close(mkstemps(path, 4)), -1);
    write_recording(path);
    snprintf(camera_name, sizeof camera_name, "file:%s@50", path);
    start(ARGUMENTS("--camera", camera_name, "--serial", "LINE:921600", "--encoding", "cobs"));
    while (next_before_end(&record)) {
        if (record.type == TAPEMARK_RECORD_FRAME) {
            index = (size_t)record.as.frame.seq - 1;
            frames++;
        }
        if (record.type != TAPEMARK_RECORD_CM && record.type != TAPEMARK_RECORD_TM)
            continue;
        markers++;
        if (!is_in_view(index, &record))
            fail_msg("frame %zu: %s %d is in neither picture", index,
                     record.type == TAPEMARK_RECORD_CM ? "CM" : "TM", (int)record.as.cm.id);
    }
    assert_int_equal(host_wait(&host, SOON_MS), 0);
    unlink(path);
    print_message("%u markers in %u torn frames\n", markers, frames);
    assert_true(frames > TEARS && markers > frames / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(torn_frames_tell_nothing_that_is_not_there, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
