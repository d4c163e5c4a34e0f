#include "frame_output.h"

#include <stdlib.h>
#include <string.h>

#include "output_file.h"

struct frame_output {
    frame_output_plan wanted;
    bool numbered;
    output_file **files;  /* one for all frames, or one a frame */
    size_t file_count;    /* opened so far */
    size_t published;
};

enum { PATH_MAX_BYTES = 4096 };

static size_t files_of(const frame_output *output)
{
    return output->numbered ? output->wanted.frame_count : 1;
}

/* ROOM.png becomes ROOM-0007.png. */
static bool name_file(const frame_output *output, size_t index, char *name, size_t size)
{
    const char *path = output->wanted.path, *folder = strrchr(path, '/'), *ending = strrchr(path, '.');
    bool ends = ending != NULL && (folder == NULL || ending > folder + 1) && ending > path;
    size_t stem = ends ? (size_t)(ending - path) : strlen(path);
    int length = output->numbered ? snprintf(name, size, "%.*s-%04zu%s", (int)stem, path, index, path + stem)
                                  : snprintf(name, size, "%s", path);
    return length >= 0 && (size_t)length < size;
}

static void tell(const frame_output *output, size_t index, const char *reason, error_text *error)
{
    char name[PATH_MAX_BYTES];
    bool standard = strcmp(output->wanted.path, "-") == 0;
    bool named = name_file(output, index, name, sizeof name);
    error_text_set(error, "%.200s: %.150s",
                   standard ? "standard output"
                   : named  ? name
                            : output->wanted.path,
                   reason);
}

static bool open_next(frame_output *output, error_text *error)
{
    char name[PATH_MAX_BYTES];
    error_text reason = {"has too long a name"};
    bool named = name_file(output, output->file_count, name, sizeof name);
    output_file *file = named ? output_file_open(name, &reason) : NULL;
    if (file == NULL) {
        tell(output, output->file_count, reason.text, error);
        return false;
    }
    output->files[output->file_count++] = file;
    return true;
}

frame_output *frame_output_open(const frame_output_plan *wanted, error_text *error)
{
    capture_container container = wanted->format->container;
    bool one_a_file = container == CAPTURE_PGM || container == CAPTURE_PNG;
    frame_output *output = calloc(1, sizeof *output);
    if (output != NULL) {
        output->wanted = *wanted;
        output->numbered = one_a_file && wanted->frame_count > 1 && strcmp(wanted->path, "-") != 0;
        output->files = calloc(files_of(output), sizeof *output->files);
    }
    if (output == NULL || output->files == NULL) {
        error_text_set(error, "not enough memory");
        frame_output_close(output);
        return NULL;
    }
    if (!open_next(output, error)) {
        frame_output_close(output);
        return NULL;
    }
    capture_write_header(output_file_stream(output->files[0]), wanted->format, wanted->width_px, wanted->height_px,
                         wanted->fps);
    return output;
}

/* A numbered file is full after its frame. */
static bool complete_last(frame_output *output, error_text *error)
{
    error_text reason;
    size_t last = output->file_count - 1;
    if (output_file_complete(output->files[last], &reason))
        return true;
    tell(output, last, reason.text, error);
    return false;
}

bool frame_output_add(frame_output *output, const uint16_t *samples, error_text *error)
{
    const frame_output_plan *wanted = &output->wanted;
    FILE *stream = output_file_stream(output->files[output->file_count - 1]);
    if (stream == NULL) {
        if (!open_next(output, error))
            return false;
        stream = output_file_stream(output->files[output->file_count - 1]);
    }
    if (!capture_write_frame(stream, wanted->format, samples, wanted->width_px, wanted->height_px,
                             wanted->stride_bytes)) {
        error_text_set(error, "not enough memory");
        return false;
    }
    /* Without this, a full disk would be noticed after the last of a hundred thousand frames. */
    if (ferror(stream) != 0 || output->numbered)
        return complete_last(output, error);
    return true;
}

bool frame_output_complete(frame_output *output, error_text *error)
{
    return complete_last(output, error);
}

bool frame_output_publish(frame_output *output, error_text *error)
{
    error_text reason;
    for (; output->published < output->file_count; output->published++) {
        output_file *file = output->files[output->published];
        output->files[output->published] = NULL;
        if (!output_file_publish(file, &reason)) {
            tell(output, output->published, reason.text, error);
            return false;
        }
    }
    return true;
}

void frame_output_close(frame_output *output)
{
    if (output == NULL)
        return;
    for (size_t i = output->published; i < output->file_count; i++)
        output_file_discard(output->files[i]);
    free(output->files);
    free(output);
}
