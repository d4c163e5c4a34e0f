/* Recordings with the times beside them, played as a camera. What is before the first line "----" is the file of
 * times, the rest the frames. */
#include <string.h>

#include "camera.h"
#include "content_file.h"

static const char divider[] = "----\n";

static const uint8_t *find_divider(const uint8_t *bytes, size_t size)
{
    const size_t length = sizeof divider - 1;
    for (size_t i = 0; i + length <= size; i++)
        if (memcmp(bytes + i, divider, length) == 0)
            return bytes + i;
    return NULL;
}

static void claim_frame(const camera_frame *got, uint64_t *last_sequence)
{
    const size_t size = frame_layout_size_bytes(&got->image.layout);
    CLAIM(size > 0 && got->image.data != NULL && got->exposure_us >= 0);
    CLAIM(got->image.data[0] + got->image.data[size - 1] <= 2 * 255);
    CLAIM(*last_sequence == UINT64_MAX || got->image.sequence > *last_sequence);
    *last_sequence = got->image.sequence;
}

static void play(camera *device)
{
    enum { FRAMES_MAX = 50 };
    const camera_wishes wishes = {0};
    error_text error = {""};
    camera_frame got;
    uint64_t last_sequence = UINT64_MAX;
    if (!camera_configure(device, &wishes, &error)) {
        CLAIM(error.text[0] != '\0');
        return;
    }
    for (int i = 0; i < FRAMES_MAX; i++) {
        const camera_status status = camera_next(device, 0, &got, &error);
        CLAIM(status == CAMERA_FRAME || status == CAMERA_END || status == CAMERA_FAILED);
        CLAIM(status != CAMERA_FAILED || error.text[0] != '\0');
        if (status != CAMERA_FRAME)
            return;
        claim_frame(&got, &last_sequence);
        camera_release(device);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    char path[CONTENT_PATH_BYTES], name[CONTENT_PATH_BYTES + 16];
    error_text error = {""};
    const uint8_t *times_end = find_divider(bytes, size);
    if (times_end == NULL)
        return 0;
    const uint8_t *frames = times_end + sizeof divider - 1;
    named_file_write("content.times", bytes, (size_t)(times_end - bytes));
    named_file_write("content", frames, size - (size_t)(frames - bytes));
    named_file_path("content", path);
    snprintf(name, sizeof name, "file:%s@max", path);
    camera *device = camera_open(name, &error);
    if (device == NULL)
        CLAIM(error.text[0] != '\0');
    else
        play(device);
    camera_close(device);
    return 0;
}
