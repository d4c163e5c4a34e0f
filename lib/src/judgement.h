/* Which readings of a row of CMs to believe, and which way up they say it is. */
#ifndef TAPEMARK_JUDGEMENT_H
#define TAPEMARK_JUDGEMENT_H

#include "segment.h"

/* No reason to reject. */
#define TMI_BELIEVED TAPEMARK_REJECT_COUNT

/* What shares this little with all words is no CM. */
static const float tmi_cm_score = 0.5f;

/* Sum over the CMs by which one way up must fit better than the other. */
static const float tmi_turn_min = 0.05f;

/* Which way up the CMs say the segment is: positive as the row runs, negative standing on the head. */
float tmi_turn_evidence(const tmi_segment *segment, int first, int count);

/* Judges all CMs of a part that is that way up; returns how many are believed. */
int tmi_judge(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float evidence,
              tapemark_reject reasons[TAPEMARK_TM_MAX_CMS]);

/* Whether at least one of the CMs shares with all words what CMs do. */
bool tmi_looks_like_tape(const tmi_segment *segment, int first, int count);

#endif
