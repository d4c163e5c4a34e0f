#include "frame_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"
#include "picture_truth.h"

static void complain(frame_check *check, const char *what, ...)
{
    va_list arguments;
    if (check->wrong++ > 0)
        return;
    int length = snprintf(check->complaint, sizeof check->complaint, "seq %u, after %u with picture %lld: ",
                          check->group.seq, check->seq, (long long)check->number);
    va_start(arguments, what);
    vsnprintf(check->complaint + length, sizeof check->complaint - (size_t)length, what, arguments);
    va_end(arguments);
}

void frame_check_begin(frame_check *check, int32_t width_px, int32_t height_px, double rate_hz)
{
    *check = (frame_check){.width_px = width_px, .height_px = height_px, .rate_hz = rate_hz, .number = -1};
}

void frame_check_break(frame_check *check)
{
    check->group.begun = false;
    check->sequence_known = check->capture_known = false;
}

/* ---- Markers --------------------------------------------------------------------------------------------------- */

/* The number of the picture, by its CM. -1: it is not among the records. */
static int64_t number_in(frame_check *check)
{
    int64_t number = -1;
    for (size_t i = 0; i < check->group.cm_count; i++) {
        const int32_t id = check->group.cms[i].id;
        if (id < PICTURE_NUMBER_ID)
            continue;
        if (number >= 0)
            complain(check, "two numbers, %ld and %ld", (long)number, (long)id - PICTURE_NUMBER_ID);
        number = id - PICTURE_NUMBER_ID;
    }
    return number;
}

static bool fits(const frame_check *check, uint32_t number, bool with_number)
{
    true_frame picture;
    picture_truth(check->width_px, check->height_px, number, &picture);
    for (size_t i = 0; i < check->group.cm_count; i++) {
        const tapemark_cm_record *cm = &check->group.cms[i];
        if ((with_number || cm->id < PICTURE_NUMBER_ID) && !truth_has_cm(&picture, cm))
            return false;
    }
    for (size_t i = 0; i < check->group.tm_count; i++)
        if (!truth_has_tm(&picture, &check->group.tms[i]))
            return false;
    return true;
}

/* Pictures come in the order of their numbers, and no faster than time goes. */
static void check_number(frame_check *check, int64_t number)
{
    const frame_group *group = &check->group;
    const int64_t step = number - check->number;
    if (check->number >= 0 && (step < 0 || (step == 0 && check->each_is_new)))
        complain(check, "picture %lld came before", (long long)number);
    check->repeated += check->number >= 0 && step == 0;
    if (group->headed) {
        const double seconds = (group->head.capture_us - check->number_capture_us) * 1e-6;
        if (check->number >= 0 && (double)step > 2 * check->rate_hz * seconds + 30)
            complain(check, "picture %lld after %.2f s", (long long)number, seconds);
        check->number_capture_us = group->head.capture_us;
    }
    check->number = number;
}

static void check_markers(frame_check *check)
{
    const frame_group *group = &check->group;
    const int64_t number = number_in(check);
    if (number >= 0) {
        if (!fits(check, (uint32_t)number, true))
            complain(check, "%zu CMs, the first %ld, and %zu TMs are not those of picture %lld", group->cm_count,
                     (long)group->cms[0].id, group->tm_count, (long long)number);
        check_number(check, number);
        return;
    }
    /* Without the number, it has to be one of the kinds. */
    for (uint32_t kind = 0; kind < PICTURE_KINDS; kind++)
        if (fits(check, kind, false))
            return;
    complain(check, "%zu CMs, the first %ld, and %zu TMs are of no picture", group->cm_count, (long)group->cms[0].id,
             group->tm_count);
}

/* ---- FRAME ----------------------------------------------------------------------------------------------------- */

