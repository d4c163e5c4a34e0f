/* A frame of a camera as what is read in it. Memory is taken when the size of frames changes, and not else. */
#ifndef STREAM_FRAME_READER_H
#define STREAM_FRAME_READER_H

#include "camera.h"
#include "gray.h"
#include "image_quality.h"
#include "tapemark.h"

enum { READER_CMS = 256, READER_TMS = 64, READER_FINDERS = 128 };

/* All places are those of the whole picture, whatever part of it was looked at. */
typedef struct frame_reading {
    gray_view view;          /* the whole picture; while the frame's pixels are there */
    image_quality quality;   /* of the part that was looked at */
    tapemark_status status;
    tapemark_result result;  /* in the reader's memory, until its next frame */
} frame_reading;

typedef struct frame_reader {
    gray_converter converter;
    uint8_t *workspace;
    size_t workspace_size;
    tapemark_cm cms[READER_CMS];
    tapemark_tm tms[READER_TMS];
    tapemark_finder finders[READER_FINDERS];
} frame_reader;

/* A region that lies outside of the picture is as good as none. False when memory runs out, or for settings that the
 * decoder refuses. */
bool frame_reader_read(frame_reader *reader, const frame *image, const camera_region *region,
                       const tapemark_config *config, frame_reading *reading, error_text *error);

/* A zeroed reader is fine. */
void frame_reader_release(frame_reader *reader);

#endif
