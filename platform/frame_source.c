#include "frame_source.h"

#include "file_formats.h"
#include "opencv_media.h"
#include "video_container.h"

#include <string.h>

static bool begins_with(const uint8_t *bytes, size_t size, const char *magic, size_t magic_size)
{
    return size >= magic_size && memcmp(bytes, magic, magic_size) == 0;
}

#define BEGINS_WITH(literal) begins_with(bytes, size, literal, sizeof(literal) - 1)

static bool is_netpbm(const uint8_t *bytes, size_t size, const char *kinds)
{
    return size >= 3 && bytes[0] == 'P' && bytes[1] != '\0' && strchr(kinds, bytes[1]) != NULL &&
           strchr(" \t\r\n\f\v#", bytes[2]) != NULL && bytes[2] != '\0';
}

static bool is_still(const uint8_t *bytes, size_t size)
{
    return BEGINS_WITH("\x89PNG\r\n\x1a\n") || BEGINS_WITH("BM") || BEGINS_WITH("II*\0") || BEGINS_WITH("MM\0*") ||
           (BEGINS_WITH("RIFF") && size >= 12 && memcmp(bytes + 8, "WEBP", 4) == 0) ||
           BEGINS_WITH("\0\0\0\x0cjP  ") || is_netpbm(bytes, size, "13467");
}

static frame_source *open_video(byte_reader *reader, const char *path, error_text *error)
{
    byte_reader_close(reader);
    if (strcmp(path, "-") == 0) {
        error_text_set(error, "this kind of video can only be read from a file; give its name, or pipe Y4M");
        return NULL;
    }
    return opencv_video_open(path, error);
}

static frame_source *refuse(byte_reader *reader, size_t size, error_text *error)
{
    if (!byte_reader_failed(reader, error)) {
        if (size == 0)
            error_text_set(error, "is empty");
        else
            error_text_set(error, "is no picture or video in a known format (headerless captures need a layout)");
    }
    byte_reader_close(reader);
    return NULL;
}

frame_source *frame_source_open_file(const char *path, const frame_layout *raw, error_text *error)
{
    byte_reader *reader = byte_reader_open(path, error);
    if (reader == NULL)
        return NULL;

    const uint8_t *bytes;
    size_t size = byte_reader_peek(reader, &bytes, BYTE_READER_PEEK_MAX);
    if (size == 0)
        return refuse(reader, size, error);
    if (raw != NULL)
        return raw_file_open(reader, raw, error);
    if (is_netpbm(bytes, size, "25"))
        return pgm_file_open(reader, error);
    if (BEGINS_WITH("YUV4MPEG2"))
        return y4m_file_open(reader, error);
    if (BEGINS_WITH("\xff\xd8\xff"))
        return jpeg_file_open(reader, error);
    if (is_still(bytes, size))
        return still_file_open(reader, error);
    if (video_container_of(bytes, size) != VIDEO_UNKNOWN)
        return open_video(reader, path, error);
    return refuse(reader, size, error);
}

frame_status frame_source_next(frame_source *source, frame *output, error_text *error)
{
    frame_status status = source->methods->next(source, output, error);
    if (status == FRAME_READY)
        source->has_given = true;
    if (status == FRAME_END && !source->has_given) {
        error_text_set(error, "holds no frames");
        return FRAME_FAILED;
    }
    return status;
}

void frame_source_close(frame_source *source)
{
    if (source != NULL)
        source->methods->close(source);
}
