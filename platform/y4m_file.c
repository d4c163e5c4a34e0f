/* YUV4MPEG2, the uncompressed video that camera tools and ffmpeg write. Only the luma is kept. */
#include "file_formats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_BYTES = 1024, HEADER_TAG_BYTES = 9 };

typedef struct y4m_file {
    frame_source source;
    byte_reader *reader;
    frame_layout layout;
    frame_buffer luma;
    uint64_t chroma_bytes;
    unsigned long rate_numerator;
    unsigned long rate_denominator;
    uint64_t frame_count;
} y4m_file;

/* How often the width and the height of the luma plane are halved for a chroma plane, and how many of those
 * there are. */
typedef struct chroma_scheme {
    const char *name;
    uint8_t width_halvings;
    uint8_t height_halvings;
    uint8_t planes;
} chroma_scheme;

/* The first match counts: longer names stand before their beginnings. */
static const chroma_scheme schemes[] = {
    {"mono", 0, 0, 0},    {"420jpeg", 1, 1, 2},  {"420mpeg2", 1, 1, 2}, {"420paldv", 1, 1, 2}, {"420", 1, 1, 2},
    {"422", 1, 0, 2},     {"444alpha", 0, 0, 3}, {"444", 0, 0, 2},      {"411", 2, 0, 2},
};

/* Bits of a sample after the name of the scheme: "420p10", "mono10". */
static bool parse_depth(const char *text, pixel_format *format)
{
    static const struct {
        const char *text;
        pixel_format format;
    } depths[] = {{"", PIXEL_GREY}, {"10", PIXEL_Y10}, {"12", PIXEL_Y12}, {"16", PIXEL_Y16}};

    if (*text == 'p')
        text++;
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        if (strcmp(text, depths[i].text) == 0) {
            *format = depths[i].format;
            return true;
        }
    }
    return false;
}

static bool parse_colour(y4m_file *file, const char *text, const chroma_scheme **scheme, error_text *error)
{
    for (size_t i = 0; i < sizeof schemes / sizeof *schemes; i++) {
        size_t length = strlen(schemes[i].name);
        if (strncmp(text, schemes[i].name, length) == 0 && parse_depth(text + length, &file->layout.format)) {
            *scheme = &schemes[i];
            return true;
        }
    }
    error_text_set(error, "has the Y4M colour space '%.20s'; known are mono, 420, 422, 444, 411, each with 8, 10, "
                   "12 or 16 bits", text);
    return false;
}

static bool parse_side(const char *text, int32_t *side_px, error_text *error)
{
    char *end;
    unsigned long side = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end != '\0' || side < 1 || side > FRAME_SIDE_MAX_PX) {
        error_text_set(error, "the Y4M header has a side of '%.20s' px, not 1 to %d", text, FRAME_SIDE_MAX_PX);
        return false;
    }
    *side_px = (int32_t)side;
    return true;
}

static bool parse_field(y4m_file *file, const char *field, const chroma_scheme **scheme, error_text *error)
{
    const char *value = field + 1;
    switch (field[0]) {
    case 'W':
        return parse_side(value, &file->layout.width_px, error);
    case 'H':
        return parse_side(value, &file->layout.height_px, error);
    case 'C':
        return parse_colour(file, value, scheme, error);
    case 'F':
        if (sscanf(value, "%9lu:%9lu", &file->rate_numerator, &file->rate_denominator) != 2)
            file->rate_numerator = 0;
        return true;
    case 'I':
        if (value[0] != 'p' && value[0] != '?') {
            error_text_set(error, "is interlaced Y4M; only progressive frames can be read");
            return false;
        }
        return true;
    default:
        return true;
    }
}

/* Reads up to the line feed, which is dropped; false when there is none within `size` bytes. */
static bool read_line(byte_reader *reader, char *line, size_t size)
{
    for (size_t length = 0; length < size; length++) {
        int byte = byte_reader_get(reader);
        if (byte < 0)
            return false;
        if (byte == '\n') {
            line[length] = '\0';
            return true;
        }
        line[length] = (char)byte;
    }
    return false;
}

static uint64_t halve(int32_t side_px, unsigned times)
{
    return ((uint64_t)side_px + (1u << times) - 1) >> times;
}

