/* What the board's GPIO lines did, held against the records that came at the same time. */
#ifndef VM_GPIO_WATCH_H
#define VM_GPIO_WATCH_H

#include "gpio_outside.h"
#include "stream_host.h"

enum { WATCH_FRAMES_MAX = 600 };

typedef struct watched_frame {
    int64_t arrival_ns;
    int64_t capture_ns;  /* the middle of its exposure: when its FRAME came, less the age that this tells */
    bool seen;           /* has markers */
    int64_t number;      /* of its picture; -1 as long as that is not known */
} watched_frame;

typedef struct gpio_watch {
    gpio_outside chip;
    watched_frame frames[WATCH_FRAMES_MAX];
    size_t frame_count;
    unsigned dropped;
} gpio_watch;

/* A line of tapemark-stream: which of the chip's, and whether it is on while it is low. */
typedef struct watched_line {
    unsigned line;
    bool low;
} watched_line;

/* Forgets what was. */
bool gpio_watch_begin(gpio_watch *watch);

/* For a millisecond, or until a record has come. False when the emulator is gone. */
bool gpio_watch_step(gpio_watch *watch, stream_host *records);

/* NULL before the first one. */
const watched_frame *gpio_watch_last_frame(const gpio_watch *watch);

bool gpio_watch_is_on(const gpio_watch *watch, watched_line line, int64_t time_ns);

typedef struct seen_findings {
    unsigned frames, with_marker, wrong;  /* frames after which the line told the wrong thing */
    unsigned changes, edges;              /* of the frames, from off at first; of the line */
} seen_findings;

seen_findings gpio_watch_judge_seen(const gpio_watch *watch, watched_line line);

enum { STROBE_PULSES_MAX = WATCH_FRAMES_MAX };

typedef struct strobe_findings {
    unsigned frames, lit, pulses;  /* frames, those exposed in a pulse, pulses that have ended */
    double width_ms, width_low_ms, width_high_ms;     /* of the pulses: median, and all but a tenth at either end */
    double offset_ms, offset_low_ms, offset_high_ms;  /* of their middles from the exposures' they lit */
} strobe_findings;

/* From the third frame on: two are needed to foretell one. */
strobe_findings gpio_watch_judge_strobe(const gpio_watch *watch, watched_line line);

#endif
