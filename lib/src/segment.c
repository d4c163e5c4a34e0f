#include "segment.h"

#include "bars.h"
#include "code.h"
#include "real.h"

enum { UPRIGHT = 0, TURNED = 1 };

/* No reason to reject. */
static const tapemark_reject BELIEVED = TAPEMARK_REJECT_COUNT;

/* ---- Reading the CMs --------------------------------------------------------------------------------------- */

/* Where what all words share fits one way up this much better, the other way is not tried with all words. */
static const float turn_clear = 0.3f;

/* What shares less than this with all words is not worth comparing with each. A dark CM has three light alignment
 * cells only, among up to twelve that are its word's. */
static const float blank_min = 0.3f;
/* The same for a first look. */
static const float glance_min = 0.2f;

/* Comparing cells with what all words share, both ways up, costs as much as this many pixel reads. */
enum { BLANK_WORK = 250 };

/* A CM that is believed has paid for itself: the budget bounds what is spent in vain. */
enum { CM_CREDIT = 2500 };

bool tmi_may_go_on(const tmi_reader *reader)
{
    tapemark_stats *stats = &reader->result->stats;
    if (stats->work < (uint64_t)reader->config->work_budget + (uint64_t)CM_CREDIT * stats->cms_read)
        return true;
    stats->limits |= TAPEMARK_LIMIT_WORK;
    return false;
}

/* Reads the CM in the place where its map has it. */
static void read_both_ways(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    tmi_cells cells;
    for (int way = UPRIGHT; way <= TURNED; way++)
        segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = -1, .odds = 1};
    if (!tmi_marker_sample(reader->view, &segment->maps[cm], reader->config->contrast_min, &cells, &stats->work))
        return;
    tmi_cells turned = cells;
    tmi_cells_turn(&turned);
    const float blank[2] = {tmi_blank_score(&cells), tmi_blank_score(&turned)};
    stats->work += BLANK_WORK;
    const float better = real_max(blank[UPRIGHT], blank[TURNED]);
    for (int way = UPRIGHT; way <= TURNED; way++) {
        segment->readings[way][cm].score = blank[way];
        if (blank[way] < blank_min || blank[way] < better - turn_clear)
            continue;
        tmi_word_match(way == UPRIGHT ? &cells : &turned, &reader->words, &segment->readings[way][cm], &stats->work);
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
    stats->work += BLANK_WORK;
    return tmi_blank_score(&cells) >= glance_min || tmi_blank_score(&turned) >= glance_min;
}

static void read_cm(const tmi_reader *reader, tmi_segment *segment, int cm)
{
    tapemark_stats *stats = &reader->result->stats;
    const tmi_finder *left = &segment->finders[cm], *right = left + 1;
    stats->cms_tried++;
    for (int way = UPRIGHT; way <= TURNED; way++)
        segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = -1, .odds = 1};
    tmi_marker_map(left, right, &segment->maps[cm]);
    if (!may_be_cm(reader, segment, cm))
        return;
    tmi_marker_refine(reader->view, left, right, &segment->maps[cm], &stats->work);
    read_both_ways(reader, segment, cm);
}

/* Bars have to correlate with ideal ones by this much. */
static const float bars_min = 0.62f;
/* And those of tapes near enough to be read well do by this much. */
static const float clean_bars = 0.71f;

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

/* ---- Which readings to believe ------------------------------------------------------------------------------ */

/* Correlations below this say nothing about a CM; those of right readings have a median of 0.99. */
static const float score_min = 0.8f;
/* What shares this little with all words is no CM. */
static const float cm_score = 0.5f;

/* What a reading has to be to be believed. */
typedef struct standard {
    float odds;   /* that the second best word leaves this many times as much unexplained as the best one */
    int contrary; /* that no more cells than this show the opposite of the word: dirt, or a word that is none */
} standard;

/* For a CM that stands alone. Of grids that are no words (two cells flipped, words of five ones, true alignment cells
 * around random data; 2 500 of each, 3 px a module) 2 to 18 in a thousand get through; two to three times as many
 * would with one contradiction allowed. Of right CMs none is lost from 2 px a module on, 2 % at 1.2 px. */
static const standard alone = {1.6f, 0};
/* Where the next CM of the segment is sure and its id says the same: ids ascend along a segment. */
static const standard supported = {1.15f, 1};
/* Where it says otherwise. */
static const standard opposed = {2, 0};

