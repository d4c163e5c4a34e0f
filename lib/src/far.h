/* Tapes too far away for their finder patterns to be seen one by one, read as a whole. */
#ifndef TAPEMARK_FAR_H
#define TAPEMARK_FAR_H

#include "segment.h"
#include "waveform.h"

/* Memory for one row at a time. */
typedef struct tmi_far {
    tmi_wave wave;
    union {
        tmi_wave_sums sums; /* while the row is looked for */
        tmi_segment segment;
    };
} tmi_far;

/* Looks along the stripes that the strokes form for rows of CMs, and reads what has not been read. */
void tmi_far_read(const tmi_reader *reader, tmi_strokes *strokes, tmi_far *far);

#endif
