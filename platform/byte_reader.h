/* Buffered reading of a file, pipe or standard input, front to back, with a look ahead and exact counts. */
#ifndef PLATFORM_BYTE_READER_H
#define PLATFORM_BYTE_READER_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct byte_reader byte_reader;

/* path "-" is standard input. Directories are refused. NULL on failure. */
byte_reader *byte_reader_open(const char *path, error_text *error);

/* NULL is fine. */
void byte_reader_close(byte_reader *reader);

/* Size of a regular file; -1 for pipes and devices. */
int64_t byte_reader_size(const byte_reader *reader);

/* Bytes taken so far. */
uint64_t byte_reader_offset(const byte_reader *reader);

enum { BYTE_READER_PEEK_MAX = 256 };

/* Shows up to `wanted` (at most BYTE_READER_PEEK_MAX) of the next bytes without taking them; returns how many
 * there are. */
size_t byte_reader_peek(byte_reader *reader, const uint8_t **bytes, size_t wanted);

/* Takes the next byte; -1 at the end. */
int byte_reader_get(byte_reader *reader);

/* These return how many bytes were read or passed over: fewer than wanted only at the end or on an error. */
size_t byte_reader_read(byte_reader *reader, void *target, size_t wanted);
uint64_t byte_reader_skip(byte_reader *reader, uint64_t wanted);

/* Everything that is left, in malloc'ed memory with a zero byte behind it that *size does not count. NULL when it
 * is more than `most_bytes`, cannot be read or does not fit into memory. */
uint8_t *byte_reader_read_all(byte_reader *reader, size_t most_bytes, size_t *size, error_text *error);

/* True, with the reason, when reading ended because of an error and not at the end of the data. */
bool byte_reader_failed(const byte_reader *reader, error_text *error);

#endif
