/* PGM, binary (P5, one or two bytes a sample) and plain (P2). Pictures may follow one another. */
#include "file_formats.h"

#include <stdlib.h>

typedef struct pgm_file {
    frame_source source;
    byte_reader *reader;
    frame_buffer samples;  /* a row as it stands in the file */
    frame_buffer gray;
    uint64_t frame_count;
} pgm_file;

typedef struct pgm_header {
    bool plain;
    int32_t width_px;
    int32_t height_px;
    unsigned maxval;
} pgm_header;

static bool is_blank(int byte)
{
    return byte == ' ' || (byte >= '\t' && byte <= '\r');
}

/* Takes the rest of a comment; returns the end of line that closes it. */
static int get_after_comment(byte_reader *reader)
{
    int byte;
    do
        byte = byte_reader_get(reader);
    while (byte != '\n' && byte != '\r' && byte >= 0);
    return byte;
}

/* Takes blanks and comments; returns the byte after them, -1 at the end. */
static int get_after_blanks(byte_reader *reader)
{
    int byte = byte_reader_get(reader);
    while (is_blank(byte) || byte == '#') {
        if (byte == '#')
            get_after_comment(reader);
        byte = byte_reader_get(reader);
    }
    return byte;
}

/* A decimal number and the one blank (or comment) after it. Numbers above 65535 come back as 65536. */
static bool get_number(byte_reader *reader, unsigned *number)
{
    int byte = get_after_blanks(reader);
    if (byte < '0' || byte > '9')
        return false;
    unsigned value = 0;
    while (byte >= '0' && byte <= '9') {
        value = value * 10 + (unsigned)(byte - '0');
        if (value > 65536)
            value = 65536;
        byte = byte_reader_get(reader);
    }
    if (byte == '#')
        byte = get_after_comment(reader);
    *number = value;
    return is_blank(byte) || byte < 0;
}

static bool read_header(pgm_file *file, pgm_header *header, error_text *error)
{
    unsigned width, height, maxval;
    if (!get_number(file->reader, &width) || !get_number(file->reader, &height) ||
        !get_number(file->reader, &maxval)) {
        if (!byte_reader_failed(file->reader, error))
            error_text_set(error, "the PGM header of frame %llu is damaged or cut short",
                           (unsigned long long)file->frame_count);
        return false;
    }
    if (width < 1 || width > FRAME_SIDE_MAX_PX || height < 1 || height > FRAME_SIDE_MAX_PX) {
        error_text_set(error, "the PGM header of frame %llu has a side outside 1 to %d px",
                       (unsigned long long)file->frame_count, FRAME_SIDE_MAX_PX);
        return false;
    }
    if ((uint64_t)width * height > FRAME_BYTES_MAX) {
        error_text_set(error, "frame %llu, of %u x %u px, is too large: at most %d MiB are possible",
                       (unsigned long long)file->frame_count, width, height, FRAME_BYTES_MAX >> 20);
        return false;
    }
    if (maxval < 1 || maxval > 65535) {
        error_text_set(error, "the PGM header of frame %llu has a maximum value outside 1 to 65535",
                       (unsigned long long)file->frame_count);
        return false;
    }
    header->width_px = (int32_t)width;
    header->height_px = (int32_t)height;
    header->maxval = maxval;
    return true;
}

static uint8_t scale_sample(unsigned sample, unsigned maxval)
{
    unsigned scaled = sample < maxval ? (sample * 255u + maxval / 2) / maxval : 255;
    return (uint8_t)scaled;
}

static bool read_plain_row(pgm_file *file, const pgm_header *header, uint8_t *gray, error_text *error)
{
    for (int32_t x = 0; x < header->width_px; x++) {
        unsigned sample;
        if (!get_number(file->reader, &sample)) {
            if (!byte_reader_failed(file->reader, error))
                error_text_set(error, "the pixels of frame %llu are damaged or cut short",
                               (unsigned long long)file->frame_count);
            return false;
        }
        gray[x] = scale_sample(sample, header->maxval);
    }
    return true;
}

