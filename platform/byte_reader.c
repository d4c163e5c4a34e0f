#include "byte_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BUFFER_BYTES = 1 << 16 };

struct byte_reader {
    int descriptor;
    int read_errno;  /* 0 while all is well */
    bool at_end;
    int64_t size_bytes;
    uint64_t taken_bytes;
    size_t begin;  /* buffer[begin .. end) is read ahead */
    size_t end;
    uint8_t buffer[BUFFER_BYTES];
};

static bool open_descriptor(byte_reader *reader, const char *path, error_text *error)
{
    struct stat status;
    reader->descriptor = strcmp(path, "-") == 0 ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (reader->descriptor < 0 || fstat(reader->descriptor, &status) != 0) {
        error_text_set(error, "cannot be opened: %s", strerror(errno));
        return false;
    }
    if (S_ISDIR(status.st_mode)) {
        error_text_set(error, "is a directory, not a file");
        return false;
    }
    reader->size_bytes = S_ISREG(status.st_mode) ? (int64_t)status.st_size : -1;
    return true;
}

byte_reader *byte_reader_open(const char *path, error_text *error)
{
    byte_reader *reader = calloc(1, sizeof *reader);
    if (reader == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    if (!open_descriptor(reader, path, error)) {
        byte_reader_close(reader);
        return NULL;
    }
    return reader;
}

void byte_reader_close(byte_reader *reader)
{
    if (reader != NULL && reader->descriptor > STDIN_FILENO)
        close(reader->descriptor);
    free(reader);
}

int64_t byte_reader_size(const byte_reader *reader)
{
    return reader->size_bytes;
}

uint64_t byte_reader_offset(const byte_reader *reader)
{
    return reader->taken_bytes;
}

static size_t read_some(byte_reader *reader, uint8_t *target, size_t wanted)
{
    if (reader->at_end)
        return 0;
    ssize_t got;
    do
        got = read(reader->descriptor, target, wanted);
    while (got < 0 && errno == EINTR);
    if (got < 0)
        reader->read_errno = errno;
    if (got <= 0) {
        reader->at_end = true;
        return 0;
    }
    return (size_t)got;
}

size_t byte_reader_peek(byte_reader *reader, const uint8_t **bytes, size_t wanted)
{
    if (reader->end - reader->begin < wanted) {
        memmove(reader->buffer, reader->buffer + reader->begin, reader->end - reader->begin);
        reader->end -= reader->begin;
        reader->begin = 0;
        size_t got = 1;
        while (reader->end < wanted && got > 0) {
            got = read_some(reader, reader->buffer + reader->end, BUFFER_BYTES - reader->end);
            reader->end += got;
        }
    }
    *bytes = reader->buffer + reader->begin;
    size_t there = reader->end - reader->begin;
    return there < wanted ? there : wanted;
}

/* Reads ahead when nothing is buffered; false at the end. */
static bool something_buffered(byte_reader *reader)
{
    if (reader->begin == reader->end) {
        reader->begin = 0;
        reader->end = read_some(reader, reader->buffer, BUFFER_BYTES);
    }
    return reader->end > 0;
}

int byte_reader_get(byte_reader *reader)
{
    if (!something_buffered(reader))
        return -1;
    reader->taken_bytes++;
    return reader->buffer[reader->begin++];
}

static size_t take_buffered(byte_reader *reader, size_t wanted)
{
    size_t there = reader->end - reader->begin;
    size_t taken = there < wanted ? there : wanted;
    reader->begin += taken;
    reader->taken_bytes += taken;
    return taken;
}

size_t byte_reader_read(byte_reader *reader, void *target, size_t wanted)
{
    const uint8_t *buffered = reader->buffer + reader->begin;
    size_t done = take_buffered(reader, wanted);
    memcpy(target, buffered, done);

    size_t got = 1;
    while (done < wanted && got > 0) {
        /* Straight into place: frames are not copied twice. */
        got = read_some(reader, (uint8_t *)target + done, wanted - done);
        reader->taken_bytes += got;
        done += got;
    }
    return done;
}

/* Jumps over what lies beyond the buffer where a file allows it; returns how many bytes that saved reading. */
static uint64_t seek_ahead(byte_reader *reader, uint64_t wanted)
{
    if (reader->size_bytes < 0 || wanted < BUFFER_BYTES)
        return 0;
    off_t here = lseek(reader->descriptor, 0, SEEK_CUR);
    if (here < 0 || here >= reader->size_bytes)
        return 0;
    uint64_t left = (uint64_t)(reader->size_bytes - here);
    uint64_t jump = wanted < left ? wanted : left;
    if (lseek(reader->descriptor, (off_t)jump, SEEK_CUR) < 0)
        return 0;
    reader->taken_bytes += jump;
    return jump;
}

uint64_t byte_reader_skip(byte_reader *reader, uint64_t wanted)
{
    uint64_t done = take_buffered(reader, wanted < BUFFER_BYTES ? (size_t)wanted : BUFFER_BYTES);
    done += seek_ahead(reader, wanted - done);
    while (done < wanted && something_buffered(reader)) {
        uint64_t left = wanted - done;
        done += take_buffered(reader, left < BUFFER_BYTES ? (size_t)left : BUFFER_BYTES);
    }
    return done;
}

static bool grow_by_half(uint8_t **bytes, size_t *capacity)
{
    size_t larger = *capacity + *capacity / 2 + BUFFER_BYTES;
    uint8_t *moved = realloc(*bytes, larger);
    if (moved == NULL)
        return false;
    *bytes = moved;
    *capacity = larger;
    return true;
}

uint8_t *byte_reader_read_all(byte_reader *reader, size_t most_bytes, size_t *size, error_text *error)
{
    uint8_t *bytes = NULL;
    size_t capacity = 0;
    *size = 0;
    do {
        if (!grow_by_half(&bytes, &capacity)) {
            error_text_set(error, "not enough memory to read it whole");
            free(bytes);
            return NULL;
        }
        *size += byte_reader_read(reader, bytes + *size, capacity - 1 - *size);
    } while (*size == capacity - 1 && *size <= most_bytes);

    if (*size > most_bytes)
        error_text_set(error, "is larger than %zu MB", most_bytes >> 20);
    if (*size > most_bytes || byte_reader_failed(reader, error)) {
        free(bytes);
        return NULL;
    }
    bytes[*size] = 0;
    return bytes;
}

bool byte_reader_failed(const byte_reader *reader, error_text *error)
{
    if (reader->read_errno == 0)
        return false;
    error_text_set(error, "cannot be read: %s", strerror(reader->read_errno));
    return true;
}
