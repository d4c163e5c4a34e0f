#include "recording.h"

#include "gray.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Keeps count of what is whole, so that the rest can be cut off. */
typedef struct written_file {
    int descriptor;
    off_t whole_bytes;
} written_file;

struct recording {
    written_file frames;
    written_file times;
    bool y4m;
    bool ended;
    double rate_hz;
    frame_layout layout;   /* of the first frame; a width of 0 before that */
    gray_converter gray;
    uint8_t *packed;       /* a Y4M frame: its head and rows without gaps */
};

static const char y4m_frame_head[] = "FRAME\n";
enum { Y4M_FRAME_HEAD_BYTES = sizeof y4m_frame_head - 1 };

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), ending_length = strlen(ending);
    return length >= ending_length && strcmp(text + length - ending_length, ending) == 0;
}

static bool write_all(int descriptor, const void *bytes, size_t size)
{
    const uint8_t *rest = bytes;
    while (size > 0) {
        ssize_t written = write(descriptor, rest, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        rest += written;
        size -= (size_t)written;
    }
    return true;
}

static int create(const char *path)
{
    return open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
}

static void release(recording *file)
{
    if (file->frames.descriptor >= 0)
        close(file->frames.descriptor);
    if (file->times.descriptor >= 0)
        close(file->times.descriptor);
    gray_converter_release(&file->gray);
    free(file->packed);
    free(file);
}

recording *recording_open(const char *path, double rate_hz, error_text *error)
{
    size_t times_path_bytes = strlen(path) + sizeof ".times";
    char *times_path = malloc(times_path_bytes);
    recording *file = calloc(1, sizeof *file);
    if (times_path == NULL || file == NULL) {
        error_text_set(error, "not enough memory");
        free(times_path);
        free(file);
        return NULL;
    }
    snprintf(times_path, times_path_bytes, "%s.times", path);
    file->y4m = ends_with(path, ".y4m");
    file->rate_hz = rate_hz;
    file->frames.descriptor = create(path);
    int failure = file->frames.descriptor < 0 ? errno : 0;
    file->times.descriptor = failure == 0 ? create(times_path) : -1;
    if (failure == 0 && file->times.descriptor < 0)
        failure = errno;
    free(times_path);
    if (failure != 0) {
        error_text_set(error, "cannot be recorded to: %s", strerror(failure));
        release(file);
        return NULL;
    }
    return file;
}

/* Takes back what was written of a frame of which not all could be. Where nothing can be cut off (of a device, say)
 * there is only more of it than the times tell of. */
static void cut_to_whole(const written_file *file)
{
    if (ftruncate(file->descriptor, file->whole_bytes) == 0)
        lseek(file->descriptor, file->whole_bytes, SEEK_SET);
}

static void end_with_failure(recording *file, int failure, error_text *error)
{
    error_text_set(error, "the recording ends here: %s", strerror(failure));
    cut_to_whole(&file->frames);
    cut_to_whole(&file->times);
}

static bool write_heads(recording *file, error_text *error)
{
    char text[160];
    const frame_layout *layout = &file->layout;
    int length = snprintf(text, sizeof text, "# tapemark times 1 %s:%dx%d:%zu\n",
                          pixel_format_describe(layout->format)->name, layout->width_px, layout->height_px,
                          layout->stride_bytes);
    bool written = write_all(file->times.descriptor, text, (size_t)length);
    file->times.whole_bytes = written ? length : 0;
    if (written && file->y4m) {
        long rate_mhz = file->rate_hz > 0 ? lround(file->rate_hz * 1000) : 30000;
        length = snprintf(text, sizeof text, "YUV4MPEG2 W%d H%d F%ld:1000 Ip A1:1 Cmono\n", layout->width_px,
                          layout->height_px, rate_mhz);
        written = write_all(file->frames.descriptor, text, (size_t)length);
        file->frames.whole_bytes = written ? length : 0;
    }
    if (!written)
        end_with_failure(file, errno, error);
    return written;
}

static bool begin(recording *file, const frame_layout *layout, error_text *error)
{
    file->layout = *layout;
    if (file->y4m) {
        size_t gray_bytes = (size_t)layout->width_px * (size_t)layout->height_px;
        file->packed = malloc(Y4M_FRAME_HEAD_BYTES + gray_bytes);
        if (file->packed == NULL) {
            error_text_set(error, "not enough memory for a frame of %zu bytes", gray_bytes);
            return false;
        }
        memcpy(file->packed, y4m_frame_head, Y4M_FRAME_HEAD_BYTES);
        file->layout = (frame_layout){PIXEL_GREY, layout->width_px, layout->height_px, (size_t)layout->width_px};
    }
    return write_heads(file, error);
}

static bool same_layout(const recording *file, const frame_layout *layout)
{
    bool same_size = layout->width_px == file->layout.width_px && layout->height_px == file->layout.height_px;
    return same_size && (file->y4m || (layout->format == file->layout.format &&
                                       layout->stride_bytes == file->layout.stride_bytes));
}

/* Points to the bytes of a frame as the recording has them. */
static bool prepare(recording *file, const frame *input, const uint8_t **bytes, size_t *size, error_text *error)
{
    gray_view view;
    if (!file->y4m) {
        *bytes = input->data;
        *size = frame_layout_size_bytes(&input->layout);
        return true;
    }
    if (!gray_from_frame(&file->gray, input, &view, error))
        return false;
    size_t width = (size_t)view.width_px;
    for (int32_t y = 0; y < view.height_px; y++)
        memcpy(file->packed + Y4M_FRAME_HEAD_BYTES + (size_t)y * width, view.pixels + y * view.stride_bytes, width);
    *bytes = file->packed;
    *size = Y4M_FRAME_HEAD_BYTES + width * (size_t)view.height_px;
    return true;
}

static bool write_frame(recording *file, const camera_frame *input, error_text *error)
{
    char line[80];
    const uint8_t *bytes;
    size_t size;
    if (!prepare(file, &input->image, &bytes, &size, error))
        return false;
    int length = snprintf(line, sizeof line, "%llu %lld %d\n", (unsigned long long)input->image.sequence,
                          (long long)input->image.time_ns, input->exposure_us);
    if (!write_all(file->frames.descriptor, bytes, size) ||
        !write_all(file->times.descriptor, line, (size_t)length)) {
        end_with_failure(file, errno, error);
        return false;
    }
    file->frames.whole_bytes += (off_t)size;
    file->times.whole_bytes += length;
    return true;
}

bool recording_add(recording *file, const camera_frame *input, error_text *error)
{
    if (file->ended) {
        error_text_set(error, "the recording has ended");
        return false;
    }
    if (file->layout.width_px == 0)
        file->ended = !begin(file, &input->image.layout, error);
    else if (!same_layout(file, &input->image.layout)) {
        error_text_set(error, "the recording ends here: the camera's pictures have another size or format now");
        file->ended = true;
    }
    file->ended = file->ended || !write_frame(file, input, error);
    return !file->ended;
}

bool recording_close(recording *file, error_text *error)
{
    if (file == NULL)
        return true;
    /* Disks that are reached over a network may tell only now that they are full. */
    bool closed = close(file->frames.descriptor) == 0;
    int failure = errno;
    closed = close(file->times.descriptor) == 0 && closed;
    if (!closed)
        error_text_set(error, "the recording is not whole: %s", strerror(failure));
    file->frames.descriptor = -1;
    file->times.descriptor = -1;
    release(file);
    return closed;
}
