/* The TM: bars at both ends, and light or dark blocks between. */
#ifndef TAPEMARK_BARS_H
#define TAPEMARK_BARS_H

#include "segment.h"

/* Lines across the tape, in modules from its middle. The outermost rows are left out: the bottom one is dark in
 * light CMs too, and both are the first to be mixed with what lies beside the tape. */
enum { TMI_LINES = 9 };
extern const float tmi_line_v[TMI_LINES];

/* Where bars may be: beside a finder, whose centre is at u by the map, to the right or to the left. */
typedef struct tmi_bars_place {
    const tmi_homography *map;
    const tmi_finder *finder;
    float u;
    float direction; /* 1 or -1 */
} tmi_bars_place;

/* How much what is there looks like four bars, over the whole height of the tape; at most 1. */
float tmi_bars_score(const tmi_view *view, tmi_bars_place place, uint32_t *reads);

/* The code that most of the `clear` ones are, and its share of all `lines` with bars, of nine at most. */
void tmi_vote(const uint32_t *codes, int clear, int lines, tmi_tm_reading *out);

/* Reads the CMs first..first + count - 1 of the segment, as the row runs, on several lines across the tape. False
 * where there are no bars of that score at both ends. */
bool tmi_tm_read(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float bars_min,
                 tmi_tm_reading *out);

#endif
