/* Ids ascend along a segment: CMs that cannot be told each for itself, because of damage or distance, are told by
 * what all of them show together. */
#ifndef TAPEMARK_SEQUENCE_H
#define TAPEMARK_SEQUENCE_H

#include "segment.h"

/* Reads the CMs first..first + count - 1 of the segment, that way up, which are not believed, as parts of one
 * sequence of ids, if there is one that explains them. Sets their readings, and takes their reasons back. */
void tmi_sequence_read(const tmi_reader *reader, tmi_segment *segment, int first, int count, bool turned,
                       tapemark_reject reasons[TAPEMARK_TM_MAX_CMS]);

#endif
