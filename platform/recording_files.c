#include "recording_files.h"

#include "gray.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

/* Keeps count of what is whole, so that the rest can be cut off. */
typedef struct written_file {
    int descriptor;
    off_t whole_bytes;
} written_file;

struct recording_files {
    written_file frames;
    written_file times;
    bool y4m;
    double rate_hz;
    frame_layout layout;   /* as recorded; a width of 0 before the first frame */
    gray_converter gray;
    uint8_t *packed;       /* a Y4M frame: its head and rows without gaps */
    const atomic_bool *given_up;
};

static const char y4m_frame_head[] = "FRAME\n";
enum { Y4M_FRAME_HEAD_BYTES = sizeof y4m_frame_head - 1 };

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), ending_length = strlen(ending);
    return length >= ending_length && strcmp(text + length - ending_length, ending) == 0;
}

/* Only a pipe has no room for now; it is waited for in short turns. */
static bool wait_for_room(const recording_files *files, int descriptor)
{
    const int turn_ms = 50;
    struct pollfd waiting = {descriptor, POLLOUT, 0};
    if (atomic_load(files->given_up)) {
        errno = ETIMEDOUT;
        return false;
    }
    poll(&waiting, 1, turn_ms);
    return true;
}

static bool write_all(const recording_files *files, int descriptor, const void *bytes, size_t size)
{
    const uint8_t *rest = bytes;
    while (size > 0) {
        ssize_t written = write(descriptor, rest, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0 && errno == EAGAIN && wait_for_room(files, descriptor))
            continue;
        if (written <= 0)
            return false;
        rest += written;
        size -= (size_t)written;
    }
    return true;
}

static int open_for_writing(const char *path, bool *created)
{
    const int flags = O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    int descriptor = open(path, flags | O_CREAT | O_EXCL, 0644);
    *created = descriptor >= 0;
    return descriptor < 0 && errno == EEXIST ? open(path, flags) : descriptor;
}

static void release(recording_files *files)
{
    if (files->frames.descriptor >= 0)
        close(files->frames.descriptor);
    if (files->times.descriptor >= 0)
        close(files->times.descriptor);
    gray_converter_release(&files->gray);
    free(files->packed);
    free(files);
}

/* The next two return 0, or what errno was. What a former recording left is thrown away only when both can be
 * written, and nobody plays it or records to it: who does holds a lock. */
