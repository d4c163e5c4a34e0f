/* The TM: bars at both ends, and light or dark blocks between. */
#ifndef TAPEMARK_BARS_H
#define TAPEMARK_BARS_H

#include "segment.h"

typedef struct tmi_tm_reading {
    uint32_t code; /* the first CM's bit highest */
    float vote;    /* share of the lines with bars at both ends that agree on the code */
    float bars;    /* correlation of the weaker end with ideal bars */
} tmi_tm_reading;

/* Where bars may be: beside a finder, whose centre is at u by the map, to the right or to the left. */
typedef struct tmi_bars_place {
    const tmi_homography *map;
    const tmi_finder *finder;
    float u;
    float direction; /* 1 or -1 */
} tmi_bars_place;

/* How much what is there looks like four bars, over the whole height of the tape; at most 1. */
float tmi_bars_score(const tmi_view *view, tmi_bars_place place, uint32_t *reads);

/* Reads the CMs first..first + count - 1 of the segment, as the row runs, on several lines across the tape. False
 * where there are no bars of that score at both ends. */
bool tmi_tm_read(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float bars_min,
                 tmi_tm_reading *out);

#endif
