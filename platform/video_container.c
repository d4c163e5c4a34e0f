#include "video_container.h"

#include "byte_reader.h"

#include <string.h>

static bool has_at(const uint8_t *bytes, size_t size, size_t offset, const char *magic)
{
    size_t length = strlen(magic);
    return size >= offset + length && memcmp(bytes + offset, magic, length) == 0;
}

static bool is_transport_stream(const uint8_t *bytes, size_t size)
{
    return size > 188 && bytes[0] == 0x47 && bytes[188] == 0x47;
}

static bool is_mp4_box(const uint8_t *bytes, size_t size)
{
    static const char *const boxes[] = {"ftyp", "moov", "mdat", "wide", "free", "skip", "uuid", "moof", "mfra",
                                        "meta", "styp", "sidx", "udta", "pnot"};
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++)
        if (has_at(bytes, size, 4, boxes[i]))
            return true;
    return false;
}

video_container video_container_of(const uint8_t *bytes, size_t size)
{
    if (is_mp4_box(bytes, size))
        return VIDEO_MP4;
    if (has_at(bytes, size, 0, "RIFF") && has_at(bytes, size, 8, "AVI "))
        return VIDEO_RIFF;
    if (has_at(bytes, size, 0, "\x1a\x45\xdf\xa3") ||  /* Matroska, WebM */
        has_at(bytes, size, 0, "OggS") || has_at(bytes, size, 0, "FLV\x01") || has_at(bytes, size, 0, "GIF8") ||
        has_at(bytes, size, 0, "\x30\x26\xb2\x75") ||  /* ASF, WMV */
        (size >= 4 && memcmp(bytes, "\0\0\1\xba", 4) == 0) ||  /* MPEG program stream */
        (size >= 4 && memcmp(bytes, "\0\0\0\1", 4) == 0) ||    /* bare H.264 or H.265 */
        is_transport_stream(bytes, size))
        return VIDEO_OTHER;
    return VIDEO_UNKNOWN;
}

static uint64_t big_endian(const uint8_t *bytes, size_t count)
{
    uint64_t value = 0;
    for (size_t i = 0; i < count; i++)
        value = value << 8 | bytes[i];
    return value;
}

/* Size of the top-level part that begins with these bytes, its header included; 0 when it goes on to the end of
 * the file or is no part. */
static uint64_t part_size(video_container container, const uint8_t *bytes, size_t size)
{
    if (size < 8)
        return 0;
    if (container == VIDEO_RIFF) {
        uint64_t content = bytes[4] | (uint64_t)bytes[5] << 8 | (uint64_t)bytes[6] << 16 | (uint64_t)bytes[7] << 24;
        return has_at(bytes, size, 0, "RIFF") ? 8 + content + content % 2 : 0;
    }
    if (!is_mp4_box(bytes, size))
        return 0;
    uint64_t box = big_endian(bytes, 4);
    if (box == 1)
        box = size >= 16 ? big_endian(bytes + 8, 8) : 0;
    return box >= 8 ? box : 0;
}

bool video_is_cut_short(const char *path, error_text *error)
{
    const uint8_t *bytes;
    error_text ignored;
    bool cut_short = false;
    byte_reader *reader = byte_reader_open(path, &ignored);
    if (reader == NULL)
        return false;

    size_t size = byte_reader_peek(reader, &bytes, BYTE_READER_PEEK_MAX);
    video_container container = video_container_of(bytes, size);
    while (!cut_short && (container == VIDEO_MP4 || container == VIDEO_RIFF)) {
        size = byte_reader_peek(reader, &bytes, BYTE_READER_PEEK_MAX);
        uint64_t wanted = part_size(container, bytes, size);
        if (wanted == 0)
            break;
        uint64_t got = byte_reader_skip(reader, wanted);
        if (got < wanted) {
            error_text_set(error, "is cut short: %llu bytes are missing", (unsigned long long)(wanted - got));
            cut_short = true;
        }
    }
    byte_reader_close(reader);
    return cut_short;
}
