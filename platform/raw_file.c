/* Headerless captures: frame after frame, nothing between them. */
#include "file_formats.h"

#include <stdlib.h>

typedef struct raw_file {
    frame_source source;
    byte_reader *reader;
    frame_layout layout;
    uint8_t *bytes;
    size_t frame_bytes;
    uint64_t frame_count;
} raw_file;

static void explain_remainder(const raw_file *file, size_t got, error_text *error)
{
    const frame_layout *layout = &file->layout;
    error_text_set(error,
                   "is cut short, or not %s:%dx%d:%zu: %zu bytes are left after %llu whole frames of %zu bytes",
                   pixel_format_describe(layout->format)->name, layout->width_px, layout->height_px,
                   layout->stride_bytes, got, (unsigned long long)file->frame_count, file->frame_bytes);
}

static frame_status next_frame(frame_source *source, frame *output, error_text *error)
{
    raw_file *file = (raw_file *)source;
    size_t got = byte_reader_read(file->reader, file->bytes, file->frame_bytes);
    if (got < file->frame_bytes) {
        if (byte_reader_failed(file->reader, error))
            return FRAME_FAILED;
        if (got == 0)
            return FRAME_END;
        explain_remainder(file, got, error);
        return FRAME_FAILED;
    }
    *output = (frame){file->layout, file->bytes, file->frame_count++, FRAME_TIME_UNKNOWN};
    return FRAME_READY;
}

static void close_file(frame_source *source)
{
    raw_file *file = (raw_file *)source;
    byte_reader_close(file->reader);
    free(file->bytes);
    free(file);
}

static const frame_source_methods methods = {next_frame, close_file};

frame_source *raw_file_open(byte_reader *reader, const frame_layout *layout, error_text *error)
{
    raw_file *file = frame_source_new(sizeof *file, &methods, reader, error);
    if (file == NULL)
        return NULL;
    file->reader = reader;
    file->layout = *layout;
    file->frame_bytes = frame_layout_size_bytes(layout);

    int64_t size = byte_reader_size(reader);
    if (file->frame_bytes == 0) {
        error_text_set(error, "no frame can have the size and stride that were given");
    } else if (size > 0 && (uint64_t)size < file->frame_bytes) {
        explain_remainder(file, (size_t)size, error);
    } else {
        file->source.frames_expected = size > 0 ? (uint64_t)size / file->frame_bytes : 0;
        file->bytes = malloc(file->frame_bytes);
        if (file->bytes == NULL)
            error_text_set(error, "not enough memory for a frame of %zu bytes", file->frame_bytes);
    }
    if (file->bytes == NULL) {
        close_file(&file->source);
        return NULL;
    }
    return &file->source;
}
