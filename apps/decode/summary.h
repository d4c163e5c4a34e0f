/* What a whole run read, told at its end. */
#ifndef DECODE_SUMMARY_H
#define DECODE_SUMMARY_H

#include "error_text.h"
#include "tapemark.h"

#include <stdio.h>

enum { SUMMARY_LIMITS = 6 };

typedef struct summary {
    uint64_t frames;
    uint64_t frames_read;  /* with at least one marker */
    uint64_t cms;
    uint64_t tms;
    uint64_t distinct_ids;
    uint8_t *ids_seen;  /* a bit an id, from -TAPEMARK_MAX_ID on */
    uint32_t *times_us;
    size_t time_capacity;
    uint64_t limit_frames[SUMMARY_LIMITS];  /* frames in which each limit was hit */
} summary;

bool summary_init(summary *total, error_text *error);
void summary_release(summary *total);

/* Adds a frame; false when memory runs out. */
bool summary_add(summary *total, const tapemark_result *result, uint32_t decode_us, error_text *error);

/* A line, and a second one when limits were hit; there must have been a frame. Sorts the times. */
void summary_print(summary *total, FILE *stream);

#endif
