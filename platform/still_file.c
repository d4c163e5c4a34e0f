/* Still pictures in the formats that OpenCV decodes, found in a stream of bytes and decoded one by one. */
#include "file_formats.h"
#include "opencv_media.h"

#include <stdlib.h>
#include <string.h>

/* No still picture is larger; a file that is cannot be meant. */
#define PICTURE_MAX_BYTES ((size_t)1 << 30)

typedef struct still_file {
    frame_source source;
    byte_reader *reader;
    uint8_t *bytes;  /* one encoded picture */
    size_t size;
    size_t capacity;
    gray_picture picture;
    uint64_t frame_count;
} still_file;

static bool reserve(still_file *file, size_t extra, error_text *error)
{
    if (extra > PICTURE_MAX_BYTES - file->size) {
        error_text_set(error, "picture %llu is larger than %zu bytes", (unsigned long long)file->frame_count,
                       PICTURE_MAX_BYTES);
        return false;
    }
    if (file->size + extra <= file->capacity)
        return true;
    size_t capacity = 2 * (file->size + extra);
    uint8_t *bytes = realloc(file->bytes, capacity);
    if (bytes == NULL) {
        error_text_set(error, "not enough memory for a picture of %zu bytes", file->size + extra);
        return false;
    }
    file->bytes = bytes;
    file->capacity = capacity;
    return true;
}

/* Takes one byte into the picture; -1 at the end, with an error. */
static int take_byte(still_file *file, error_text *error)
{
    if (!reserve(file, 1, error))
        return -1;
    int byte = byte_reader_get(file->reader);
    if (byte >= 0)
        file->bytes[file->size++] = (uint8_t)byte;
    else if (!byte_reader_failed(file->reader, error))
        error_text_set(error, "is cut short: picture %llu ends after %zu bytes",
                       (unsigned long long)file->frame_count, file->size);
    return byte;
}

/* Takes a marker segment after its marker: two bytes of length, which count themselves, and the content. That the
 * content is cut short will be noticed by who asks for the next byte. */
static bool take_segment(still_file *file, error_text *error)
{
    int high = take_byte(file, error);
    int low = high < 0 ? -1 : take_byte(file, error);
    if (low < 0)
        return false;
    size_t length = (size_t)high << 8 | (size_t)low;
    length = length < 2 ? 0 : length - 2;
    if (!reserve(file, length, error))
        return false;
    file->size += byte_reader_read(file->reader, file->bytes + file->size, length);
    return true;
}

/* Takes bytes up to and with the next marker and returns it, -1 on failure. A zero or a restart marker after
 * 0xff belongs to the entropy-coded data; further 0xff are padding. */
static int take_to_marker(still_file *file, error_text *error)
{
    int byte = take_byte(file, error);
    while (byte >= 0) {
        bool after_ff = byte == 0xff;
        byte = take_byte(file, error);
        if (after_ff && byte > 0 && byte != 0xff && (byte < 0xd0 || byte > 0xd7))
            return byte;
    }
    return -1;
}

/* Takes exactly one JPEG, so that pictures that follow one another can be told apart and a missing end is
 * noticed: OpenCV would show gray there and say nothing. */
static bool take_jpeg(still_file *file, error_text *error)
{
    enum { START_OF_IMAGE = 0xd8, END_OF_IMAGE = 0xd9, TEMPORARY = 0x01 };
    file->size = 0;
    for (;;) {
        int marker = take_to_marker(file, error);
        if (marker < 0)
            return false;
        if (marker == END_OF_IMAGE)
            return true;
        if (marker != START_OF_IMAGE && marker != TEMPORARY && !take_segment(file, error))
            return false;
    }
}

static bool decode_picture(still_file *file, frame *output, error_text *error)
{
    gray_picture *picture = &file->picture;
    gray_picture last = *picture;
    if (!opencv_decode_still(file->bytes, file->size, picture, error))
        return false;
    free(last.pixels);
    frame_layout layout = {PIXEL_GREY, picture->width_px, picture->height_px, (size_t)picture->width_px};
    *output = (frame){layout, picture->pixels, file->frame_count++, FRAME_TIME_UNKNOWN};
    return true;
}

static frame_status next_still(frame_source *source, frame *output, error_text *error)
{
    still_file *file = (still_file *)source;
    if (file->frame_count > 0)
        return FRAME_END;
    file->source.frames_expected = 1;
    file->bytes = byte_reader_read_all(file->reader, PICTURE_MAX_BYTES, &file->size, error);
    return file->bytes != NULL && decode_picture(file, output, error) ? FRAME_READY : FRAME_FAILED;
}

/* Cameras and phones put things of their own behind a picture, smaller pictures among them: what is not another
 * JPEG of the first one's size ends the source. */
static frame_status next_jpeg(frame_source *source, frame *output, error_text *error)
{
    still_file *file = (still_file *)source;
    const uint8_t *ahead;
    gray_picture first = file->picture;
    if (byte_reader_peek(file->reader, &ahead, 3) < 3 || memcmp(ahead, "\xff\xd8\xff", 3) != 0)
        return byte_reader_failed(file->reader, error) ? FRAME_FAILED : FRAME_END;
    if (!take_jpeg(file, error) || !decode_picture(file, output, error))
        return FRAME_FAILED;
    bool same_size = file->picture.width_px == first.width_px && file->picture.height_px == first.height_px;
    if (output->sequence > 0 && !same_size)
        return FRAME_END;
    file->source.frames_expected = estimate_frames(file->reader, file->frame_count);
    return FRAME_READY;
}

static void close_file(frame_source *source)
{
    still_file *file = (still_file *)source;
    byte_reader_close(file->reader);
    free(file->bytes);
    free(file->picture.pixels);
    free(file);
}

static frame_source *open_with(const frame_source_methods *methods, byte_reader *reader, error_text *error)
{
    still_file *file = frame_source_new(sizeof *file, methods, reader, error);
    if (file == NULL)
        return NULL;
    file->reader = reader;
    return &file->source;
}

frame_source *jpeg_file_open(byte_reader *reader, error_text *error)
{
    static const frame_source_methods methods = {next_jpeg, close_file};
    return open_with(&methods, reader, error);
}

frame_source *still_file_open(byte_reader *reader, error_text *error)
{
    static const frame_source_methods methods = {next_still, close_file};
    return open_with(&methods, reader, error);
}
