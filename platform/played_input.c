#include "played_input.h"

#include <fcntl.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

static bool is_y4m(const char *path)
{
    size_t length = strlen(path);
    return length >= 4 && strcmp(path + length - 4, ".y4m") == 0;
}

/* Where there can be no lock, there is none. */
static int lock_file(const char *path)
{
    int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor >= 0)
        flock(descriptor, LOCK_SH | LOCK_NB);
    return descriptor;
}

bool played_input_open(played_input *input, const char *path, const frame_layout *headless, error_text *error)
{
    const frame_layout *layout = headless;
    *input = (played_input){.lock = -1};
    if (!recording_times_open(path, &input->times, error))
        return false;
    if (layout == NULL && input->times != NULL && !is_y4m(path))
        layout = recording_times_layout(input->times);
    input->source = frame_source_open_file(path, layout, error);
    if (input->source == NULL) {
        played_input_close(input);
        return false;
    }
    input->lock = lock_file(path);
    return true;
}

frame_status played_input_next(played_input *input, uint64_t number, frame *image, recorded_frame *recorded,
                               error_text *error)
{
    times_status known = input->times != NULL ? recording_times_next(input->times, recorded, error) : TIMES_FRAME;
    if (known != TIMES_FRAME)
        return known == TIMES_END ? FRAME_END : FRAME_FAILED;
    frame_status status = frame_source_next(input->source, image, error);
    if (status == FRAME_READY && input->times == NULL)
        *recorded = (recorded_frame){number, image->time_ns, 0};
    return status;
}

void played_input_close(played_input *input)
{
    frame_source_close(input->source);
    recording_times_close(input->times);
    if (input->source != NULL && input->lock >= 0)
        close(input->lock);
    *input = (played_input){0};
}
