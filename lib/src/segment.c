#include "segment.h"

#include "bars.h"
#include "code.h"
#include "real.h"

enum { UPRIGHT = 0, TURNED = 1 };

/* ---- Reading the CMs --------------------------------------------------------------------------------------- */

/* Where what all words share fits one way up this much better, the other way is not tried with all words. */
static const float turn_clear = 0.3f;

static void read_both_ways(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    tmi_cells cells;
    stats->cms_tried++;
    tmi_marker_map(reader->view, &segment->finders[cm], &segment->finders[cm + 1], &segment->maps[cm], &stats->work);
    for (int way = UPRIGHT; way <= TURNED; way++)
        segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = -1};
    if (!tmi_marker_sample(reader->view, &segment->maps[cm], reader->config->contrast_min, &cells, &stats->work))
        return;
    tmi_cells turned = cells;
    tmi_cells_turn(&turned);
    const float blank[2] = {tmi_blank_score(&cells), tmi_blank_score(&turned)};
    const float better = real_max(blank[UPRIGHT], blank[TURNED]);
    for (int way = UPRIGHT; way <= TURNED; way++) {
        segment->readings[way][cm].score = blank[way];
        if (blank[way] > better - turn_clear)
            tmi_word_match(way == UPRIGHT ? &cells : &turned, &reader->words, &segment->readings[way][cm]);
    }
}

/* Correlations below this say nothing about a CM; those of right readings have a median of 0.97. */
static const float score_min = 0.8f;
/* The second best word must leave this many times as much unexplained as the best one. Over some 8000 CMs of
 * rendered and real frames, a third of them below 1.5 px a module, no wrong word reached it. */
static const float odds_min = 1.45f;
/* Cells that show the opposite of the word: dirt, or a word that is none. */
static const int contrary_max = 1;
/* Sum over the CMs by which one way up must fit better than the other. */
static const float turn_min = 0.05f;

/* Which way up the CMs say the segment is: positive as the row runs, negative standing on the head. */
static float turn_evidence(const tmi_segment *segment, int first, int count)
{
    float sum = 0;
    for (int cm = first; cm < first + count; cm++) {
        const float upright = segment->readings[UPRIGHT][cm].score, turned = segment->readings[TURNED][cm].score;
        if (real_max(upright, turned) >= 0.5f)
            sum += upright - turned;
    }
    return sum;
}

/* ---- Reporting --------------------------------------------------------------------------------------------- */

static tapemark_point corner(const tmi_homography *map, float u, float v)
{
    const tmi_point at = tmi_project(map, u, v);
    return (tapemark_point){at.x, at.y};
}

static void set_corners(const tmi_homography *first, const tmi_homography *last, float before, float after, bool turned,
                        tapemark_point corners[4])
{
    const int start = turned ? 2 : 0;
    corners[start] = corner(first, -before, -3.5f);
    corners[(start + 1) & 3] = corner(last, after, -3.5f);
    corners[(start + 2) & 3] = corner(last, after, 3.5f);
    corners[(start + 3) & 3] = corner(first, -before, 3.5f);
}

static bool inside(const tmi_view *view, const tapemark_point corners[4])
{
    for (int i = 0; i < 4; i++)
        if (!(corners[i].x_px >= -1 && corners[i].y_px >= -1 && corners[i].x_px <= (float)view->width &&
              corners[i].y_px <= (float)view->height))
            return false;
    return true;
}

/* The reason not to report a reading, or TAPEMARK_REJECT_COUNT when there is none. */
static tapemark_reject doubt(const tmi_reader *reader, const tmi_reading *reading)
{
    if (reading->id == TMI_NO_ID || reading->score < score_min)
        return TAPEMARK_REJECT_SCORE;
    if (reading->contrary > contrary_max)
        return TAPEMARK_REJECT_SCORE;
    if (reading->odds < odds_min)
        return TAPEMARK_REJECT_MARGIN;
    if (reading->unknown)
        return TAPEMARK_REJECT_UNKNOWN_ID;
    if (reading->score < reader->config->confidence_min)
        return TAPEMARK_REJECT_SCORE;
    return TAPEMARK_REJECT_COUNT;
}

static void report_cm(const tmi_reader *reader, const tmi_segment *segment, int cm, bool turned, int tm, int slot)
{
    tapemark_result *result = reader->result;
    const tmi_reading *reading = &segment->readings[turned][cm];
    tapemark_cm out = {.id = reading->id, .confidence = real_min(1, reading->score), .doubtful_cells = reading->doubtful,
                       .corrected_cells = reading->corrected, .tm = (int16_t)tm,
                       .slot = (int16_t)(tm < 0 ? -1 : slot)};
    const tapemark_reject reason = doubt(reader, reading);
    if (reason != TAPEMARK_REJECT_COUNT) {
        result->stats.rejects[reason]++;
        return;
    }
    set_corners(&segment->maps[cm], &segment->maps[cm], 3.5f, 28.5f, turned, out.corners);
    if (!inside(reader->view, out.corners))
        return;
    if (result->cm_count == result->cm_capacity) {
        result->stats.limits |= TAPEMARK_LIMIT_CMS;
        return;
    }
    tapemark_word_from_id(out.id, &out.word);
    result->cms[result->cm_count++] = out;
}

