/* Rows of CMs that were located as a whole, too far away for their finder patterns to be seen one by one. */
#include "judgement.h"
#include "real.h"
#include "report.h"
#include "sequence.h"

static tapemark_point middle_of(const tapemark_point corners[4])
{
    return (tapemark_point){0.25f * (corners[0].x_px + corners[1].x_px + corners[2].x_px + corners[3].x_px),
                            0.25f * (corners[0].y_px + corners[1].y_px + corners[2].y_px + corners[3].y_px)};
}

/* The CM of the result that was read where this one is, or TMI_NONE. */
static int read_before(const tmi_reader *reader, const tmi_homography *map)
{
    const tmi_point middle = tmi_project(map, 12.5f, 0), end = tmi_project(map, 20, 0);
    const float dx = end.x - middle.x, dy = end.y - middle.y;
    for (size_t i = 0; i < reader->result->cm_count; i++) {
        const tapemark_point at = middle_of(reader->result->cms[i].corners);
        const float x = at.x_px - middle.x, y = at.y_px - middle.y;
        if (x * x + y * y < dx * dx + dy * dy)
            return (int)i;
    }
    return TMI_NONE;
}

/* Which way up a CM of the result lies on the row: positive as the row runs. */
static float turn_of(const tapemark_cm *cm, const tmi_homography *map)
{
    const tmi_point a = tmi_project(map, 0, 0), b = tmi_project(map, TAPEMARK_CM_PITCH_MODULES, 0);
    return (cm->corners[1].x_px - cm->corners[0].x_px) * (b.x - a.x) +
           (cm->corners[1].y_px - cm->corners[0].y_px) * (b.y - a.y);
}

/* Takes over what was read before. */
static void take_over(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    const int known = read_before(reader, &segment->maps[cm]);
    if (known == TMI_NONE)
        return;
    const tapemark_cm *read = &reader->result->cms[known];
    const int way = turn_of(read, &segment->maps[cm]) > 0 ? TMI_UPRIGHT : TMI_TURNED;
    segment->readings[way][cm] = (tmi_reading){.id = read->id, .score = 1, .odds = 4};
    segment->readings[!way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = 0, .odds = 1};
}

/* Reads what can be read of the CMs. Where none can, they say nothing: neither way up, nor that something covers
 * them. */
static void read_cms(const tmi_reader *reader, tmi_segment *segment, int cm_count, bool resolved)
{
    for (int cm = 0; cm < cm_count; cm++) {
        reader->result->stats.cms_tried++;
        if (resolved && tmi_may_go_on(reader))
            tmi_segment_read_cm(reader, segment, cm);
        else
            for (int way = TMI_UPRIGHT; way <= TMI_TURNED; way++)
                segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = tmi_cm_score, .odds = 1};
        take_over(reader, segment, cm);
    }
}

/* Appends a CM that is believed, or tells the one that was read before which TM it belongs to. */
static void report_far_cm(const tmi_reader *reader, const tmi_segment *segment, int cm, bool turned, int tm, int slot,
                          tapemark_reject reason)
{
    tapemark_result *result = reader->result;
    const int known = read_before(reader, &segment->maps[cm]);
    if (known != TMI_NONE && tm != TMI_NONE) {
        result->cms[known].tm = (int16_t)tm;
        result->cms[known].slot = (int16_t)slot;
    } else if (known == TMI_NONE && reason == TMI_BELIEVED) {
        result->stats.cms_read++;
        tmi_report_cm(reader, segment, cm, turned, tm, slot);
    } else if (known == TMI_NONE) {
        result->stats.rejects[reason]++;
    }
}

void tmi_segment_read_far(const tmi_reader *reader, tmi_segment *segment, int cm_count, const tmi_tm_reading *tm,
                          float turn, bool resolved)
{
    tapemark_reject reasons[TAPEMARK_TM_MAX_CMS];
    reader->result->stats.segments++;
    read_cms(reader, segment, cm_count, resolved);
    float evidence = tmi_turn_evidence(segment, 0, cm_count);
    if (tmi_judge(reader, segment, 0, cm_count, evidence, reasons) < cm_count && real_abs(evidence) >= tmi_turn_min)
        tmi_sequence_read(reader, segment, 0, cm_count, evidence < 0, reasons);
    if (real_abs(evidence) < tmi_turn_min)
        evidence = turn != 0 ? turn : tmi_turn_hint(reader, segment, 0, cm_count);
    const bool turned = evidence < 0;
    tapemark_point corners[4];
    tmi_tm_corners(segment, 0, cm_count, false, corners);
    const bool is_tm = tm && tmi_corners_inside(reader->view, corners);
    const int index = is_tm ? tmi_report_tm(reader, segment, reasons, 0, cm_count, evidence, tm) : TMI_NONE;
    for (int slot = 0; slot < cm_count; slot++) {
        const int cm = turned ? cm_count - 1 - slot : slot;
        report_far_cm(reader, segment, cm, turned, index, slot, reasons[cm]);
    }
}
