/* Whether a camera is frozen: the noise of a sensor never gives the same picture twice. Pictures without markers are
 * not looked at: in the dark, or blinded, a sensor may well do so, and there is nothing in them to be believed. */
#ifndef STREAM_STILLNESS_H
#define STREAM_STILLNESS_H

#include "gray.h"

#include <stdbool.h>
#include <stdint.h>

/* All zero at first. */
typedef struct stillness {
    bool any;
    uint64_t fingerprint;  /* of the picture that has not changed */
    int64_t since_ns;      /* its capture, when it came first */
    unsigned times;        /* that it came again */
} stillness;

/* The next picture. True when it has not changed for three seconds. */
bool stillness_lasts(stillness *seen, const gray_view *view, bool has_markers, int64_t capture_ns);

#endif
