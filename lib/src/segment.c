#include "segment.h"

#include "bars.h"
#include "judgement.h"
#include "mirror.h"
#include "real.h"
#include "report.h"
#include "sequence.h"

/* ---- Reading the CMs --------------------------------------------------------------------------------------- */

/* Where what all words share fits one way up this much better, the other way is not tried with all words. */
static const float turn_clear = 0.3f;

/* What shares less than this with all words is not worth comparing with each. A dark CM has three light alignment
 * cells only, among up to twelve that are its word's. */
static const float blank_min = 0.3f;
/* The same for a first look. */
static const float glance_min = 0.2f;

/* A CM that is believed has paid for itself: the budget bounds what is spent in vain. */
enum { CM_CREDIT = 2500 };

bool tmi_may_go_on(const tmi_reader *reader)
{
    tapemark_stats *stats = &reader->result->stats;
    if (stats->work < reader->work_max + (uint64_t)CM_CREDIT * stats->cms_read)
        return true;
    stats->limits |= TAPEMARK_LIMIT_WORK;
    return false;
}

void tmi_segment_read_cm(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    tmi_cells cells;
    for (int way = TMI_UPRIGHT; way <= TMI_TURNED; way++)
        segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = -1, .odds = 1};
    if (!tmi_marker_sample(reader->view, &segment->maps[cm], reader->config->contrast_min, &cells, &stats->work))
        return;
    if (cm < reader->kept_max)
        reader->kept[cm] = cells;
    tmi_cells turned = cells;
    tmi_cells_turn(&turned);
    float blank[2];
    tmi_blank_scores(&cells, &turned, blank);
    stats->work += TMI_BLANK_WORK;
    const float better = real_max(blank[TMI_UPRIGHT], blank[TMI_TURNED]);
    for (int way = TMI_UPRIGHT; way <= TMI_TURNED; way++) {
        segment->readings[way][cm].score = blank[way];
        if (blank[way] < blank_min || blank[way] < better - turn_clear)
            continue;
        tmi_word_match(way == TMI_UPRIGHT ? &cells : &turned, &reader->words, &segment->readings[way][cm],
                       &stats->work);
    }
}

/* Whether what lies between two finders may be a CM, by a first look; places off by half a module still are. */
static bool may_be_cm(const tmi_reader *reader, const tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    tmi_cells cells;
    tmi_marker_glance(reader->view, &segment->maps[cm], &segment->finders[cm], &segment->finders[cm + 1], &cells,
                      &stats->work);
    tmi_cells turned = cells;
    tmi_cells_turn(&turned);
    stats->work += TMI_BLANK_WORK;
    return tmi_blank_score(&cells) >= glance_min || tmi_blank_score(&turned) >= glance_min;
}

static void read_cm(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    const tmi_finder *left = &segment->finders[cm], *right = left + 1;
    stats->cms_tried++;
    for (int way = TMI_UPRIGHT; way <= TMI_TURNED; way++)
        segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = -1, .odds = 1};
    tmi_marker_map(left, right, &segment->maps[cm]);
    if (!may_be_cm(reader, segment, cm))
        return;
    tmi_marker_refine(reader->view, left, right, &segment->maps[cm], &stats->work);
    tmi_segment_read_cm(reader, segment, cm);
}

/* ---- TMs --------------------------------------------------------------------------------------------------- */

/* Bars have to correlate with ideal ones by this much; by more where no CM between them is believed, and by still
 * more where none looks like one: finder patterns with anything between them, and gratings at the ends, come to
 * 0.88. */
static const float bars_min = 0.62f, unread_bars_min = 0.9f, bare_bars_min = 0.96f;

/* Reads a part that lies in the image and has bars at both ends. */
static bool read_between_bars(const tmi_reader *reader, const tmi_segment *segment, int first, int count,
                              float least_bars, tmi_tm_reading *reading)
{
    tapemark_point corners[4];
    tmi_tm_corners(segment, first, count, false, corners);
    return tmi_corners_inside(reader->view, corners) &&
           tmi_tm_read(reader, segment, first, count, least_bars, reading);
}

/* How well bars have to correlate at the ends of these CMs. */
static float bars_needed(const tmi_segment *segment, const tapemark_reject *reasons, int first, int count)
{
    float best = -1;
    for (int cm = first; cm < first + count; cm++) {
        if (reasons[cm] == TMI_BELIEVED)
            return bars_min;
        best = real_max(best, real_max(segment->readings[TMI_UPRIGHT][cm].score,
                                       segment->readings[TMI_TURNED][cm].score));
    }
    return best >= glance_min ? unread_bars_min : bare_bars_min;
}

/* Reads the CMs first..first + count - 1 as a TM: `turn` is positive where the row runs as the tape reads, negative
 * where it runs the other way, and 0 where that is not known. Returns the TM's index, or TMI_NONE. */
static int read_tm(const tmi_reader *reader, tmi_segment *segment, const tapemark_reject *reasons, int first,
                   int count, float turn)
{
    tapemark_result *result = reader->result;
    tmi_tm_reading reading;
    const float least_bars = bars_needed(segment, reasons, first, count);
    /* Bars lie beyond the outermost finders, where the map of a single small CM is least sure. */
    if (!read_between_bars(reader, segment, first, count, least_bars, &reading) &&
        !(tmi_row_maps(reader->view, &segment->finders[first], count + 1, &segment->maps[first],
                       &result->stats.work) &&
          read_between_bars(reader, segment, first, count, least_bars, &reading))) {
        result->stats.rejects[TAPEMARK_REJECT_BARS]++;
        return TMI_NONE;
    }
    return tmi_report_tm(reader, segment, reasons, first, count, turn, &reading);
}

