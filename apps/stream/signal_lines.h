/* The GPIO lines: seen, strobe and trigger. A line that fails is told of once and given back; from then on it is
 * asked for now and then. */
#ifndef STREAM_SIGNAL_LINES_H
#define STREAM_SIGNAL_LINES_H

#include "camera.h"
#include "gpio_lines.h"
#include "settings.h"
#include "strobe.h"

/* All zero at first. */
typedef struct signal_lines {
    gpio_output *seen;
    gpio_input *trigger;
    strobe *strobe;
    int64_t last_exposure_ns;  /* the middle of it; 0: none yet */
    int64_t period_ns;
    int64_t next_try_ns;       /* when those that are missing are asked for again */
    unsigned failures;
} signal_lines;

/* Takes those that are named, after leaving the ones before. Those that cannot be had are told of and left out. */
void signal_lines_open(signal_lines *lines, const gpio_settings *wanted);

/* Whether all that are named are there and none has failed. */
bool signal_lines_are_whole(const signal_lines *lines, const gpio_settings *wanted);

/* Asks again for those that are missing, when it is time to; tells of those that are there then. */
void signal_lines_try_again(signal_lines *lines, const gpio_settings *wanted, int64_t now_ns);

void signal_lines_show_seen(signal_lines *lines, bool seen);

/* Foretells the next exposure from the one of this frame and sets the strobe on around it. */
void signal_lines_foretell(signal_lines *lines, const camera_frame *got, int64_t now_ns);

/* Whether the trigger went on since the last call. */
bool signal_lines_triggered(signal_lines *lines);

/* For poll(); -1 without a trigger. */
int signal_lines_descriptor(const signal_lines *lines);

void signal_lines_close(signal_lines *lines);

#endif
