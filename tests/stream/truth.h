/* What is in view in a capture, by the simulator that made it. */
#ifndef TRUTH_H
#define TRUTH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tapemark_receiver.h"

enum { TRUTH_CMS_MAX = 32 };

typedef struct true_cm {
    int32_t id;
    double x_px, y_px;  /* of its centre */
} true_cm;

typedef struct true_tm {
    uint32_t code;
    uint8_t length;
    double x_px, y_px;  /* of its ink's centre */
} true_tm;

/* Of markers that can be seen, at least in part. */
typedef struct true_frame {
    uint16_t width_px, height_px;
    true_cm cms[TRUTH_CMS_MAX];
    size_t cm_count;
    true_tm tms[TRUTH_CMS_MAX];
    size_t tm_count;
} true_frame;

typedef struct truth {
    true_frame *frames;
    size_t count;
} truth;

/* Reads a file of JSON lines, as tapemark-render writes them. False when there are none, or not enough memory. */
bool truth_read(const char *path, truth *output);

void truth_release(truth *all);

/* How far from its place in the frame the record says that the CM is; INFINITY when it is not in the frame. */
double truth_cm_off_px(const true_frame *frame, const tapemark_cm_record *cm);

/* Likewise. Where it is not known which way it reads, either way is right. */
double truth_tm_off_px(const true_frame *frame, const tapemark_tm_record *tm);

/* What a place may be off, all told. */
extern const double truth_tolerance_px;

/* Whether this CM is in that frame, and where the record says. */
bool truth_has_cm(const true_frame *frame, const tapemark_cm_record *cm);

/* Likewise. */
bool truth_has_tm(const true_frame *frame, const tapemark_tm_record *tm);

#endif