static bool read_wide_row(pgm_file *file, const pgm_header *header, uint8_t *gray, error_text *error)
{
    const uint8_t *samples = file->samples.bytes;
    if (!read_frame_bytes(file->reader, file->samples.bytes, 2 * (size_t)header->width_px, file->frame_count, error))
        return false;
    for (int32_t x = 0; x < header->width_px; x++)
        gray[x] = scale_sample((unsigned)samples[2 * x] << 8 | samples[2 * x + 1], header->maxval);
    return true;
}

static bool read_narrow_row(pgm_file *file, const pgm_header *header, uint8_t *gray, error_text *error)
{
    if (!read_frame_bytes(file->reader, gray, (size_t)header->width_px, file->frame_count, error))
        return false;
    for (int32_t x = 0; header->maxval != 255 && x < header->width_px; x++)
        gray[x] = scale_sample(gray[x], header->maxval);
    return true;
}

static bool read_pixels(pgm_file *file, const pgm_header *header, error_text *error)
{
    size_t width = (size_t)header->width_px;
    size_t sample_bytes = header->maxval > 255 ? 2 : 1;
    uint64_t least_bytes = (uint64_t)width * (uint64_t)header->height_px * sample_bytes;

    if (!check_bytes_left(file->reader, least_bytes, file->frame_count, error) ||
        !frame_buffer_resize(&file->samples, 2 * width, error) ||
        !frame_buffer_resize(&file->gray, width * (size_t)header->height_px, error))
        return false;
    for (int32_t y = 0; y < header->height_px; y++) {
        uint8_t *row = file->gray.bytes + (size_t)y * width;
        bool done = header->plain       ? read_plain_row(file, header, row, error)
                    : sample_bytes == 2 ? read_wide_row(file, header, row, error)
                                        : read_narrow_row(file, header, row, error);
        if (!done)
            return false;
    }
    return true;
}

/* Takes the two letters that begin a picture. Blanks before them are let pass: some writers end a file so. */
static frame_status read_magic(pgm_file *file, pgm_header *header, error_text *error)
{
    int byte = byte_reader_get(file->reader);
    while (is_blank(byte))
        byte = byte_reader_get(file->reader);
    if (byte < 0)
        return byte_reader_failed(file->reader, error) ? FRAME_FAILED : FRAME_END;
    int kind = byte_reader_get(file->reader);
    if (byte != 'P' || (kind != '5' && kind != '2')) {
        error_text_set(error, "after %llu frames comes something that is no PGM",
                       (unsigned long long)file->frame_count);
        return FRAME_FAILED;
    }
    header->plain = kind == '2';
    return FRAME_READY;
}

static frame_status next_frame(frame_source *source, frame *output, error_text *error)
{
    pgm_file *file = (pgm_file *)source;
    pgm_header header;
    frame_status status = read_magic(file, &header, error);
    if (status != FRAME_READY)
        return status;
    if (!read_header(file, &header, error) || !read_pixels(file, &header, error))
        return FRAME_FAILED;

    frame_layout layout = {PIXEL_GREY, header.width_px, header.height_px, (size_t)header.width_px};
    *output = (frame){layout, file->gray.bytes, file->frame_count++, FRAME_TIME_UNKNOWN};
    file->source.frames_expected = estimate_frames(file->reader, file->frame_count);
    return FRAME_READY;
}

static void close_file(frame_source *source)
{
    pgm_file *file = (pgm_file *)source;
    byte_reader_close(file->reader);
    free(file->samples.bytes);
    free(file->gray.bytes);
    free(file);
}

static const frame_source_methods methods = {next_frame, close_file};

frame_source *pgm_file_open(byte_reader *reader, error_text *error)
{
    pgm_file *file = frame_source_new(sizeof *file, &methods, reader, error);
    if (file == NULL)
        return NULL;
    file->reader = reader;
    return &file->source;
}
