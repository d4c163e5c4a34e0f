#include "walk_check.h"

#include <stdio.h>
#include <string.h>

static void complain(walk_check *check, const char *what, uint16_t seq, long number)
{
    if (check->wrong++ == 0)
        snprintf(check->complaint, sizeof check->complaint, "%s %ld with seq %u, after seq %u at frame %llu", what,
                 number, seq, check->seq,
                 (unsigned long long)(check->position + check->walk->count - 1) % check->walk->count);
}

/* The FRAME of a marker may be one that was lost. */
static const true_frame *frame_of(const walk_check *check, uint16_t seq)
{
    const uint64_t position = check->position + (uint64_t)(int16_t)(seq - check->seq);
    return &check->walk->frames[(position + check->walk->count - 1) % check->walk->count];
}

/* Numbers that were passed over, and whether the FRAME tells of them: with 255, of that many or more. */
static void count_missing(walk_check *check, uint16_t passed_over, uint8_t told)
{
    const uint16_t dropped = told < UINT8_MAX || passed_over < told ? told : passed_over;
    check->dropped += dropped;
    if (passed_over > dropped)
        *(check->harmed ? &check->spoiled : &check->unexplained) += (uint64_t)(passed_over - dropped);
    check->harmed = false;
}

static void check_frame(walk_check *check, const tapemark_frame_record *head)
{
    const uint16_t needed = TAPEMARK_FRAME_TIMED | TAPEMARK_FRAME_REPLAYED;
    const uint16_t step = (uint16_t)(head->seq - check->seq);
    const bool tells_drops = (head->flags & TAPEMARK_FRAME_FRAMES_DROPPED) != 0;
    check->incomplete += check->expected > 0;
    check->expected = head->records;
    if ((head->flags & TAPEMARK_FRAME_CAMERA_LOST) != 0) {
        /* It has a number of its own, but no place in the walk. */
        check->lost++;
        check->position += (uint16_t)(step - 1);
        check->seq = head->seq;
        count_missing(check, (uint16_t)(step - 1), head->dropped);
        return;
    }
    check->frames++;
    const true_frame *seen = frame_of(check, head->seq);
    if ((head->flags & needed) != needed || head->width_px != seen->width_px ||
        head->height_px != seen->height_px || step == 0 || tells_drops != (head->dropped > 0) ||
        (head->dropped < UINT8_MAX && head->dropped >= step))
        complain(check, "FRAME, flags", head->seq, head->flags);
    check->seq = head->seq;
    check->position += step;
    count_missing(check, (uint16_t)(step - 1), head->dropped);
}

/* So far from its place it is taken for something else. */
static bool is_elsewhere(walk_check *check, double off_px)
{
    const double far_px = 20;
    check->misplaced += off_px >= truth_tolerance_px && off_px < far_px;
    return off_px >= far_px;
}

void walk_check_record(walk_check *check, const tapemark_record *record)
{
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        check_frame(check, &record->as.frame);
        return;
    case TAPEMARK_RECORD_CM:
        check->cms++;
        if (is_elsewhere(check, truth_cm_off_px(frame_of(check, record->as.cm.seq), &record->as.cm)))
            complain(check, "CM", record->as.cm.seq, record->as.cm.id);
        break;
    case TAPEMARK_RECORD_TM:
        check->tms++;
        if (is_elsewhere(check, truth_tm_off_px(frame_of(check, record->as.tm.seq), &record->as.tm)))
            complain(check, "TM", record->as.tm.seq, (long)record->as.tm.code);
        break;
    case TAPEMARK_RECORD_STATUS:
    case TAPEMARK_RECORD_DEVICE:
    case TAPEMARK_RECORD_ANSWER:
        return;
    default:
        complain(check, "record of type", 0, record->type);
    }
    check->expected -= check->expected > 0;
}
