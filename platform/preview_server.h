/*
 * A page with the live picture, so that a person can aim and focus: HTTP, the picture as a row of JPEGs (MJPEG).
 *
 *     /            the page
 *     /stream      the picture, as long as the viewer stays
 *     /frame.jpg   one picture
 *
 * It has a thread of its own, in which pictures are drawn, coded and sent. Whoever shows frames never waits for it,
 * and viewers that are too slow get fewer frames. Nothing is coded while nobody looks. Viewers, their requests and
 * their patience with us are bounded.
 */
#ifndef PLATFORM_PREVIEW_SERVER_H
#define PLATFORM_PREVIEW_SERVER_H

#include "error_text.h"
#include "gray.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct preview_server preview_server;

/* The frame in colour, to be drawn on: blue, green, red, a byte each. */
typedef struct preview_canvas {
    uint8_t *bgr;
    int32_t width_px;
    int32_t height_px;
    ptrdiff_t stride_bytes;
} preview_canvas;

/* Draws into a frame what was read in it. `notes` is a copy of what preview_server_show() got with this frame. Called
 * in the server's thread. */
typedef void preview_painter(void *context, const preview_canvas *canvas, const void *notes);

typedef struct preview_settings {
    const char *address;       /* PORT, on loopback, or HOST:PORT; HOST is a number such as 0.0.0.0 or [::] */
    preview_painter *paint;    /* NULL: nothing is drawn */
    void *context;             /* of it */
    size_t notes_size_bytes;   /* the same for each frame; 0: none */
} preview_settings;

/* NULL on failure. Signals go to the other threads. */
preview_server *preview_server_open(const preview_settings *settings, error_text *error);

/* For people: http://127.0.0.1:8080/ */
const char *preview_server_url(const preview_server *server);

/* Somebody waits for a frame. Costs next to nothing. */
bool preview_server_is_watched(preview_server *server);

/* Copies the frame and its notes when somebody waits for one, and else does nothing. Never waits for a viewer. */
void preview_server_show(preview_server *server, const gray_view *view, const void *notes);

/* Ends at once, viewers or not. NULL is fine. */
void preview_server_close(preview_server *server);

#ifdef __cplusplus
}
#endif

#endif
