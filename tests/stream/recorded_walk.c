#include "recorded_walk.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH_PX = 480, HEIGHT_PX = 270, FRAME_BYTES = WIDTH_PX * HEIGHT_PX };

static const char frame_head[] = "FRAME\n";
enum { HEAD_BYTES = sizeof frame_head - 1 };

static bool read_whole(const char *path, uint8_t **bytes, size_t *size)
{
    FILE *file = fopen(path, "rb");
    long end = -1;
    *bytes = NULL;
    *size = 0;
    if (file != NULL && fseek(file, 0, SEEK_END) == 0 && (end = ftell(file)) >= 0)
        *bytes = malloc((size_t)end + 1);
    if (*bytes != NULL) {
        rewind(file);
        *size = fread(*bytes, 1, (size_t)end, file);
        (*bytes)[*size] = '\0';
    }
    if (file != NULL)
        fclose(file);
    return *bytes != NULL && *size == (size_t)end;
}

/* Behind the first line feed. */
static size_t behind_line(const uint8_t *bytes, size_t size)
{
    const uint8_t *end = size > 0 ? memchr(bytes, '\n', size) : NULL;
    return end != NULL ? (size_t)(end - bytes) + 1 : size;
}

bool recorded_walk_read(recorded_walk *walk, const char *path)
{
    if (!read_whole(path, &walk->bytes, &walk->size))
        return false;
    walk->begin = behind_line(walk->bytes, walk->size);
    walk->frame_count = (walk->size - walk->begin) / (HEAD_BYTES + FRAME_BYTES);
    return walk->frame_count > 0;
}

void recorded_walk_release(recorded_walk *walk)
{
    free(walk->bytes);
    *walk = (recorded_walk){NULL, 0, 0, 0};
}

static bool is_frame(const recorded_walk *walk, const uint8_t *pixels, unsigned long long sequence)
{
    const size_t index = (size_t)((sequence - 1) % walk->frame_count);
    return memcmp(pixels, walk->bytes + walk->begin + index * (HEAD_BYTES + FRAME_BYTES) + HEAD_BYTES,
                  FRAME_BYTES) == 0;
}

/* Goes through lines of times and frames side by side. */
static bool compare(const recorded_walk *walk, const uint8_t *at, size_t left, size_t head_bytes, const char *times,
                    recorded_walk_state *state)
{
    unsigned long long sequence, first = 0, last = 0;
    const char *end;
    while ((end = strchr(times, '\n')) != NULL && left >= head_bytes + FRAME_BYTES) {
        if (sscanf(times, "%llu ", &sequence) != 1 || sequence <= last || memcmp(at, frame_head, head_bytes) != 0 ||
            !is_frame(walk, at + head_bytes, sequence))
            return false;
        first = first == 0 ? sequence : first;
        last = sequence;
        at += head_bytes + FRAME_BYTES;
        left -= head_bytes + FRAME_BYTES;
        times = end + 1;
        state->frames++;
    }
    state->span = last - first + (last > 0);
    state->cut = left > 0 || *times != '\0';
    return true;
}

bool recorded_walk_look(const recorded_walk *walk, const char *path, recorded_walk_state *state)
{
    char times_path[300];
    uint8_t *frames, *times;
    size_t size, times_size;
    const size_t length = strlen(path);
    const bool y4m = length > 4 && strcmp(path + length - 4, ".y4m") == 0;
    bool right = true;
    *state = (recorded_walk_state){.frames = 0};
    snprintf(times_path, sizeof times_path, "%s.times", path);
    if (read_whole(path, &frames, &size) && read_whole(times_path, &times, &times_size)) {
        const size_t begin = y4m ? behind_line(frames, size) : 0;
        const size_t times_begin = behind_line(times, times_size);
        right = compare(walk, frames + begin, size - begin, y4m ? HEAD_BYTES : 0, (const char *)times + times_begin,
                        state);
        free(times);
    }
    free(frames);
    return right;
}
