/* What was read and believed, as the caller gets it. */
#ifndef TAPEMARK_REPORT_H
#define TAPEMARK_REPORT_H

#include "segment.h"

/* Whether the row runs as upright tapes do by the caller's hint: positive, or negative where it runs against it; 0
 * without a hint or across it. */
float tmi_turn_hint(const tmi_reader *reader, const tmi_segment *segment, int first, int count);

/* The corners of a TM of the CMs first..first + count - 1, bars included, and whether such corners lie in the image.
 */
void tmi_tm_corners(const tmi_segment *segment, int first, int count, bool turned, tapemark_point corners[4]);
bool tmi_corners_inside(const tmi_view *view, const tapemark_point corners[4]);

/* Adds a TM to the result that was read so, if its vote is enough and the CMs agree: `turn` is positive where the row
 * runs as the tape reads, negative where it runs the other way, and 0 where that is not known. Returns its index, or
 * TMI_NONE. */
int tmi_report_tm(const tmi_reader *reader, const tmi_segment *segment, const tapemark_reject *reasons, int first,
                  int count, float turn, const tmi_tm_reading *reading);

/* Adds a CM to the result, if it lies in the image. */
void tmi_report_cm(const tmi_reader *reader, const tmi_segment *segment, int cm, bool turned, int tm, int slot);

#endif
