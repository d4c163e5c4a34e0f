/* Whether a recording, however it ended, holds frames of data/walk.y4m and nothing else. */
#ifndef RECORDED_WALK_H
#define RECORDED_WALK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct recorded_walk {
    uint8_t *bytes;        /* of walk.y4m */
    size_t size;
    size_t begin;          /* of its first frame's head */
    size_t frame_count;
} recorded_walk;

typedef struct recorded_walk_state {
    unsigned frames;       /* whole ones, with their times */
    uint64_t span;         /* from the first one's number to the last one's, both included */
    bool cut;              /* more of a frame, or of a line of times, follows */
} recorded_walk_state;

bool recorded_walk_read(recorded_walk *walk, const char *path);

/* Looks at a recording and the times beside it. One that is not there holds nothing. False when a whole frame is not
 * the one of its number, or numbers do not ascend. */
bool recorded_walk_look(const recorded_walk *walk, const char *path, recorded_walk_state *state);

void recorded_walk_release(recorded_walk *walk);

#endif