static bool read_header(y4m_file *file, error_text *error)
{
    char line[LINE_MAX_BYTES];
    const chroma_scheme *scheme = &schemes[1];
    char *rest = line + HEADER_TAG_BYTES;

    if (!read_line(file->reader, line, sizeof line)) {
        if (!byte_reader_failed(file->reader, error))
            error_text_set(error, "the Y4M header is damaged or cut short");
        return false;
    }
    for (char *field = strtok_r(rest, " ", &rest); field != NULL; field = strtok_r(NULL, " ", &rest))
        if (!parse_field(file, field, &scheme, error))
            return false;

    frame_layout *layout = &file->layout;
    if (layout->width_px == 0 || layout->height_px == 0) {
        error_text_set(error, "the Y4M header lacks the width (W) or the height (H)");
        return false;
    }
    size_t sample_bytes = layout->format == PIXEL_GREY ? 1 : 2;
    layout->stride_bytes = (size_t)layout->width_px * sample_bytes;
    if (frame_layout_size_bytes(layout) == 0) {
        error_text_set(error, "frames of %d x %d px are too large: at most %d MiB are possible", layout->width_px,
                       layout->height_px, FRAME_BYTES_MAX >> 20);
        return false;
    }
    file->chroma_bytes = halve(layout->width_px, scheme->width_halvings) *
                         halve(layout->height_px, scheme->height_halvings) * scheme->planes * sample_bytes;
    return true;
}

static frame_status read_frame_header(y4m_file *file, error_text *error)
{
    char line[LINE_MAX_BYTES];
    const uint8_t *ahead;
    if (byte_reader_peek(file->reader, &ahead, 1) == 0)
        return byte_reader_failed(file->reader, error) ? FRAME_FAILED : FRAME_END;
    if (!read_line(file->reader, line, sizeof line) || strncmp(line, "FRAME", 5) != 0 ||
        (line[5] != '\0' && line[5] != ' ')) {
        if (!byte_reader_failed(file->reader, error))
            error_text_set(error, "the Y4M header of frame %llu is damaged or cut short",
                           (unsigned long long)file->frame_count);
        return FRAME_FAILED;
    }
    return FRAME_READY;
}

static bool read_planes(y4m_file *file, error_text *error)
{
    size_t luma_bytes = frame_layout_size_bytes(&file->layout);
    if (!check_bytes_left(file->reader, luma_bytes + file->chroma_bytes, file->frame_count, error) ||
        !frame_buffer_resize(&file->luma, luma_bytes, error) ||
        !read_frame_bytes(file->reader, file->luma.bytes, luma_bytes, file->frame_count, error))
        return false;
    uint64_t passed = byte_reader_skip(file->reader, file->chroma_bytes);
    if (passed == file->chroma_bytes)
        return true;
    if (!byte_reader_failed(file->reader, error))
        error_text_set(error, "is cut short: the chroma of frame %llu ends after %llu of %llu bytes",
                       (unsigned long long)file->frame_count, (unsigned long long)passed,
                       (unsigned long long)file->chroma_bytes);
    return false;
}

static int64_t frame_time_ns(const y4m_file *file)
{
    if (file->rate_numerator == 0)
        return FRAME_TIME_UNKNOWN;
    double seconds = (double)file->frame_count * (double)file->rate_denominator / (double)file->rate_numerator;
    return seconds < 9e9 ? (int64_t)(seconds * 1e9 + 0.5) : FRAME_TIME_UNKNOWN;
}

static frame_status next_frame(frame_source *source, frame *output, error_text *error)
{
    y4m_file *file = (y4m_file *)source;
    frame_status status = read_frame_header(file, error);
    if (status != FRAME_READY)
        return status;
    if (!read_planes(file, error))
        return FRAME_FAILED;
    *output = (frame){file->layout, file->luma.bytes, file->frame_count, frame_time_ns(file)};
    file->frame_count++;
    file->source.frames_expected = estimate_frames(file->reader, file->frame_count);
    return FRAME_READY;
}

static void close_file(frame_source *source)
{
    y4m_file *file = (y4m_file *)source;
    byte_reader_close(file->reader);
    free(file->luma.bytes);
    free(file);
}

static const frame_source_methods methods = {next_frame, close_file};

frame_source *y4m_file_open(byte_reader *reader, error_text *error)
{
    y4m_file *file = frame_source_new(sizeof *file, &methods, reader, error);
    if (file == NULL)
        return NULL;
    file->reader = reader;
    if (!read_header(file, error)) {
        close_file(&file->source);
        return NULL;
    }
    return &file->source;
}
