/* Tapes seen in a window or on a glossy floor. */
#ifndef TAPEMARK_MIRROR_H
#define TAPEMARK_MIRROR_H

#include "segment.h"

/* Whether these CMs, together, look like the mirror images of CMs rather than like CMs. */
bool tmi_is_mirrored(const tmi_reader *reader, const tmi_segment *segment, int first, int count);

#endif
