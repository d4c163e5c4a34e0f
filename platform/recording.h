/*
 * Records what a camera gave, to be played again as a camera (file:PATH).
 *
 * PATH.y4m holds the luma as 8-bit gray, which any video program shows; any other name the frames byte for byte, one
 * after the other. Beside it, PATH.times is a text file: a line "# tapemark times 1 LAYOUT", then for each frame its
 * sequence number, the middle of its exposure in ns (CLOCK_MONOTONIC) and its exposure in us (0: not known).
 *
 * Frames are copied, and written by a thread: nobody waits for the disk. Frames for which it is too slow are left out
 * and counted; a gap in the sequence numbers stands for them.
 */
#ifndef PLATFORM_RECORDING_H
#define PLATFORM_RECORDING_H

#include "camera.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct recording recording;

/* Begins a recording, over one that is there. `rate_hz` is what the head of a Y4M file tells; 0 while not known.
 * NULL on failure. */
recording *recording_open(const char *path, double rate_hz, error_text *error);

/* Never waits for the disk. False, with an error, when the recording has ended: the disk is full, which shows some
 * frames later, or the frame has another layout than those before. What was recorded up to then is whole and can be
 * played. Programs that limit the size of their files have to ignore SIGXFSZ. */
bool recording_add(recording *file, const camera_frame *input, error_text *error);

/* Frames that were given and are not recorded, because the disk was too slow. */
uint64_t recording_left_out(recording *file);

/* Writes what waits, for four seconds at most. NULL is fine. False, with an error, when frames are missing or did not
 * reach the disk, unless recording_add() has told so. */
bool recording_close(recording *file, error_text *error);

/* ---- The times of a recording, read again ----------------------------------------------------------------- */

typedef struct recorded_frame {
    uint64_t sequence;
    int64_t time_ns;
    int32_t exposure_us;
} recorded_frame;

typedef struct recording_times recording_times;

/* The times beside a recording. *times is NULL when there are none; false when they cannot be read. */
bool recording_times_open(const char *recording_path, recording_times **times, error_text *error);

const frame_layout *recording_times_layout(const recording_times *times);

typedef enum times_status { TIMES_FRAME, TIMES_END, TIMES_FAILED } times_status;

/* A last line that is cut short is of a frame that was being written when the machine went out: it does not count. */
times_status recording_times_next(recording_times *times, recorded_frame *output, error_text *error);

void recording_times_close(recording_times *times);

#ifdef __cplusplus
}
#endif

#endif