static int open_times(recording_files *files, const char *times_path)
{
    bool ignored;
    if (flock(files->frames.descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return ETXTBSY;
    files->times.descriptor = open_for_writing(times_path, &ignored);
    if (files->times.descriptor < 0)
        return errno;
    /* Pipes and devices have nothing to throw away. */
    bool emptied = ftruncate(files->frames.descriptor, 0) == 0 || errno == EINVAL;
    return emptied && ftruncate(files->times.descriptor, 0) == 0 ? 0 : errno;
}

static int open_both(recording_files *files, const char *path, const char *times_path)
{
    bool created;
    files->frames.descriptor = open_for_writing(path, &created);
    if (files->frames.descriptor < 0)
        return errno;
    int failure = open_times(files, times_path);
    if (failure != 0 && created)
        unlink(path);
    return failure;
}

static const char *explain(int failure)
{
    if (failure == ENXIO)
        return "it is a pipe that nobody reads";
    return failure == ETXTBSY ? "it is being played, or recorded to" : strerror(failure);
}

recording_files *recording_files_open(const char *path, double rate_hz, const atomic_bool *given_up,
                                      error_text *error)
{
    size_t times_path_bytes = strlen(path) + sizeof ".times";
    char *times_path = malloc(times_path_bytes);
    recording_files *files = calloc(1, sizeof *files);
    if (times_path == NULL || files == NULL) {
        error_text_set(error, "not enough memory");
        free(times_path);
        free(files);
        return NULL;
    }
    snprintf(times_path, times_path_bytes, "%s.times", path);
    files->y4m = ends_with(path, ".y4m");
    files->rate_hz = rate_hz;
    files->frames.descriptor = files->times.descriptor = -1;
    files->given_up = given_up;
    int failure = open_both(files, path, times_path);
    free(times_path);
    if (failure == 0)
        return files;
    error_text_set(error, "cannot be recorded to: %s", explain(failure));
    release(files);
    return NULL;
}

/* Takes back what was written of a frame of which not all could be. Where nothing can be cut off (of a device, say)
 * there is only more of it than the times tell of. */
static void cut_to_whole(const written_file *file)
{
    if (ftruncate(file->descriptor, file->whole_bytes) == 0)
        lseek(file->descriptor, file->whole_bytes, SEEK_SET);
}

static void end_with_failure(recording_files *files, int failure, error_text *error)
{
    error_text_set(error, "the recording ends here: %s", strerror(failure));
    cut_to_whole(&files->frames);
    cut_to_whole(&files->times);
}

static bool write_heads(recording_files *files, error_text *error)
{
    char text[160];
    const frame_layout *layout = &files->layout;
    int length = snprintf(text, sizeof text, "# tapemark times 1 %s:%dx%d:%zu\n",
                          pixel_format_describe(layout->format)->name, layout->width_px, layout->height_px,
                          layout->stride_bytes);
    bool written = write_all(files, files->times.descriptor, text, (size_t)length);
    files->times.whole_bytes = written ? length : 0;
    if (written && files->y4m) {
        long rate_mhz = files->rate_hz > 0 ? lround(files->rate_hz * 1000) : 30000;
        length = snprintf(text, sizeof text, "YUV4MPEG2 W%d H%d F%ld:1000 Ip A1:1 Cmono\n", layout->width_px,
                          layout->height_px, rate_mhz);
        written = write_all(files, files->frames.descriptor, text, (size_t)length);
        files->frames.whole_bytes = written ? length : 0;
    }
    if (!written)
        end_with_failure(files, errno, error);
    return written;
}

static bool begin(recording_files *files, const frame_layout *layout, error_text *error)
{
    files->layout = *layout;
    if (files->y4m) {
        size_t gray_bytes = (size_t)layout->width_px * (size_t)layout->height_px;
        files->packed = malloc(Y4M_FRAME_HEAD_BYTES + gray_bytes);
        if (files->packed == NULL) {
            error_text_set(error, "not enough memory for a frame of %zu bytes", gray_bytes);
            return false;
        }
        memcpy(files->packed, y4m_frame_head, Y4M_FRAME_HEAD_BYTES);
        files->layout = (frame_layout){PIXEL_GREY, layout->width_px, layout->height_px, (size_t)layout->width_px};
    }
    return write_heads(files, error);
}

/* Points to the bytes of a frame as the recording has them. */
static bool prepare(recording_files *files, const frame *input, const uint8_t **bytes, size_t *size,
                    error_text *error)
{
    gray_view view;
    if (!files->y4m) {
        *bytes = input->data;
        *size = frame_layout_size_bytes(&input->layout);
        return true;
    }
    if (!gray_from_frame(&files->gray, input, &view, error))
        return false;
    size_t width = (size_t)view.width_px;
    for (int32_t y = 0; y < view.height_px; y++)
        memcpy(files->packed + Y4M_FRAME_HEAD_BYTES + (size_t)y * width, view.pixels + y * view.stride_bytes, width);
    *bytes = files->packed;
    *size = Y4M_FRAME_HEAD_BYTES + width * (size_t)view.height_px;
    return true;
}

static bool write_frame(recording_files *files, const camera_frame *input, error_text *error)
{
    char line[80];
    const uint8_t *bytes;
    size_t size;
    if (!prepare(files, &input->image, &bytes, &size, error))
        return false;
    int length = snprintf(line, sizeof line, "%llu %lld %d\n", (unsigned long long)input->image.sequence,
                          (long long)input->image.time_ns, input->exposure_us);
    if (!write_all(files, files->frames.descriptor, bytes, size) ||
        !write_all(files, files->times.descriptor, line, (size_t)length)) {
        end_with_failure(files, errno, error);
        return false;
    }
    files->frames.whole_bytes += (off_t)size;
    files->times.whole_bytes += length;
    return true;
}

bool recording_files_add(recording_files *files, const camera_frame *input, error_text *error)
{
    if (files->layout.width_px == 0 && !begin(files, &input->image.layout, error))
        return false;
    return write_frame(files, input, error);
}

bool recording_files_close(recording_files *files, error_text *error)
{
    /* Disks that are reached over a network may tell only now that they are full. */
    bool closed = close(files->frames.descriptor) == 0;
    int failure = errno;
    if (close(files->times.descriptor) != 0) {
        failure = closed ? errno : failure;
        closed = false;
    }
    if (!closed)
        error_text_set(error, "the recording is not whole: %s", strerror(failure));
    files->frames.descriptor = -1;
    files->times.descriptor = -1;
    release(files);
    return closed;
}