/* There are 3 082 words of up to two ones, 76 076 of three and 1 426 425 of four: the more of them there are, the
 * likelier one fits by chance. */
static float odds_factor(int32_t id)
{
    const int32_t rank = id < 0 ? -id : id;
    return rank <= 3081 ? 1 : rank <= 79157 ? 1.25f : 1.55f;
}

/* The id `steps` CMs further on, but for its sign. */
static int32_t rank(const tmi_reading *reading, int steps)
{
    return (reading->id < 0 ? -reading->id : reading->id) + steps;
}

/* The reason not to believe a reading by that standard, or BELIEVED. */
static tapemark_reject doubt(const tmi_reader *reader, const tmi_reading *reading, const standard *needed)
{
    if (reading->id == TMI_NO_ID || reading->score < score_min || reading->contrary > needed->contrary ||
        tmi_reading_confidence(reading) < reader->config->confidence_min)
        return TAPEMARK_REJECT_SCORE;
    if (reading->odds < needed->odds * odds_factor(reading->id))
        return TAPEMARK_REJECT_MARGIN;
    return reading->unknown ? TAPEMARK_REJECT_UNKNOWN_ID : BELIEVED;
}

/* Judges the CM that stands at `cm` of the part first..last, read in the direction `step` (1 or -1) along the row. */
static tapemark_reject judge(const tmi_reader *reader, const tmi_reading *readings, int cm, int first, int last,
                             int step)
{
    const tmi_reading *own = &readings[cm];
    bool has_support = false, has_opposition = false;
    for (int side = -1; side <= 1; side += 2) {
        const int other = cm + side;
        if (other < first || other > last || own->id == TMI_NO_ID ||
            doubt(reader, &readings[other], &alone) != BELIEVED)
            continue;
        if (rank(own, side * step) == rank(&readings[other], 0))
            has_support = true;
        else
            has_opposition = true;
    }
    if (has_support)
        return doubt(reader, own, &supported);
    const tapemark_reject reason = doubt(reader, own, &alone);
    return reason == BELIEVED && has_opposition && doubt(reader, own, &opposed) != BELIEVED ? TAPEMARK_REJECT_CONFLICT
                                                                                            : reason;
}

/* ---- Reporting --------------------------------------------------------------------------------------------- */

static tapemark_point corner(const tmi_homography *map, float u, float v)
{
    const tmi_point at = tmi_project(map, u, v);
    return (tapemark_point){at.x, at.y};
}

static void set_corners(const tmi_homography *first, const tmi_homography *last, float before, float after,
                        bool turned, tapemark_point corners[4])
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

static void report_cm(const tmi_reader *reader, const tmi_segment *segment, int cm, bool turned, int tm, int slot)
{
    tapemark_result *result = reader->result;
    const tmi_reading *reading = &segment->readings[turned][cm];
    tapemark_cm out = {.id = reading->id,
                       .confidence = tmi_reading_confidence(reading),
                       .doubtful_cells = reading->doubtful,
                       .corrected_cells = reading->corrected,
                       .tm = (int16_t)tm,
                       .slot = (int16_t)(tm == TMI_NONE ? -1 : slot)};
    set_corners(&segment->maps[cm], &segment->maps[cm], 3.5f, 28.5f, turned, out.corners);
    if (!inside(reader->view, out.corners)) {
        result->stats.rejects[TAPEMARK_REJECT_ALIGNMENT]++;
        return;
    }
    if (result->cm_count == result->cm_capacity) {
        if (result->cm_capacity > 0)
            result->stats.limits |= TAPEMARK_LIMIT_CMS;
        return;
    }
    tapemark_word_from_id(out.id, &out.word);
    result->cms[result->cm_count++] = out;
}

/* Whether the row runs as upright tapes do by the caller's hint: positive, or negative where it runs against it; 0
 * without a hint or across it. */
static float turn_hint(const tmi_reader *reader, const tmi_segment *segment, int first, int count)
{
    if (!reader->config->roll_known)
        return 0;
    const tmi_point from = segment->finders[first].centre, to = segment->finders[first + count].centre;
    const float dx = to.x - from.x, dy = to.y - from.y, length = real_sqrt(dx * dx + dy * dy);
    const float along = (reader->upright.x * dx + reader->upright.y * dy) / length;
    return real_abs(along) > 0.2f ? along : 0;
}

/* Whether the blocks of the TM are as light or dark as the CMs that were read; and where some were, whether the
 * others look like CMs at all, or like something that covers them. */
