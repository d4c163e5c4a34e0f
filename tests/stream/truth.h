/* What is in view in a capture, by the simulator that made it. */
#ifndef TRUTH_H
#define TRUTH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tapemark_receiver.h"

enum { TRUTH_FRAMES_MAX = 64, TRUTH_CMS_MAX = 32 };

typedef struct true_cm {
    int32_t id;
    double x_px, y_px;  /* of its centre */
    bool full;          /* wholly in view */
} true_cm;

typedef struct true_tm {
    uint32_t code;
    uint8_t length;
    double x_px, y_px;  /* of its ink's centre */
} true_tm;

typedef struct true_frame {
    true_cm cms[TRUTH_CMS_MAX];
    size_t cm_count;
    true_tm tms[TRUTH_CMS_MAX];
    size_t tm_count;
} true_frame;

typedef struct truth {
    true_frame frames[TRUTH_FRAMES_MAX];
    size_t count;
} truth;

/* Reads a file of JSON lines, as tapemark-render writes them. */
bool truth_read(const char *path, truth *output);

/* Whether this CM is in that frame, and where the record says. */
bool truth_has_cm(const true_frame *frame, const tapemark_cm_record *cm);

/* Likewise. */
bool truth_has_tm(const true_frame *frame, const tapemark_tm_record *tm);

#endif
