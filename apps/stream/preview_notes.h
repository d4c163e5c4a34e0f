/* What was read in a frame, drawn into the picture of the preview. */
#ifndef STREAM_PREVIEW_NOTES_H
#define STREAM_PREVIEW_NOTES_H

#include "frame_reader.h"
#include "preview_server.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PREVIEW_MARKERS = 64, PREVIEW_CAPTION_BYTES = 120 };

typedef struct preview_marker {
    tapemark_point corners[4];
    char label[TAPEMARK_TM_MAX_CMS + 1];
    bool tape;  /* a TM */
} preview_marker;

/* A copy that needs nothing else: it is drawn later, in another thread. */
typedef struct preview_notes {
    preview_marker markers[PREVIEW_MARKERS];
    size_t count;
    char caption[PREVIEW_CAPTION_BYTES];
} preview_notes;

void preview_notes_take(preview_notes *notes, const frame_reading *reading, double rate_hz);

/* A preview_painter. */
void preview_notes_paint(void *context, const preview_canvas *canvas, const void *notes);

#ifdef __cplusplus
}
#endif

#endif
