#include "far.h"

#include "bars.h"
#include "real.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES };

/* A TM has to explain this share of the waveform, or to leave less than this unexplained. Whole, however its ids
 * differ from what CMs show on average, it does. */
static const float tm_explained_min = 0.86f, tm_misfit_max = 0.085f;

/* Bars have to fit by this much; 1 is perfect. A light CM does by 0.1. Where those of one end are hardly any, and
 * leave that many times as much unexplained as those of the other end do, they are something else. */
static const float bars_min = 0.25f, doubtful_bars = 0.5f, uneven_bars = 1.9f;

/* From this size on rings can be seen; below, a row has to explain more. */
static const float rings_px = 0.66f, unresolved_min = 0.93f;

/* Below this, px a module, finder patterns pass for bars and bars for finder patterns. */
static const float blocks_px = 0.55f;

/* Modules that words need to be told from each other, whatever they show, px. */
static const float words_px = 0.93f;

/* How much clearer one way up must be than the other; and how much the light CMs of a TM make it. Blocks between
 * bars, light throughout or dark throughout, come to 0.1, tapes to 0.43 at least, however blurred. */
static const float turn_min = 0.15f, tm_turn_min = 0.25f;

/* ---- Reading a row -------------------------------------------------------------------------------------------- */

/* Share of dark. */
static float dark_at(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float u, float v)
{
    const tmi_point at = tmi_row_at(&far->wave.stripe, row, u, v);
    reader->result->stats.work++;
    return (row->light - tmi_sample(reader->view, at.x, at.y)) / row->depth;
}

/* Mean share of dark in `count` columns from u on. */
TMI_ONCE static float dark_along(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float u, int count,
                                 float v)
{
    float sum = 0;
    for (int i = 0; i < count; i++)
        sum += dark_at(reader, far, row, u + (float)i, v);
    return sum / (float)count;
}

TMI_ONCE static bool bars_on_line(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, bool right,
                                  float v)
{
    const float end =
        right ? (float)(PITCH * (row->first + row->cm_count)) + 4.5f : (float)(PITCH * row->first) - 11.5f;
    const float bars = dark_along(reader, far, row, end, 8, v);
    const float quiet = dark_at(reader, far, row, right ? end + 8.3f : end - 1.3f, v);
    return bars > 0.25f && bars < 0.75f && quiet < 0.45f;
}

static bool code_on_line(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float v, uint32_t *code)
{
    *code = 0;
    for (int k = 0; k < row->cm_count; k++) {
        const float dark = dark_along(reader, far, row, (float)(PITCH * (row->first + k)) + 6, 14, v);
        if (dark > 0.4f && dark < 0.6f)
            return false;
        *code = *code << 1 | (dark < 0.5f ? 1u : 0u);
    }
    return true;
}

static void read_lines(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, tmi_tm_reading *out)
{
    uint32_t codes[TMI_LINES];
    int lines = 0, clear = 0;
    for (int i = 0; i < TMI_LINES; i++) {
        const float v = tmi_line_v[i];
        if (!bars_on_line(reader, far, row, false, v) || !bars_on_line(reader, far, row, true, v))
            continue;
        lines++;
        if (code_on_line(reader, far, row, v, &codes[clear]))
            clear++;
    }
    tmi_vote(codes, clear, lines, out);
}

/* How much darker than its top row the bottom row of CM k is, as the row runs. */
TMI_ONCE static float foot_of(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, int k)
{
    const float u = (float)(PITCH * (row->first + k)) + 6;
    return dark_along(reader, far, row, u, 14, 3) - dark_along(reader, far, row, u, 14, -3);
}

/* Light CMs have a dark bottom row, and a dark column at their left: positive where that is so as the row runs,
 * negative where it is so seen from the other side. The mean over all light CMs, in shares of dark. */
static float turn_of(const tmi_reader *reader, const tmi_far *far, const tmi_row *row)
{
    float sum = 0;
    int count = 0;
    for (int k = 0; k < row->cm_count; k++) {
        const float u = (float)(PITCH * (row->first + k));
        if (row->dark >> k & 1)
            continue;
        sum += foot_of(reader, far, row, k);
        for (int v = -2; v <= 2; v++)
            sum += 0.2f * (dark_at(reader, far, row, u + 5, (float)v) - dark_at(reader, far, row, u + 20, (float)v));
        count++;
    }
    return count > 0 ? sum / (float)count : 0;
}

/* Blocks of CMs, however blurred, fit their print by this much, but for one in a few hundred; dark ones are this dark
 * in the middle, and no darker beside the tape than the finders next to them are; and light ones are darker at their
 * bottom than at their top by this, dark ones by no more. Something that lies on them mostly is at odds with one of
 * these. */
static const float block_misfit_max = 0.085f, ink_min = 0.88f, beside_max = 0.2f, foot_min = 0.16f,
                   dark_foot_max = 0.33f;