static bool agrees(const tmi_segment *segment, const tapemark_reject *reasons, int first, int count, bool turned,
                   uint32_t code)
{
    uint32_t known = 0, light = 0; /* the first CM's bit highest, as in the code */
    bool covered = false;
    for (int cm = first; cm < first + count; cm++) {
        const tmi_reading *reading = &segment->readings[turned][cm];
        known = known << 1 | (reasons[cm] == BELIEVED ? 1u : 0u);
        light = light << 1 | (reading->id >= 0 ? 1u : 0u);
        covered = covered || reading->score < cm_score;
    }
    return ((code ^ light) & known) == 0 && !(known && covered);
}

/* How sure the CMs make a TM: where some were read and others not, something may lie on those. Where none can be
 * read, the TM is seen from afar, and they say nothing. */
static float vouched(const tapemark_reject *reasons, int first, int count)
{
    int read = 0;
    for (int cm = first; cm < first + count; cm++)
        read += reasons[cm] == BELIEVED;
    return read > 0 ? 0.5f + 0.5f * (float)read / (float)count : 1;
}

static void tm_corners(const tmi_segment *segment, int first, int count, bool turned, tapemark_point corners[4])
{
    const float ink = 3.5f + TAPEMARK_BAR_MODULES;
    set_corners(&segment->maps[first], &segment->maps[first + count - 1], ink, TAPEMARK_CM_PITCH_MODULES + ink,
                turned, corners);
}

/* Reads a part that lies in the image and has bars at both ends. */
static bool read_between_bars(const tmi_reader *reader, const tmi_segment *segment, int first, int count,
                              tmi_tm_reading *reading)
{
    tapemark_point corners[4];
    tm_corners(segment, first, count, false, corners);
    return inside(reader->view, corners) && tmi_tm_read(reader, segment, first, count, bars_min, reading);
}

/* Adds a TM to the result that was read so, if its vote is enough and the CMs agree. Returns its index, or TMI_NONE.
 */
static int add_tm(const tmi_reader *reader, const tmi_segment *segment, const tapemark_reject *reasons, int first,
                  int count, float turn, const tmi_tm_reading *reading)
{
    tapemark_result *result = reader->result;
    const bool turned = turn < 0;
    if (reading->vote < reader->config->vote_min || !agrees(segment, reasons, first, count, turned, reading->code)) {
        result->stats
            .rejects[reading->vote < reader->config->vote_min ? TAPEMARK_REJECT_VOTE : TAPEMARK_REJECT_CONFLICT]++;
        return TMI_NONE;
    }
    if (result->tm_count == result->tm_capacity) {
        if (result->tm_capacity > 0)
            result->stats.limits |= TAPEMARK_LIMIT_TMS;
        return TMI_NONE;
    }
    tapemark_tm out = {.length = (uint8_t)count, .directed = turn != 0, .vote = reading->vote};
    tm_corners(segment, first, count, turned, out.corners);
    out.confidence = reading->vote * real_min(1, reading->bars * (1 / clean_bars)) * vouched(reasons, first, count);
    for (int i = 0; i < count; i++)
        out.code[i] = reading->code >> (turned ? i : count - 1 - i) & 1 ? '1' : '0';
    result->tms[result->tm_count] = out;
    return (int)result->tm_count++;
}

/* Reads the CMs first..first + count - 1 as a TM: `turn` is positive where the row runs as the tape reads, negative
 * where it runs the other way, and 0 where that is not known. Returns the TM's index, or TMI_NONE. */
static int report_tm(const tmi_reader *reader, tmi_segment *segment, const tapemark_reject *reasons, int first,
                     int count, float turn)
{
    tapemark_result *result = reader->result;
    tmi_tm_reading reading;
    /* Bars lie beyond the outermost finders, where the map of a single small CM is least sure. */
    if (!read_between_bars(reader, segment, first, count, &reading) &&
        !(tmi_row_maps(reader->view, &segment->finders[first], count + 1, &segment->maps[first],
                       &result->stats.work) &&
          read_between_bars(reader, segment, first, count, &reading))) {
        result->stats.rejects[TAPEMARK_REJECT_BARS]++;
        return TMI_NONE;
    }
    return add_tm(reader, segment, reasons, first, count, turn, &reading);
}

/* ---- The segment ------------------------------------------------------------------------------------------- */

