#include "walk_check.h"

#include <stdio.h>
#include <string.h>

static void complain(walk_check *check, const char *what, uint16_t seq, long number)
{
    if (check->wrong++ == 0)
        snprintf(check->complaint, sizeof check->complaint, "%s %ld with seq %u, after seq %u at frame %llu", what,
                 number, seq, check->seq, (unsigned long long)(check->position + WALK_FRAMES - 1) % WALK_FRAMES);
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
        return;
    }
    check->frames++;
    check->dropped += head->dropped;
    if ((head->flags & needed) != needed || head->width_px != 480 || head->height_px != 270 || step == 0 ||
        tells_drops != (head->dropped > 0) || (head->dropped < UINT8_MAX && head->dropped >= step))
        complain(check, "FRAME, flags", head->seq, head->flags);
    check->seq = head->seq;
    check->position += step;
}

/* The FRAME of a marker may be one that was lost. */
static const true_frame *frame_of(const walk_check *check, uint16_t seq)
{
    const uint64_t position = check->position + (uint64_t)(int16_t)(seq - check->seq);
    return &check->walk->frames[(position + WALK_FRAMES - 1) % WALK_FRAMES];
}

void walk_check_record(walk_check *check, const tapemark_record *record)
{
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        check_frame(check, &record->as.frame);
        return;
    case TAPEMARK_RECORD_CM:
        check->cms++;
        if (!truth_has_cm(frame_of(check, record->as.cm.seq), &record->as.cm))
            complain(check, "CM", record->as.cm.seq, record->as.cm.id);
        break;
    case TAPEMARK_RECORD_TM:
        check->tms++;
        if (!truth_has_tm(frame_of(check, record->as.tm.seq), &record->as.tm))
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
