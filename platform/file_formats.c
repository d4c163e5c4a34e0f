#include "file_formats.h"

#include <stdlib.h>

void *frame_source_new(size_t size, const frame_source_methods *methods, byte_reader *reader, error_text *error)
{
    frame_source *source = calloc(1, size);
    if (source == NULL) {
        error_text_set(error, "not enough memory");
        byte_reader_close(reader);
        return NULL;
    }
    source->methods = methods;
    return source;
}

bool frame_buffer_resize(frame_buffer *buffer, size_t size, error_text *error)
{
    if (buffer->bytes != NULL && size <= buffer->size)
        return true;
    free(buffer->bytes);
    buffer->bytes = malloc(size);
    buffer->size = size;
    if (buffer->bytes == NULL)
        error_text_set(error, "not enough memory for a frame of %zu bytes", size);
    return buffer->bytes != NULL;
}

bool read_frame_bytes(byte_reader *reader, void *target, size_t wanted, uint64_t frame_number, error_text *error)
{
    size_t got = byte_reader_read(reader, target, wanted);
    if (got == wanted)
        return true;
    if (!byte_reader_failed(reader, error))
        error_text_set(error, "is cut short: frame %llu ends after %zu of %zu bytes",
                       (unsigned long long)frame_number, got, wanted);
    return false;
}

bool check_bytes_left(const byte_reader *reader, uint64_t wanted, uint64_t frame_number, error_text *error)
{
    int64_t size = byte_reader_size(reader);
    uint64_t taken = byte_reader_offset(reader);
    if (size < 0 || ((uint64_t)size >= taken && (uint64_t)size - taken >= wanted))
        return true;
    uint64_t left = (uint64_t)size > taken ? (uint64_t)size - taken : 0;
    error_text_set(error, "is cut short: frame %llu needs %llu bytes, and %llu are left",
                   (unsigned long long)frame_number, (unsigned long long)wanted, (unsigned long long)left);
    return false;
}

uint64_t estimate_frames(const byte_reader *reader, uint64_t frames_read)
{
    int64_t size = byte_reader_size(reader);
    uint64_t taken = byte_reader_offset(reader);
    if (size <= 0 || taken == 0)
        return 0;
    return (uint64_t)((double)size / (double)taken * (double)frames_read + 0.5);
}
