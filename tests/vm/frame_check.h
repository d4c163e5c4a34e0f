/* Whether records are those of the pictures that the camera was shown: each frame tells by the CM of its number which
 * one it is of. */
#ifndef VM_FRAME_CHECK_H
#define VM_FRAME_CHECK_H

#include "truth.h"

enum { FRAME_CHECK_AGES = 4096, FRAME_CHECK_GROUP = 16 };

/* What came of a frame. */
typedef struct frame_group {
    bool begun, headed;
    tapemark_frame_record head;
    uint16_t seq;
    int64_t arrival_ns;
    size_t cm_count, tm_count;
    tapemark_cm_record cms[FRAME_CHECK_GROUP];
    tapemark_tm_record tms[FRAME_CHECK_GROUP];
} frame_group;

typedef struct frame_check {
    /* Set before the first record. */
    int32_t width_px, height_px;
    double rate_hz;         /* of the pictures */
    bool each_is_new;       /* no picture comes twice */
    bool bytes_are_damaged; /* on the way: records may be missing */

    uint64_t frames, whole, empty, losses, cms, tms, dropped, repeated, incomplete;
    uint64_t wrong;         /* records that say what is not so */
    char complaint[300];    /* about the first wrong one */
    frame_group group;
    bool sequence_known;    /* seq is that of the last FRAME */
    uint16_t seq;
    int64_t number;         /* of the last picture; -1: none yet */
    uint32_t capture_us;    /* of the last frame with a time */
    bool capture_known;
    uint32_t number_capture_us;
    uint32_t clock_us;      /* the least that the host's clock was ahead of what a FRAME told when it came */
    bool clock_known;
    int32_t lag_us, lag_max_us;  /* of the last frame, and the most: how long after the time it tells it came */
    uint32_t ages_10us[FRAME_CHECK_AGES];
    size_t age_count;
    uint16_t p50_tenth_ms[FRAME_CHECK_AGES], p99_tenth_ms[FRAME_CHECK_AGES];  /* by STATUS */
    size_t status_count;
    uint16_t status_flags;  /* of all STATUS records */
} frame_check;

void frame_check_begin(frame_check *check, int32_t width_px, int32_t height_px, double rate_hz);

void frame_check_record(frame_check *check, const tapemark_record *record, int64_t arrival_ns);

/* After a break, of the line or of the program: what comes next need not go on where the last one ended. */
void frame_check_break(frame_check *check);

/* From capture to the first byte, of the frames so far. */
double frame_check_age_ms(frame_check *check, double share);

/* From capture to the last byte, in the middle and at the worst of the STATUS records. */
double frame_check_p50_ms(frame_check *check);

double frame_check_p99_ms(frame_check *check);

#endif