/* Judges all CMs of a part; returns how many are believed. */
static int judge_part(const tmi_reader *reader, const tmi_segment *segment, int first, int count, float evidence,
                      tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    const bool turned = evidence < 0;
    int believed = 0;
    for (int cm = first; cm < first + count; cm++) {
        reasons[cm] = real_abs(evidence) >= turn_min
                          ? judge(reader, segment->readings[turned], cm, first, first + count - 1, turned ? -1 : 1)
                          : TAPEMARK_REJECT_ALIGNMENT;
        believed += reasons[cm] == BELIEVED;
    }
    return believed;
}

/* Locates the CMs anew, all finders of the part together, and reads again those that were not believed. */
static void read_again(const tmi_reader *reader, tmi_segment *segment, int first, int count,
                       const tapemark_reject reasons[TAPEMARK_TM_MAX_CMS])
{
    if (!tmi_row_maps(reader->view, &segment->finders[first], count + 1, &segment->maps[first],
                      &reader->result->stats.work))
        return;
    for (int cm = first; cm < first + count && tmi_may_go_on(reader); cm++)
        if (reasons[cm] != BELIEVED)
            read_both_ways(reader, segment, cm);
}

/* Whether at least one of the CMs shares with all words what CMs do. */
static bool looks_like_tape(const tmi_segment *segment, int first, int count)
{
    for (int cm = first; cm < first + count; cm++)
        if (real_max(segment->readings[UPRIGHT][cm].score, segment->readings[TURNED][cm].score) >= score_min)
            return true;
    return false;
}

/* Reads the CMs first..first + count - 1, between which there are no bars. */
static void read_part(const tmi_reader *reader, tmi_segment *segment, int first, int count)
{
    if (count == 0)
        return;
    tapemark_reject reasons[TAPEMARK_TM_MAX_CMS];
    float evidence = turn_evidence(segment, first, count);
    if (judge_part(reader, segment, first, count, evidence, reasons) < count &&
        looks_like_tape(segment, first, count)) {
        read_again(reader, segment, first, count, reasons);
        evidence = turn_evidence(segment, first, count);
        judge_part(reader, segment, first, count, evidence, reasons);
    }
    const bool turned = evidence < 0, turn_is_clear = real_abs(evidence) >= turn_min;
    int tm = TMI_NONE;
    if (count >= TAPEMARK_TM_MIN_CMS && reader->result->tm_capacity > 0)
        tm = report_tm(reader, segment, reasons, first, count,
                       turn_is_clear ? evidence : turn_hint(reader, segment, first, count));
    for (int slot = 0; slot < count; slot++) {
        const int cm = turned ? first + count - 1 - slot : first + slot;
        if (reasons[cm] != BELIEVED) {
            reader->result->stats.rejects[reasons[cm]]++;
            continue;
        }
        reader->result->stats.cms_read++;
        report_cm(reader, segment, cm, turned, tm, slot);
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
    if (real_max(segment->readings[UPRIGHT][cm].score, segment->readings[TURNED][cm].score) >= 0.7f)
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

/* ---- Tapes far away ---------------------------------------------------------------------------------------- */

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
    const int way = turn_of(read, &segment->maps[cm]) > 0 ? UPRIGHT : TURNED;
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
            read_both_ways(reader, segment, cm);
        else
            for (int way = UPRIGHT; way <= TURNED; way++)
                segment->readings[way][cm] = (tmi_reading){.id = TMI_NO_ID, .score = cm_score, .odds = 1};
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
    } else if (known == TMI_NONE && reason == BELIEVED) {
        result->stats.cms_read++;
        report_cm(reader, segment, cm, turned, tm, slot);
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
    float evidence = turn_evidence(segment, 0, cm_count);
    judge_part(reader, segment, 0, cm_count, evidence, reasons);
    if (real_abs(evidence) < turn_min)
        evidence = turn != 0 ? turn : turn_hint(reader, segment, 0, cm_count);
    const bool turned = evidence < 0;
    tapemark_point corners[4];
    tm_corners(segment, 0, cm_count, false, corners);
    const bool is_tm = tm && inside(reader->view, corners);
    const int index = is_tm ? add_tm(reader, segment, reasons, 0, cm_count, evidence, tm) : TMI_NONE;
    for (int slot = 0; slot < cm_count; slot++) {
        const int cm = turned ? cm_count - 1 - slot : slot;
        report_far_cm(reader, segment, cm, turned, index, slot, reasons[cm]);
    }
}
