#include "gpio_watch.h"

#include <stdlib.h>
#include <string.h>

#include "picture.h"

/* The line changes when the records have left, and they take a while to come. */
static const int64_t settled_ns = 40000000;

bool gpio_watch_begin(gpio_watch *watch)
{
    watch->frame_count = 0;
    watch->dropped = 0;
    return gpio_outside_forget(&watch->chip);
}

static void note_record(gpio_watch *watch, const tapemark_record *record, int64_t arrival_ns)
{
    if (record->type == TAPEMARK_RECORD_FRAME && watch->frame_count < WATCH_FRAMES_MAX) {
        const tapemark_frame_record *head = &record->as.frame;
        watch->frames[watch->frame_count++] = (watched_frame){
            .arrival_ns = arrival_ns,
            .capture_ns = arrival_ns - (int64_t)head->age_10us * 10000,
            .seen = head->records > 0,
            .number = -1,
        };
        watch->dropped += head->dropped;
    } else if (record->type == TAPEMARK_RECORD_CM && watch->frame_count > 0 &&
               record->as.cm.id >= PICTURE_NUMBER_ID) {
        watch->frames[watch->frame_count - 1].number = record->as.cm.id - PICTURE_NUMBER_ID;
    }
}

bool gpio_watch_step(gpio_watch *watch, stream_host *records)
{
    tapemark_record record;
    if (host_record(records, 1, &record))
        note_record(watch, &record, records->record_ns);
    return gpio_outside_watch(&watch->chip);
}

const watched_frame *gpio_watch_last_frame(const gpio_watch *watch)
{
    return watch->frame_count > 0 ? &watch->frames[watch->frame_count - 1] : NULL;
}

bool gpio_watch_is_on(const gpio_watch *watch, watched_line line, int64_t time_ns)
{
    return gpio_outside_level_at(&watch->chip, line.line, time_ns) != line.low;
}

seen_findings gpio_watch_judge_seen(const gpio_watch *watch, watched_line line)
{
    seen_findings found = {.frames = (unsigned)watch->frame_count};
    bool before = false;
    for (size_t i = 0; i < watch->frame_count; i++) {
        const watched_frame *at = &watch->frames[i];
        /* One that is told of right before the next one may be on the line for too short a time. */
        bool stays = i + 1 == watch->frame_count || at[1].arrival_ns > at->arrival_ns + settled_ns;
        found.with_marker += at->seen;
        found.wrong += stays && gpio_watch_is_on(watch, line, at->arrival_ns + settled_ns) != at->seen;
        found.changes += at->seen != before;
        before = at->seen;
    }
    found.edges = (unsigned)gpio_outside_count(&watch->chip, line.line);
    return found;
}

/* ---- The strobe ------------------------------------------------------------------------------------------------ */

typedef struct strobe_pulse {
    int64_t on_ns, off_ns;
} strobe_pulse;

static size_t find_pulses(const gpio_watch *watch, watched_line line, strobe_pulse pulses[STROBE_PULSES_MAX])
{
    size_t count = 0;
    bool on = false;
    for (size_t i = 0; i < watch->chip.edge_count && i < OUTSIDE_EDGES_MAX && count < STROBE_PULSES_MAX; i++) {
        const outside_edge *edge = &watch->chip.edges[i];
        if (edge->line != line.line)
            continue;
        if (edge->high != line.low)
            pulses[count].on_ns = edge->time_ns;
        else if (on)
            pulses[count++].off_ns = edge->time_ns;
        on = edge->high != line.low;
    }
    return count;
}

static const strobe_pulse *pulse_at(const strobe_pulse *pulses, size_t count, int64_t time_ns)
{
    for (size_t i = 0; i < count; i++) {
        if (pulses[i].on_ns <= time_ns && time_ns <= pulses[i].off_ns)
            return &pulses[i];
    }
    return NULL;
}

static int compare(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

static void spread(double *values, size_t count, double *low, double *middle, double *high)
{
    if (count == 0)
        return;
    qsort(values, count, sizeof *values, compare);
    *low = values[count / 10];
    *middle = values[count / 2];
    *high = values[count - 1 - count / 10];
}

strobe_findings gpio_watch_judge_strobe(const gpio_watch *watch, watched_line line)
{
    static strobe_pulse pulses[STROBE_PULSES_MAX];
    static double values[STROBE_PULSES_MAX];
    const size_t pulse_count = find_pulses(watch, line, pulses);
    strobe_findings found = {.pulses = (unsigned)pulse_count};
    for (size_t i = 0; i < pulse_count; i++)
        values[i] = (double)(pulses[i].off_ns - pulses[i].on_ns) * 1e-6;
    spread(values, pulse_count, &found.width_low_ms, &found.width_ms, &found.width_high_ms);
    for (size_t i = 2; i < watch->frame_count; i++) {
        const strobe_pulse *lit = pulse_at(pulses, pulse_count, watch->frames[i].capture_ns);
        found.frames++;
        if (lit == NULL)
            continue;
        const int64_t middle_ns = lit->on_ns + (lit->off_ns - lit->on_ns) / 2;
        values[found.lit++] = (double)(middle_ns - watch->frames[i].capture_ns) * 1e-6;
    }
    spread(values, found.lit, &found.offset_low_ms, &found.offset_ms, &found.offset_high_ms);
    return found;
}
