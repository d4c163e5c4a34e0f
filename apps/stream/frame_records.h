/* What was read in a frame as the records that tell of it, in the order in which they are sent. */
#ifndef STREAM_FRAME_RECORDS_H
#define STREAM_FRAME_RECORDS_H

#include "frame_reader.h"
#include "settings.h"
#include "tapemark_sender.h"

/* FRAME, and a marker's own record and its PLACE for each. */
enum { FRAME_RECORDS_MAX = 1 + 2 * MARKERS_MAX };

typedef struct frame_records {
    tapemark_record records[FRAME_RECORDS_MAX];  /* the first is the FRAME */
    size_t count;
    int64_t capture_ns;                          /* FRAME_TIME_UNKNOWN where there is none */
} frame_records;

/* What is known of a frame beyond what was read in it. */
typedef struct frame_circumstances {
    uint16_t seq;
    int64_t capture_ns;  /* or FRAME_TIME_UNKNOWN */
    bool replayed;
    bool map_broken;
    uint8_t markers_max;
} frame_circumstances;

/* `map` may be NULL. */
void frame_records_of_reading(const frame_reading *reading, const tapemark_map *map,
                              const frame_circumstances *about, frame_records *output);

/* A FRAME that says that there is no camera. */
void frame_records_of_loss(const frame_circumstances *about, frame_records *output);

/* Sets what is only known at the moment when the first byte leaves. */
void frame_records_stamp(frame_records *records, int64_t now_ns, uint32_t dropped);

#endif
