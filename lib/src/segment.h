/* A row of finder patterns read as a segment: its CMs, and the TM that it may be. */
#ifndef TAPEMARK_SEGMENT_H
#define TAPEMARK_SEGMENT_H

#include "marker.h"
#include "tape.h"

/* What reading a segment needs and adds to. */
typedef struct tmi_reader {
    const tmi_view *view;
    const tapemark_config *config; /* defaults filled in */
    tapemark_result *result;
    uint64_t work_max; /* what is spent in vain goes on no longer than until stats->work has reached this */
    tmi_words words;
    tmi_point upright; /* direction in which upright tapes read, by the caller's hint; a unit vector */
    tmi_cells *kept;   /* room for the cells of the segment's first CMs as they were read, */
    int kept_max;      /* and of how many: of the others they are sampled again when they are needed */
} tmi_reader;

/* Memory for one segment at a time; too large for the stack of a microcontroller. */
typedef struct tmi_segment {
    tmi_finder finders[TMI_MAX_CHAIN];
    tmi_homography maps[TAPEMARK_TM_MAX_CMS];
    tmi_reading readings[2][TAPEMARK_TM_MAX_CMS]; /* as the row runs, and standing on the head */
} tmi_segment;

enum { TMI_UPRIGHT = 0, TMI_TURNED = 1 };

/* Comparing cells with what all words share, both ways up, costs as much as this many pixel reads. */
enum { TMI_BLANK_WORK = 250 };

/* Whether there is work left; notes the limit where there is none. */
bool tmi_may_go_on(const tmi_reader *reader);

/* Reads the CM in the place where its map has it, both ways up. */
void tmi_segment_read_cm(const tmi_reader *reader, tmi_segment *segment, int cm);

typedef struct tmi_tm_reading {
    uint32_t code; /* the first CM's bit highest */
    float vote;    /* share of the lines with bars at both ends that agree on the code */
    float bars;    /* correlation of the weaker end with ideal bars */
} tmi_tm_reading;

/* Reads a row of CMs located as a whole, whose finders and maps are in the segment. `tm` is NULL where it has no
 * bars; `turn` is which way up its blocks say it is, or 0; `resolved`: whether words may be told from each other. */
void tmi_segment_read_far(const tmi_reader *reader, tmi_segment *segment, int cm_count, const tmi_tm_reading *tm,
                          float turn, bool resolved);

/* Reads the segments of a row of `finder_count` finders already copied to segment->finders, and appends what is sure
 * to the result. Of a row that goes on, the last segment may not be whole yet: its finders, and how many they are is
 * returned, are moved to the front, to be read with what follows. A segment too long for that is cut. */
int tmi_segment_read(const tmi_reader *reader, tmi_segment *segment, int finder_count, bool goes_on);

#endif
