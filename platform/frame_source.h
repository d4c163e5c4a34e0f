/*
 * Where frames come from: open, next frame, next frame, …, close. A source owns the pixels of the frame it gave
 * last. Files are opened here; any other kind of source fills in frame_source_methods and is used alike.
 */
#ifndef PLATFORM_FRAME_SOURCE_H
#define PLATFORM_FRAME_SOURCE_H

#include "frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum frame_status {
    FRAME_READY,
    FRAME_END,    /* there are no more */
    FRAME_FAILED  /* damaged or unreadable from here on; the error says how */
} frame_status;

typedef struct frame_source frame_source;

typedef struct frame_source_methods {
    frame_status (*next)(frame_source *source, frame *output, error_text *error);
    void (*close)(frame_source *source);
} frame_source_methods;

/* The first member of each kind of source. */
struct frame_source {
    const frame_source_methods *methods;
    uint64_t frames_expected;  /* about how many there will be, for progress; 0 while unknown */
    bool has_given;            /* a frame: set by frame_source_next() */
};

/* Opens a file by what it contains, not by its name: PGM, Y4M, JPEG and other still pictures, videos. With
 * `raw`, the content is taken as headerless frames of that layout whatever it looks like. path "-" is standard
 * input, where videos other than Y4M and a row of JPEGs cannot be read. NULL on failure. */
frame_source *frame_source_open_file(const char *path, const frame_layout *raw, error_text *error);

/* What `output` points to stays valid until the next call for this source. Frames before a damaged place are
 * given first. A source without any frame is a failure. After FRAME_END or FRAME_FAILED it is only good for
 * closing. */
frame_status frame_source_next(frame_source *source, frame *output, error_text *error);

/* NULL is fine. */
void frame_source_close(frame_source *source);

#ifdef __cplusplus
}
#endif

#endif
