/* The program: frames from a camera in, records out, with all that can go wrong in between. */
#ifndef STREAM_STREAM_H
#define STREAM_STREAM_H

#include "camera_watch.h"
#include "map_table.h"
#include "stream_options.h"
#include "preview_notes.h"
#include "record_line.h"
#include "recording.h"
#include "service.h"
#include "signal_lines.h"
#include "snapshot.h"
#include "stillness.h"

/* What is counted between two STATUS records, and since the start. */
typedef struct stream_counts {
    unsigned frames;          /* since the last STATUS */
    double rate_hz;           /* by the last STATUS */
    int64_t latency_p99_ns;
    int64_t last_status_ns;
    uint64_t frames_sent;     /* when it was last looked at */
    unsigned mistakes;        /* of configuration files, maps, commands, recordings and frames */
    unsigned line_failures;
} stream_counts;

/* All zero before it is opened. */
typedef struct stream {
    command_line command;
    stream_settings settings;
    map_table map;
    bool map_loaded;
    bool map_broken;
    service *service;
    camera_watch camera;
    frame_reader reader;
    record_line line;
    signal_lines gpio;
    snapshots *snapshots;
    stillness stillness;
    preview_server *preview;
    preview_notes notes;
    recording *recording;
    bool recording_begun;     /* with the first frame, which tells the layout */
    bool snapshot_wanted;
    bool reading_failed;
    int32_t width_px;         /* of the last frame */
    int32_t height_px;
    camera_frame last;        /* its exposure, for STATUS */
    int64_t start_ns;
    int64_t next_loss_ns;     /* when the next FRAME goes out in place of a frame */
    int64_t next_alive_ns;
    int64_t end_ns;           /* when waiting for the last bytes ends; 0: there is no end yet */
    stream_counts counts;
} stream;

/* ---- stream_setup.c ---- */

/* False when it cannot begin; what is wrong was told. */
bool stream_open(stream *self, command_line command, const stream_settings *settings);

/* Reads the configuration file and the map again. What is wrong is told, and what was there before stays. */
void stream_reload(stream *self);

/* False when something still holds a thread: the program has to end without waiting for it. */
bool stream_close(stream *self);

/* ---- stream_frames.c ---- */

/* Everything that is done with a frame; its records leave first. */
void stream_take_frame(stream *self, const camera_frame *got, int64_t now_ns);

/* A FRAME without a frame. */
void stream_tell_loss(stream *self, int64_t now_ns);

/* STATUS and DEVICE. */
void stream_tell_status(stream *self, int64_t now_ns);

/* ---- stream_loop.c ---- */

/* Goes on until it is told to end, or there is no more to do. The exit status. */
int stream_run(stream *self);

#endif
