/* One viewer of the preview: its request, what it gets, how long it may take. Not for others. */
#ifndef PLATFORM_PREVIEW_VIEWER_H
#define PLATFORM_PREVIEW_VIEWER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PREVIEW_REQUEST_MAX_BYTES = 4096 };

typedef enum viewer_state {
    VIEWER_NONE,     /* a free place */
    VIEWER_ASKING,   /* its request is not whole */
    VIEWER_WAITING,  /* for a picture */
    VIEWER_TAKING    /* what it is sent */
} viewer_state;

/* Zeroed before the first use. */
typedef struct preview_viewer {
    viewer_state state;
    int descriptor;
    bool streaming;       /* wants another picture after this one */
    int64_t deadline_ns;  /* out of patience */
    char request[PREVIEW_REQUEST_MAX_BYTES];
    size_t request_bytes;
    uint8_t *output;
    size_t output_capacity;
    size_t output_bytes;
    size_t output_sent_bytes;
} preview_viewer;

/* Takes the descriptor over; it does not wait. */
void preview_viewer_begin(preview_viewer *viewer, int descriptor, int64_t now_ns);

/* For poll(). */
short preview_viewer_events(const preview_viewer *viewer);

/* Goes on as far as it can without waiting; may come to VIEWER_NONE. */
void preview_viewer_step(preview_viewer *viewer, short events, int64_t now_ns);

/* To one that is VIEWER_WAITING. */
void preview_viewer_give(preview_viewer *viewer, const uint8_t *jpeg, size_t size, int64_t now_ns);

/* Ends it; its memory is kept for the next one. */
void preview_viewer_end(preview_viewer *viewer);

void preview_viewer_release(preview_viewer *viewer);

#endif