/* How much darker it is beside CM k, v modules from the row's middle, than beside its finders. */
TMI_ONCE static float dark_beside(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, int k, float v)
{
    const float u = (float)(PITCH * (row->first + k));
    return dark_along(reader, far, row, u + 6, 14, v) -
           0.5f * (dark_along(reader, far, row, u - 3, 7, v) + dark_along(reader, far, row, u + 22, 7, v));
}

/* Whether something lies on CM k: on a light one, so that it looks dark, or the other way round. */
static bool is_hidden(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, int k, float turn)
{
    const float beside = 0.5f * TAPEMARK_HEIGHT_MODULES + 1;
    if (tmi_wave_block_misfit(&far->wave, row, k) > block_misfit_max)
        return true;
    if (!(row->dark >> k & 1))
        return foot_of(reader, far, row, k) * (turn < 0 ? -1.0f : 1.0f) < foot_min;
    return dark_along(reader, far, row, (float)(PITCH * (row->first + k)) + 6, 14, 0) < ink_min ||
           real_abs(foot_of(reader, far, row, k)) > dark_foot_max ||
           dark_beside(reader, far, row, k, beside) > beside_max ||
           dark_beside(reader, far, row, k, -beside) > beside_max;
}

static bool any_hidden(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float turn)
{
    for (int k = 0; k < row->cm_count; k++)
        if (is_hidden(reader, far, row, k, turn))
            return true;
    return false;
}

/* The row's finders and maps as the segment's. */
static void lay_out(tmi_far *far, const tmi_row *row)
{
    tmi_segment *segment = &far->segment;
    for (int k = 0; k <= row->cm_count; k++) {
        const float u = (float)(PITCH * (row->first + k));
        const tmi_point at = tmi_row_at(&far->wave.stripe, row, u, 0),
                        down = tmi_row_at(&far->wave.stripe, row, u, 1);
        const tmi_point a = tmi_row_at(&far->wave.stripe, row, u - 1, 0),
                        b = tmi_row_at(&far->wave.stripe, row, u + 1, 0);
        segment->finders[k] = (tmi_finder){.centre = at,
                                           .right = {0.5f * (b.x - a.x), 0.5f * (b.y - a.y)},
                                           .down = {down.x - at.x, down.y - at.y},
                                           .score = row->explained,
                                           .dark = row->light - row->depth,
                                           .light = row->light};
    }
    for (int k = 0; k < row->cm_count; k++)
        tmi_marker_map(&segment->finders[k], &segment->finders[k + 1], &segment->maps[k]);
}

/* Whether what the row's finder patterns show inside is no reason to doubt it: their rings; or, where those cannot be
 * seen, a waveform that leaves little unexplained. */
static bool is_tape(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float least_px)
{
    const tmi_rings rings = tmi_wave_rings(reader->view, &far->wave, row, &reader->result->stats.work);
    if (row->explained < unresolved_min)
        return rings.strength > 0.5f && rings.strength < 3 && rings.share > 0.1f;
    return least_px < rings_px || rings.strength > 0.2f;
}

static bool has_bars(const tmi_row *row)
{
    const float worse = real_min(row->bars[0], row->bars[1]), better = real_max(row->bars[0], row->bars[1]);
    return worse > bars_min && (worse > doubtful_bars || 1 - worse < uneven_bars * (1 - better));
}

/* Whether it explains the wave to both ends, has bars there, and blocks between that are those of CMs. */
static bool may_be_tm(const tmi_row *row, float turn)
{
    return (row->explained > tm_explained_min || row->misfit < tm_misfit_max) &&
           row->cm_count >= TAPEMARK_TM_MIN_CMS && has_bars(row) &&
           (row->dark == UINT32_MAX >> (32 - row->cm_count) || real_abs(turn) > tm_turn_min);
}

static void read_row(const tmi_reader *reader, tmi_far *far, const tmi_row *row)
{
    const float least_px = real_min(row->module, far->wave.stripe.height * (1.0f / TAPEMARK_HEIGHT_MODULES));
    if (row->module < blocks_px || !is_tape(reader, far, row, least_px))
        return;
    const float turn = turn_of(reader, far, row);
    bool is_tm = may_be_tm(row, turn);
    if (is_tm && any_hidden(reader, far, row, turn)) {
        reader->result->stats.rejects[TAPEMARK_REJECT_CONFLICT]++;
        is_tm = false;
    }
    tmi_tm_reading tm;
    if (is_tm)
        read_lines(reader, far, row, &tm);
    tm.bars = 1 - 5 * (1 - row->explained);
    lay_out(far, row);
    tmi_segment_read_far(reader, &far->segment, row->cm_count, is_tm ? &tm : NULL,
                         real_abs(turn) > turn_min ? turn : 0, least_px > words_px);
}