/* ---- The segment ------------------------------------------------------------------------------------------- */

/* Where a map has a CM's cells this near to where another has them, in modules, it shows nothing new. */
static const float same_place = 0.12f;

static bool shows_the_same(const tmi_homography *map, const tmi_homography *other)
{
    static const tmi_point corners[4] = {{5, -3}, {20, -3}, {20, 3}, {5, 3}};
    for (int i = 0; i < 4; i++) {
        const tmi_point at = tmi_project(map, corners[i].x, corners[i].y);
        const tmi_point before = tmi_project(other, corners[i].x, corners[i].y);
        const tmi_point next = tmi_project(map, corners[i].x + same_place, corners[i].y);
        const tmi_point below = tmi_project(map, corners[i].x, corners[i].y + same_place);
        const float moved = real_max(real_abs(at.x - before.x), real_abs(at.y - before.y));
        if (!(moved < real_max(real_abs(next.x - at.x), real_abs(next.y - at.y)) &&
              moved < real_max(real_abs(below.x - at.x), real_abs(below.y - at.y))))
            return false;
    }
    return true;
}

/* Locates the CMs anew, all finders of the part together, and reads again those that were not believed. */
static void read_again(const tmi_reader *reader, tmi_segment *segment, int first, int count,
                       const tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    tmi_homography before[TAPEMARK_TM_MAX_CMS];
    for (int cm = first; cm < first + count; cm++)
        before[cm] = segment->maps[cm];
    if (!tmi_row_maps(reader->view, &segment->finders[first], count + 1, &segment->maps[first],
                      &reader->result->stats.work))
        return;
    for (int cm = first; cm < first + count && tmi_may_go_on(reader); cm++)
        if (reasons[cm] != TMI_BELIEVED && !shows_the_same(&segment->maps[cm], &before[cm]))
            tmi_segment_read_cm(reader, segment, cm);
}

/* Reads the CMs first..first + count - 1, between which there are no bars. */
static void read_part(const tmi_reader *reader, tmi_segment *segment, int first, int count)
{
    if (count == 0)
        return;
    tapemark_reject reasons[TAPEMARK_TM_MAX_CMS];
    float evidence = tmi_turn_evidence(segment, first, count);
    const int believed = tmi_judge(reader, segment, first, count, evidence, reasons);
    /* A reflection must not take the work that the tape beside it needs. */
    if (believed < count && tmi_looks_like_tape(segment, first, count) &&
        (believed > 0 || !tmi_is_mirrored(reader, segment, first, count))) {
        read_again(reader, segment, first, count, reasons);
        evidence = tmi_turn_evidence(segment, first, count);
        if (tmi_judge(reader, segment, first, count, evidence, reasons) < count && real_abs(evidence) >= tmi_turn_min)
            tmi_sequence_read(reader, segment, first, count, evidence < 0, reasons);
    }
    const bool turned = evidence < 0, turn_is_clear = real_abs(evidence) >= tmi_turn_min;
    int tm = TMI_NONE;
    if (count >= TAPEMARK_TM_MIN_CMS && reader->result->tm_capacity > 0)
        tm = read_tm(reader, segment, reasons, first, count,
                     turn_is_clear ? evidence : tmi_turn_hint(reader, segment, first, count));
    for (int slot = 0; slot < count; slot++) {
        const int cm = turned ? first + count - 1 - slot : first + slot;
        if (reasons[cm] != TMI_BELIEVED) {
            reader->result->stats.rejects[reasons[cm]]++;
            continue;
        }
        reader->result->stats.cms_read++;
        tmi_report_cm(reader, segment, cm, turned, tm, slot);
    }
}

static bool has_bars(const tmi_reader *reader, tmi_bars_place place)
{
    return tmi_bars_score(reader->view, place, &reader->result->stats.work) >= bars_min;
}

/* Two pieces may hang so that the last finder of one is a CM's length from the first of the next: then there are
 * bars between them instead of a coding region, on one side at least. Coding regions correlate with bars by 0.4. */
static bool is_joint(const tmi_reader *reader, const tmi_segment *segment, int cm)
{
    if (real_max(segment->readings[TMI_UPRIGHT][cm].score, segment->readings[TMI_TURNED][cm].score) >= 0.7f)
        return false;
    /* What is between is not 25 modules long, so that the map between says nothing: each finder for itself. */
    const tmi_finder *left = &segment->finders[cm], *right = left + 1;
    const tmi_homography left_map = tmi_finder_map(left), right_map = tmi_finder_map(right);
    return has_bars(reader, (tmi_bars_place){&left_map, left, 0, 1}) ||
           has_bars(reader, (tmi_bars_place){&right_map, right, 0, -1});
}

int tmi_segment_read(const tmi_reader *reader, tmi_segment *segment, int finder_count, bool goes_on)
{
    int cm_count = 0;
    for (; cm_count < finder_count - 1 && tmi_may_go_on(reader); cm_count++)
        read_cm(reader, segment, cm_count);
    int first = 0;
    for (int cm = 0; cm < cm_count; cm++)
        if (is_joint(reader, segment, cm)) {
            read_part(reader, segment, first, cm - first);
            first = cm + 1;
        }
    const bool cut = goes_on && first == 0;
    if (cut && cm_count == finder_count - 1)
        reader->result->stats.limits |= TAPEMARK_LIMIT_LENGTH;
    if (!goes_on || cut) {
        read_part(reader, segment, first, cm_count - first);
        first = finder_count - 1;
    }
    for (int i = first; i < finder_count; i++)
        segment->finders[i - first] = segment->finders[i];
    return finder_count - first;
}