static void check_sequence(frame_check *check)
{
    const tapemark_frame_record *head = &check->group.head;
    const uint16_t step = (uint16_t)(head->seq - check->seq);
    const bool tells_drops = (head->flags & TAPEMARK_FRAME_FRAMES_DROPPED) != 0;
    const bool all_told = head->dropped < UINT8_MAX;
    if (tells_drops != (head->dropped > 0))
        complain(check, "dropped %u, flags %04x", head->dropped, head->flags);
    if (check->sequence_known && all_told &&
        (check->bytes_are_damaged ? step <= head->dropped : step != head->dropped + 1))
        complain(check, "dropped %u", head->dropped);
    check->dropped += head->dropped;
    check->seq = head->seq;
    check->sequence_known = true;
}

/* How long after the time that it tells, give or take what is always between the clocks. */
static void take_lag(frame_check *check)
{
    const tapemark_frame_record *head = &check->group.head;
    const uint32_t sent_us = head->capture_us + 10 * (uint32_t)head->age_10us;
    const uint32_t ahead_us = (uint32_t)(check->group.arrival_ns / 1000) - sent_us;
    if (!check->clock_known)
        check->clock_us = ahead_us;
    check->clock_known = true;
    const int32_t lag_us = (int32_t)(ahead_us - check->clock_us);
    if (lag_us < 0)
        check->clock_us = ahead_us;
    check->lag_us = lag_us < 0 ? 0 : lag_us;
    if (check->lag_us > check->lag_max_us)
        check->lag_max_us = check->lag_us;
}

static void check_time(frame_check *check)
{
    const tapemark_frame_record *head = &check->group.head;
    if (check->capture_known && (int32_t)(head->capture_us - check->capture_us) <= 0)
        complain(check, "captured at %lu us, after %lu", (unsigned long)head->capture_us,
                 (unsigned long)check->capture_us);
    check->capture_us = head->capture_us;
    check->capture_known = true;
    check->ages_10us[check->age_count++ % FRAME_CHECK_AGES] = head->age_10us;
    take_lag(check);
}

static void check_loss(frame_check *check)
{
    const frame_group *group = &check->group;
    const tapemark_frame_record *head = &group->head;
    check->losses++;
    if (head->records > 0 || group->cm_count + group->tm_count > 0)
        complain(check, "markers with a lost camera");
    if ((head->flags & ~TAPEMARK_FRAME_FRAMES_DROPPED) != TAPEMARK_FRAME_CAMERA_LOST || head->width_px != 0)
        complain(check, "flags %04x with a lost camera", head->flags);
}

/* Pictures of others, such as vivid's own at its start, may be bright or blurred. */
static void check_head(frame_check *check)
{
    const frame_group *group = &check->group;
    const unsigned flags = group->head.flags & ~(unsigned)TAPEMARK_FRAME_FRAMES_DROPPED;
    check->frames++;
    check_sequence(check);
    if (flags & TAPEMARK_FRAME_CAMERA_LOST) {
        check_loss(check);
        return;
    }
    if (group->head.width_px != check->width_px || group->head.height_px != check->height_px)
        complain(check, "%u x %u px", group->head.width_px, group->head.height_px);
    if (!(flags & TAPEMARK_FRAME_TIMED))
        complain(check, "no time");
    if (group->head.records > 0 ? flags != TAPEMARK_FRAME_TIMED : !(flags & TAPEMARK_FRAME_NOTHING_SEEN))
        complain(check, "%u records, flags %04x", group->head.records, flags);
    check_time(check);
    check->empty += group->head.records == 0;
}

/* ---- Groups ---------------------------------------------------------------------------------------------------- */

/* All of a frame has come, as far as it comes. */
static void judge(frame_check *check)
{
    const frame_group *group = &check->group;
    const size_t markers = group->cm_count + group->tm_count;
    if (!group->begun)
        return;
    if (group->headed)
        check_head(check);
    if (markers > 0)
        check_markers(check);
    check->cms += group->cm_count;
    check->tms += group->tm_count;
    check->whole += group->headed && group->cm_count == PICTURE_CMS + 1 && group->tm_count == 1;
    check->incomplete += !group->headed || markers < group->head.records;
    if (!check->bytes_are_damaged && (!group->headed || markers != group->head.records))
        complain(check, "%zu of %u records", markers, group->head.records);
    check->group.begun = false;
}

