/* The readers behind frame_source_open_file(), one file each. Each takes over the byte reader, also when it
 * fails. */
#ifndef PLATFORM_FILE_FORMATS_H
#define PLATFORM_FILE_FORMATS_H

#include "byte_reader.h"
#include "frame_source.h"

frame_source *raw_file_open(byte_reader *reader, const frame_layout *layout, error_text *error);
frame_source *pgm_file_open(byte_reader *reader, error_text *error);
frame_source *y4m_file_open(byte_reader *reader, error_text *error);

/* A row of JPEGs of one size (Motion JPEG) gives one frame each. */
frame_source *jpeg_file_open(byte_reader *reader, error_text *error);

/* One picture in any other format that OpenCV reads. */
frame_source *still_file_open(byte_reader *reader, error_text *error);

/* What the readers share: the memory of the frame given last. */
typedef struct frame_buffer {
    uint8_t *bytes;
    size_t size;
} frame_buffer;

/* Makes room for `size` bytes; the content is lost. */
bool frame_buffer_resize(frame_buffer *buffer, size_t size, error_text *error);

/* Reads exactly `wanted` bytes into `target`; else tells that this frame is cut short or unreadable. */
bool read_frame_bytes(byte_reader *reader, void *target, size_t wanted, uint64_t frame_number, error_text *error);

/* False, with an error, when a regular file holds fewer than `wanted` further bytes: so that no header can make
 * a reader reserve memory for pixels that are not there. */
bool check_bytes_left(const byte_reader *reader, uint64_t wanted, uint64_t frame_number, error_text *error);

/* How many frames a regular file holds when the first ones took what has been read so far. */
uint64_t estimate_frames(const byte_reader *reader, uint64_t frames_read);

/* Allocates a source of a derived kind, zeroed; closes the reader when that fails. */
void *frame_source_new(size_t size, const frame_source_methods *methods, byte_reader *reader, error_text *error);

#endif