/* ---- Stripes ------------------------------------------------------------------------------------------------- */

TMI_ONCE static bool holds(const tapemark_point corners[4], tmi_point at)
{
    for (int i = 0; i < 4; i++) {
        const tapemark_point a = corners[i], b = corners[(i + 1) & 3];
        if ((b.x_px - a.x_px) * (at.y - a.y_px) - (b.y_px - a.y_px) * (at.x - a.x_px) < 0)
            return false;
    }
    return true;
}

static float height_of(const tapemark_point corners[4])
{
    const float x = corners[3].x_px - corners[0].x_px, y = corners[3].y_px - corners[0].y_px;
    return real_sqrt(x * x + y * y);
}

/* Near tapes are read one finder pattern after the other; that is as good as it gets from this height on, px. */
static const float near_px = 10.5f;

/* Whether a marker of this height leaves nothing to be found by a stripe of that height: a TM, or a CM that is near,
 * or much higher. */
static bool settles(bool is_tm, float marker_height, float height)
{
    return is_tm || marker_height > near_px || marker_height > 1.5f * height;
}

/* Whether what was read at this place leaves nothing to be found by a stripe of this height. */
TMI_ONCE static bool is_read(const tapemark_result *result, tmi_point at, float height)
{
    for (size_t i = 0; i < result->cm_count; i++)
        if (holds(result->cms[i].corners, at) && settles(false, height_of(result->cms[i].corners), height))
            return true;
    for (size_t i = 0; i < result->tm_count; i++)
        if (holds(result->tms[i].corners, at))
            return true;
    return false;
}

/* Whether more than half of it lies on markers that were read. */
static bool is_covered(const tapemark_result *result, const tmi_stripe *stripe)
{
    int inside = 0;
    for (int i = -2; i <= 2; i++) {
        const float t = 0.4f * (float)i * stripe->half_length;
        const tmi_point at = {stripe->middle.x + t * stripe->along.x, stripe->middle.y + t * stripe->along.y};
        inside += is_read(result, at, stripe->height);
    }
    return inside > 2;
}

/* Leaves out the strokes on a marker that was read. */
static void drop_on_marker(const tapemark_point corners[4], bool is_tm, tmi_strokes *strokes)
{
    const float height = height_of(corners);
    float left = corners[0].x_px, right = left, top = corners[0].y_px, bottom = top;
    for (int i = 1; i < 4; i++) {
        left = real_min(left, corners[i].x_px);
        right = real_max(right, corners[i].x_px);
        top = real_min(top, corners[i].y_px);
        bottom = real_max(bottom, corners[i].y_px);
    }
    int kept = 0;
    for (int i = 0; i < strokes->count; i++) {
        const tmi_stroke *s = &strokes->at[i];
        const tmi_point at = tmi_stroke_at(s);
        if (at.x > left && at.x < right && at.y > top && at.y < bottom && holds(corners, at) &&
            settles(is_tm, height, tmi_stroke_width(s)))
            continue;
        if (kept < i)
            strokes->at[kept] = *s;
        kept++;
    }
    strokes->count = kept;
}

static void drop_read(const tapemark_result *result, tmi_strokes *strokes)
{
    for (size_t i = 0; i < result->cm_count; i++)
        drop_on_marker(result->cms[i].corners, false, strokes);
    for (size_t i = 0; i < result->tm_count; i++)
        drop_on_marker(result->tms[i].corners, true, strokes);
}

/* Makes the stripe as long as the row, so that the wave is sampled around it. */
static void centre_on(tmi_stripe *stripe, tmi_row *row)
{
    const float left = tmi_row_px(row, (float)(PITCH * row->first)),
                right = tmi_row_px(row, (float)(PITCH * (row->first + row->cm_count)));
    const float middle = 0.5f * (left + right);
    stripe->middle =
        (tmi_point){stripe->middle.x + middle * stripe->along.x, stripe->middle.y + middle * stripe->along.y};
    stripe->height += middle * stripe->taper;
    stripe->half_length = 0.5f * (right - left);
    row->origin -= middle;
}

/* Beyond the stripe's ends there may be a finder pattern, a light CM before it, bars and the quiet zone: about this
 * many heights. */
static const float margin_heights = 6;

static void sample_all(const tmi_reader *reader, tmi_far *far, const tmi_stripe *stripe)
{
    tmi_wave_sample(reader->view, stripe, stripe->half_length + margin_heights * stripe->height, 0.5f, &far->wave,
                    &reader->result->stats.work);
}

/* Heights within which a row is believed, px: somewhat more than what strokes are noted for; and how little they
 * change, in parts, once they are found. */
static const float height_min_px = 2, height_max_px = 16, height_change_max = 0.03f;

