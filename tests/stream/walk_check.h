/* Whether records are those of a recording that is played over and over, such as data/walk.y4m, and nothing else.
 * Records may be missing: where nothing explains it, that is counted. */
#ifndef WALK_CHECK_H
#define WALK_CHECK_H

#include "truth.h"

enum { WALK_FRAMES = 24 };  /* of data/walk.y4m */

typedef struct walk_check {
    const truth *walk;
    uint64_t frames, cms, tms, places;
    uint64_t wrong;       /* records that say what is not so */
    uint64_t misplaced;   /* records of what is in view, but not quite there */
    uint64_t incomplete;  /* frames of which records are missing */
    uint64_t lost;        /* FRAMEs of a camera that gives nothing, as when the machine stands still for long */
    uint64_t dropped;     /* frames, as FRAMEs tell */
    uint64_t spoiled;     /* frames whose FRAME did not come, and which harm explains that */
    uint64_t unexplained; /* likewise, without any harm */
    bool harmed;          /* for the caller to set when the line was done harm to; until the next FRAME */
    uint64_t position;    /* of the last FRAME in the endless walk, from 1 */
    uint16_t seq;
    unsigned expected;    /* records of the last FRAME that are still to come */
    char complaint[200];  /* about the first wrong one */
} walk_check;

void walk_check_record(walk_check *check, const tapemark_record *record);

#endif