static void begin_group(frame_check *check, uint16_t seq, int64_t arrival_ns)
{
    judge(check);
    check->group = (frame_group){.begun = true, .seq = seq, .arrival_ns = arrival_ns};
}

static void take_status(frame_check *check, const tapemark_status_record *status)
{
    check->status_flags |= status->flags;
    if (!(status->flags & TAPEMARK_STATUS_LATENCY))
        return;
    check->p50_tenth_ms[check->status_count % FRAME_CHECK_AGES] = status->latency_p50_tenth_ms;
    check->p99_tenth_ms[check->status_count++ % FRAME_CHECK_AGES] = status->latency_p99_tenth_ms;
}

static void take_marker(frame_check *check, const tapemark_record *record, int64_t arrival_ns)
{
    frame_group *group = &check->group;
    const bool is_cm = record->type == TAPEMARK_RECORD_CM;
    const uint16_t seq = is_cm ? record->as.cm.seq : record->as.tm.seq;
    if (!group->begun || group->seq != seq)
        begin_group(check, seq, arrival_ns);
    if (group->cm_count == FRAME_CHECK_GROUP || group->tm_count == FRAME_CHECK_GROUP)
        complain(check, "too many markers");
    else if (is_cm)
        group->cms[group->cm_count++] = record->as.cm;
    else
        group->tms[group->tm_count++] = record->as.tm;
}

void frame_check_record(frame_check *check, const tapemark_record *record, int64_t arrival_ns)
{
    switch (record->type) {
    case TAPEMARK_RECORD_FRAME:
        begin_group(check, record->as.frame.seq, arrival_ns);
        check->group.headed = true;
        check->group.head = record->as.frame;
        break;
    case TAPEMARK_RECORD_CM:
    case TAPEMARK_RECORD_TM:
        take_marker(check, record, arrival_ns);
        break;
    case TAPEMARK_RECORD_STATUS:
        take_status(check, &record->as.status);
        break;
    case TAPEMARK_RECORD_DEVICE:
    case TAPEMARK_RECORD_ANSWER:
        break;
    default:
        complain(check, "record of type %u", record->type);
    }
    const frame_group *group = &check->group;
    if (group->begun && group->headed && group->cm_count + group->tm_count >= group->head.records)
        judge(check);
}

/* ---- Times ----------------------------------------------------------------------------------------------------- */

static int by_age(const void *a, const void *b)
{
    const uint32_t first = *(const uint32_t *)a, second = *(const uint32_t *)b;
    return (first > second) - (first < second);
}

double frame_check_age_ms(frame_check *check, double share)
{
    const size_t count = check->age_count < FRAME_CHECK_AGES ? check->age_count : FRAME_CHECK_AGES;
    if (count == 0)
        return NAN;
    qsort(check->ages_10us, count, sizeof *check->ages_10us, by_age);
    return check->ages_10us[(size_t)(share * (double)(count - 1))] * 0.01;
}

static int by_time(const void *a, const void *b)
{
    return *(const uint16_t *)a - *(const uint16_t *)b;
}

static double share_of_status_ms(uint16_t *tenth_ms, size_t all, double share)
{
    const size_t count = all < FRAME_CHECK_AGES ? all : FRAME_CHECK_AGES;
    if (count == 0)
        return NAN;
    qsort(tenth_ms, count, sizeof *tenth_ms, by_time);
    return tenth_ms[(size_t)(share * (double)(count - 1))] * 0.1;
}

double frame_check_p50_ms(frame_check *check)
{
    return share_of_status_ms(check->p50_tenth_ms, check->status_count, 0.5);
}

double frame_check_p99_ms(frame_check *check)
{
    return share_of_status_ms(check->p99_tenth_ms, check->status_count, 1);
}