/* What a row has to explain before stripe and row have been fitted to each other once, then twice, and then. Blocks
 * that are all light, or all dark, leave little to explain: it is as well when what is left of it is little. */
enum { ROUGH_PASSES = 2 };
static const float explained_by_pass[ROUGH_PASSES + 1] = {0.7f, 0.78f, 0.85f},
                                                    misfit_by_pass[ROUGH_PASSES + 1] = {0.12f, 0.1f, 0.095f};

static bool fits_well(const tmi_row *row, int pass)
{
    const int i = pass < ROUGH_PASSES ? pass : ROUGH_PASSES;
    return row->explained > explained_by_pass[i] || row->misfit < misfit_by_pass[i];
}

/* A stripe that is too high or too low may make the wrong way up fit better, at first. */
TMI_ONCE static bool fit_row(tmi_far *far, tmi_row *row, int pass, uint32_t *work)
{
    tmi_row turned = *row;
    const bool fits = tmi_wave_fit_row(&far->wave, row, work);
    if (pass >= ROUGH_PASSES)
        return fits;
    turned.turned = !turned.turned;
    const bool turned_fits = tmi_wave_fit_row(&far->wave, &turned, work);
    if (turned_fits && (!fits || (turned.cm_count == row->cm_count && turned.explained > row->explained)))
        *row = turned;
    return fits || turned_fits;
}

/* Fits row and stripe to each other in turn, until neither changes. */
static bool settle(const tmi_reader *reader, tmi_far *far, tmi_stripe *stripe, tmi_row *row)
{
    uint32_t *work = &reader->result->stats.work;
    int cm_count = 0;
    float height = 0;
    for (int pass = 0; pass < 8; pass++) {
        if (!tmi_may_go_on(reader))
            return false;
        sample_all(reader, far, stripe);
        if (!fit_row(far, row, pass, work) || !fits_well(row, pass))
            return false;
        if (pass >= ROUGH_PASSES && row->cm_count == cm_count &&
            real_abs(stripe->height - height) < height_change_max * height)
            return true;
        cm_count = row->cm_count;
        height = stripe->height;
        tmi_wave_fit_blur(&far->wave, row, work);
        if (!tmi_wave_fit_across(reader->view, &far->wave, row, stripe, work) || stripe->height < height_min_px ||
            stripe->height > height_max_px)
            return false;
        centre_on(stripe, row);
    }
    return true;
}

/* Guesses are made from about five pitches: over more of them, pitches would have to be tried in smaller steps, and
 * perspective would tell. */
static const float guess_heights = 9;

/* Samples that are enough to see whether there is anything but a line, and to guess from; in heights. */
static const float glance_step = 0.35f, guess_step = 0.1f;

/* What explains no more of the wave than this one way up does not fit the other way up either. */
static const float hopeless = 0.65f;

/* The guess that fits best of those made from where the strokes are; false where none is any good. */
static bool guess_row(const tmi_reader *reader, tmi_far *far, const tmi_stripe *stripe, tmi_row *row)
{
    uint32_t *work = &reader->result->stats.work;
    tmi_guess guesses[TMI_GUESSES];
    const float height = stripe->height;
    const float reach = real_min(stripe->half_length + 0.8f * height, guess_heights * height);
    tmi_wave_sample(reader->view, stripe, reach, glance_step * height, &far->wave, work);
    const tmi_glance glance = tmi_wave_glance(&far->wave);
    if (glance.flat)
        return false;
    tmi_wave_sample(reader->view, stripe, reach, real_max(0.5f, guess_step * height), &far->wave, work);
    tmi_wave_guess_rows(&far->wave, glance.roughness, &far->sums, guesses, work);
    row->explained = 0;
    for (int i = 0; i < TMI_GUESSES; i++) {
        const tmi_guess *guess = &guesses[i];
        for (int turned = 0; turned < 2 && guess->gain > 0; turned++) {
            tmi_row tried = {
                .origin = guess->origin, .module = guess->module, .cm_count = guess->cm_count, .turned = turned};
            const bool fits = tmi_wave_fit_guess(&far->wave, &tried, work);
            if (fits && tried.explained > row->explained)
                *row = tried;
            if (!fits && tried.explained < hopeless)
                break;
        }
    }
    return row->explained > 0;
}

void tmi_far_read(const tmi_reader *reader, tmi_strokes *strokes, tmi_far *far)
{
    tmi_stripe stripe;
    tmi_row row;
    far->wave.prints.reach = 0;
    drop_read(reader->result, strokes);
    tmi_strokes_chain(strokes);
    while (tmi_may_go_on(reader) && tmi_strokes_next_stripe(strokes, &stripe))
        if (!is_covered(reader->result, &stripe) && guess_row(reader, far, &stripe, &row) &&
            settle(reader, far, &stripe, &row))
            read_row(reader, far, &row);
}