/* The tape's direction in the image against the caller's hint: positive along it, 0 without a hint. */
static float turn_hint(const tmi_reader *reader, const tmi_segment *segment, int first, int count)
{
    (void)reader; (void)segment; (void)first; (void)count;
    return 0;
}

/* Returns the TM's index, or TMI_NONE. */
static int report_tm(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float turn)
{
    tapemark_result *result = reader->result;
    tmi_tm_reading reading;
    tmi_tm_read(reader, segment, first, count, &reading);
    if (reading.vote < reader->config->vote_min) {
        result->stats.rejects[TAPEMARK_REJECT_VOTE]++;
        return TMI_NONE;
    }
    if (result->tm_count == result->tm_capacity) {
        result->stats.limits |= TAPEMARK_LIMIT_TMS;
        return TMI_NONE;
    }
    if (real_abs(turn) < turn_min)
        turn = turn_hint(reader, segment, first, count);
    const bool turned = turn < 0;
    tapemark_tm *out = &result->tms[result->tm_count];
    *out = (tapemark_tm){.length = (uint8_t)count, .directed = real_abs(turn) >= turn_min, .vote = reading.vote,
                         .confidence = real_min(1, reading.vote * real_min(1, 1.4f * reading.bars))};
    for (int i = 0; i < count; i++) {
        const int bit = turned ? i : count - 1 - i;
        out->code[i] = reading.code >> bit & 1 ? '1' : '0';
    }
    const float ink = 3.5f + TAPEMARK_BAR_MODULES;
    set_corners(&segment->maps[first], &segment->maps[first + count - 1], ink, TAPEMARK_CM_PITCH_MODULES + ink, turned,
                out->corners);
    return (int)result->tm_count++;
}

/* ---- The segment ------------------------------------------------------------------------------------------- */

static const float bars_min = 0.5f;

static bool has_bars(const tmi_reader *reader, tmi_bars_place place)
{
    return tmi_bars_score(reader->view, place, &reader->result->stats.work) >= bars_min;
}

static void read_part(const tmi_reader *reader, tmi_segment *segment, int first, int count)
{
    if (count == 0)
        return;
    const float turn = turn_evidence(segment, first, count);
    int tm = TMI_NONE;
    if (count >= TAPEMARK_TM_MIN_CMS) {
        const tmi_bars_place left = {&segment->maps[first], 0, -1};
        const tmi_bars_place right = {&segment->maps[first + count - 1], TAPEMARK_CM_PITCH_MODULES, 1};
        if (has_bars(reader, left) && has_bars(reader, right))
            tm = report_tm(reader, segment, first, count, turn);
        else
            reader->result->stats.rejects[TAPEMARK_REJECT_BARS]++;
    }
    const bool turned = turn < 0;
    for (int i = 0; i < count; i++) {
        const int cm = turned ? first + count - 1 - i : first + i;
        if (real_abs(turn) >= turn_min)
            report_cm(reader, segment, cm, turned, tm, i);
        else
            reader->result->stats.rejects[TAPEMARK_REJECT_ALIGNMENT]++;
    }
}

/* Two TMs may hang so that the last finder of one is a CM's length from the first of the next: then there are
 * bars between them instead of a coding region. */
static bool is_joint(const tmi_reader *reader, const tmi_segment *segment, int cm)
{
    if (real_max(segment->readings[UPRIGHT][cm].score, segment->readings[TURNED][cm].score) >= 0.7f)
        return false;
    const tmi_bars_place left = {&segment->maps[cm], 0, 1};
    const tmi_bars_place right = {&segment->maps[cm], TAPEMARK_CM_PITCH_MODULES, -1};
    return has_bars(reader, left) && has_bars(reader, right);
}

void tmi_segment_read(const tmi_reader *reader, tmi_segment *segment, int finder_count)
{
    segment->cm_count = finder_count - 1;
    for (int cm = 0; cm < segment->cm_count; cm++)
        read_both_ways(reader, segment, cm);
    int first = 0;
    for (int cm = 0; cm < segment->cm_count; cm++)
        if (is_joint(reader, segment, cm)) {
            read_part(reader, segment, first, cm - first);
            first = cm + 1;
        }
    read_part(reader, segment, first, segment->cm_count - first);
}
