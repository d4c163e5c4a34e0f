/* Tapes: which finder patterns follow each other at the distance of a CM, and where the ones are that the scan
 * lines missed. */
#ifndef TAPEMARK_TAPE_H
#define TAPEMARK_TAPE_H

#include "finder.h"
#include "stroke.h"

#include "tapemark.h"

enum { TMI_MAX_FINDERS = 128, TMI_MAX_CHAIN = TAPEMARK_TM_MAX_CMS + 1, TMI_NONE = -1 };

/* Directions of a finder: its right, down, left and up side. */
enum { TMI_DIRECTIONS = 4 };

typedef struct tmi_node {
    tmi_finder finder;
    int16_t neighbour[TMI_DIRECTIONS]; /* index of the next finder of the tape on that side, or TMI_NONE */
} tmi_node;

typedef struct tmi_tape {
    const tmi_view *view;
    tapemark_stats *stats;
    uint32_t work_max; /* no search is begun once stats->work has reached this */
    int count;
    int partners;      /* finders that were located with another one in a CM's distance, TMI_PARTNERS_MAX at most */
    tmi_node nodes[TMI_MAX_FINDERS];
} tmi_tape;

/* Where there are tapes, there is more to look for: a finder with a partner has paid for so much. So many may pay:
 * where there are more, in carpets of finder patterns, the slowest frame would be slower still. */
enum { TMI_PARTNER_CREDIT = 1500, TMI_PARTNERS_MAX = 20 };

/* This much work, and what finders have paid for. */
static inline uint64_t tmi_tape_work(const tmi_tape *tape, uint32_t work)
{
    return (uint64_t)work + (uint64_t)TMI_PARTNER_CREDIT * (uint64_t)tape->partners;
}

/* The finder pattern whose 7 x 7 modules (and half a module around) hold this point, or TMI_NONE. */
int tmi_tape_finder_at(const tmi_tape *tape, tmi_point at);

/* Adds a finder pattern; TMI_NONE, and a limit noted, when there is no room. */
int tmi_tape_add(tmi_tape *tape, const tmi_finder *finder);

/* Links neighbours, then looks for missing ones beyond the ends of what is linked, and around single ones. */
void tmi_tape_link(tmi_tape *tape);

/* Leaves out the strokes that belong to the print around finders: in line with them, and much narrower than they are
 * high. To be called before the rows are asked for. */
void tmi_tape_drop_strokes(const tmi_tape *tape, tmi_strokes *strokes);

/* The way through all rows; zeroed at first. */
typedef struct tmi_rows {
    int next;       /* no row begins at a finder before this one */
    bool goes_on;   /* the row is longer than the chain that was filled with it: */
    int last;       /* its last finder there, */
    int direction;  /* and where the row leaves it */
} tmi_rows;

/* The rows of two or more linked finders, one a call. Copies at most TMI_MAX_CHAIN finders, turned so that `right`
 * runs along the row. Returns how many; 0 at the end. Of a row that goes on, the next call gives what follows, behind
 * the `kept` finders (of this row, the last one among them) that the chain begins with. */
int tmi_tape_next_chain(tmi_tape *tape, tmi_rows *rows, int kept, tmi_finder chain[TMI_MAX_CHAIN]);

#endif
