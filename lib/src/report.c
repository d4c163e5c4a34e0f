#include "report.h"

#include "judgement.h"
#include "mirror.h"
#include "real.h"

/* Bars of tapes near enough to be read well correlate with ideal ones by this much. */
static const float clean_bars = 0.71f;

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

bool tmi_corners_inside(const tmi_view *view, const tapemark_point corners[4])
{
    for (int i = 0; i < 4; i++)
        if (!(corners[i].x_px >= -1 && corners[i].y_px >= -1 && corners[i].x_px <= (float)view->width &&
              corners[i].y_px <= (float)view->height))
            return false;
    return true;
}

void tmi_report_cm(const tmi_reader *reader, const tmi_segment *segment, int cm, bool turned, int tm, int slot)
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
    if (!tmi_corners_inside(reader->view, out.corners)) {
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

float tmi_turn_hint(const tmi_reader *reader, const tmi_segment *segment, int first, int count)
{
    if (!reader->config->roll_known)
        return 0;
    const tmi_point from = segment->finders[first].centre, to = segment->finders[first + count].centre;
    const float dx = to.x - from.x, dy = to.y - from.y, length = real_sqrt(dx * dx + dy * dy);
    const float along = (reader->upright.x * dx + reader->upright.y * dy) / length;
    return real_abs(along) > 0.2f ? along : 0;
}

/* What shows in the place of a CM fits its best word this well, in parts of how well believed ones fit theirs, and no
 * more cells than this, beyond those of believed ones, show the opposite of it: something that lies there, dark or
 * light, has a shade, but no word's cells. */
static const float uncovered_part = 0.9f;
static const float contrary_max = 2;

/* How the CMs that are believed fit their words, on average. */
typedef struct believed_fit {
    int count;
    float score, contrary;
} believed_fit;

static believed_fit fit_of_believed(const tmi_segment *segment, const tapemark_reject *reasons, int first, int count,
                                    bool turned)
{
    believed_fit fit = {0};
    for (int cm = first; cm < first + count; cm++)
        if (reasons[cm] == TMI_BELIEVED) {
            fit.score += segment->readings[turned][cm].score;
            fit.contrary += segment->readings[turned][cm].contrary;
            fit.count++;
        }
    fit.score /= real_max(1, (float)fit.count);
    fit.contrary /= real_max(1, (float)fit.count);
    return fit;
}

/* Whether something lies on a CM that is not believed; CMs too small to be read show nothing. */
static bool is_hidden(const tmi_reading *reading, const believed_fit *others)
{
    if (reading->score < tmi_cm_score)
        return true;
    return reading->id != TMI_NO_ID && (reading->score < uncovered_part * others->score ||
                                        reading->contrary > contrary_max + others->contrary);
}

/* Whether the blocks of the TM are as light or dark as the CMs that were read; and where some were, whether nothing
 * hides the others. */
static bool agrees(const tmi_segment *segment, const tapemark_reject *reasons, int first, int count, bool turned,
                   uint32_t code)
{
    const believed_fit fit = fit_of_believed(segment, reasons, first, count, turned);
    uint32_t known = 0, light = 0; /* the first CM's bit highest, as in the code */
    for (int cm = first; cm < first + count; cm++) {
        const tmi_reading *reading = &segment->readings[turned][cm];
        const bool believed = reasons[cm] == TMI_BELIEVED;
        known = known << 1 | (believed ? 1u : 0u);
        light = light << 1 | (reading->id >= 0 ? 1u : 0u);
        if (fit.count > 0 && !believed && is_hidden(reading, &fit))
            return false;
    }
    return ((code ^ light) & known) == 0;
}

TMI_ONCE static int count_of(tapemark_reject reason, const tapemark_reject *reasons, int first, int count)
{
    int found = 0;
    for (int cm = first; cm < first + count; cm++)
        found += reasons[cm] == reason;
    return found;
}

/* How sure the CMs make a TM: where some were read and others not, something may lie on those. Where none can be
 * read, the TM is seen from afar, and they say nothing. */
static float vouched(const tapemark_reject *reasons, int first, int count)
{
    const int read = count_of(TMI_BELIEVED, reasons, first, count);
    return read > 0 ? 0.5f + 0.5f * (float)read / (float)count : 1;
}

void tmi_tm_corners(const tmi_segment *segment, int first, int count, bool turned, tapemark_point corners[4])
{
    const float ink = 3.5f + TAPEMARK_BAR_MODULES;
    set_corners(&segment->maps[first], &segment->maps[first + count - 1], ink, TAPEMARK_CM_PITCH_MODULES + ink,
                turned, corners);
}

int tmi_report_tm(const tmi_reader *reader, const tmi_segment *segment, const tapemark_reject *reasons, int first,
                  int count, float turn, const tmi_tm_reading *reading)
{
    tapemark_result *result = reader->result;
    const bool turned = turn < 0;
    if (reading->vote < reader->config->vote_min) {
        result->stats.rejects[TAPEMARK_REJECT_VOTE]++;
        return TMI_NONE;
    }
    if (!agrees(segment, reasons, first, count, turned, reading->code) ||
        (!count_of(TMI_BELIEVED, reasons, first, count) && tmi_is_mirrored(reader, segment, first, count))) {
        result->stats.rejects[TAPEMARK_REJECT_CONFLICT]++;
        return TMI_NONE;
    }
    if (result->tm_count == result->tm_capacity) {
        if (result->tm_capacity > 0)
            result->stats.limits |= TAPEMARK_LIMIT_TMS;
        return TMI_NONE;
    }
    tapemark_tm out = {.length = (uint8_t)count, .directed = turn != 0, .vote = reading->vote,
                       .unknown_cms = (uint8_t)count_of(TAPEMARK_REJECT_UNKNOWN_ID, reasons, first, count)};
    tmi_tm_corners(segment, first, count, turned, out.corners);
    out.confidence = reading->vote * real_min(1, reading->bars * (1 / clean_bars)) * vouched(reasons, first, count);
    for (int i = 0; i < count; i++)
        out.code[i] = reading->code >> (turned ? i : count - 1 - i) & 1 ? '1' : '0';
    result->tms[result->tm_count] = out;
    return (int)result->tm_count++;
}
