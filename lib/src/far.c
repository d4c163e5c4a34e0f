#include "far.h"

#include "bars.h"
#include "real.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES };


/* ---- Reading a row -------------------------------------------------------------------------------------------- */

/* Share of dark. */
static float dark_at(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float u, float v)
{
    const tmi_point at = tmi_row_at(&far->wave.stripe, row, u, v);
    reader->result->stats.work++;
    return (row->light - tmi_sample(reader->view, at.x, at.y)) / row->depth;
}

/* Mean share of dark in `count` columns from u on. */
static float dark_along(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, float u, int count, float v)
{
    float sum = 0;
    for (int i = 0; i < count; i++)
        sum += dark_at(reader, far, row, u + (float)i, v);
    return sum / (float)count;
}

static bool bars_on_line(const tmi_reader *reader, const tmi_far *far, const tmi_row *row, bool right, float v)
{
    const float end = right ? (float)(PITCH * (row->first + row->cm_count)) + 4.5f : (float)(PITCH * row->first) - 11.5f;
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
        sum += dark_along(reader, far, row, u + 6, 14, 3) - dark_along(reader, far, row, u + 6, 14, -3);
        for (int v = -2; v <= 2; v++)
            sum += 0.2f * (dark_at(reader, far, row, u + 5, (float)v) - dark_at(reader, far, row, u + 20, (float)v));
        count++;
    }
    return count > 0 ? sum / (float)count : 0;
}

/* The row's finders and maps as the segment's. */
static void lay_out(tmi_far *far, const tmi_row *row)
{
    tmi_segment *segment = &far->segment;
    for (int k = 0; k <= row->cm_count; k++) {
        const float u = (float)(PITCH * (row->first + k));
        const tmi_point at = tmi_row_at(&far->wave.stripe, row, u, 0), down = tmi_row_at(&far->wave.stripe, row, u, 1);
        const tmi_point a = tmi_row_at(&far->wave.stripe, row, u - 1, 0), b = tmi_row_at(&far->wave.stripe, row, u + 1, 0);
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

/* ---- Stripes ---------------------------------------------------------------------------------------------------- */

/* A TM has to explain this share of the waveform. */
static const float explained_min = 0.85f;

static const float bars_min = 0.25f;

/* From this size on rings can be seen; below, a TM has to explain more. */
static const float rings_px = 0.66f, unresolved_min = 0.93f;

/* How much clearer one way up must be than the other. */
static const float turn_min = 0.15f;

static void read_row(const tmi_reader *reader, tmi_far *far, const tmi_row *row)
{
    tmi_tm_reading tm;
    read_lines(reader, far, row, &tm);
    const bool agrees = tm.vote > 0 && (tm.code ^ row->dark) != 0;
    (void)agrees;
    tm.bars = 0.71f * (1 - 5 * (1 - row->explained));
    const float turn = turn_of(reader, far, row);
    const tmi_rings rings = tmi_wave_rings(reader->view, &far->wave, row, &reader->result->stats.work);
    const float least_px = real_min(row->module, far->wave.stripe.height * (1.0f / TAPEMARK_HEIGHT_MODULES));
    const bool visible = least_px > rings_px, ringed = rings.strength > 0.5f && rings.strength < 3 && rings.share > 0.1f;
    if (visible ? !ringed : row->explained < unresolved_min)
        return;
    lay_out(far, row);
    const bool is_tm = row->bars[0] > bars_min && row->bars[1] > bars_min && row->explained >= explained_min && row->cm_count >= TAPEMARK_TM_MIN_CMS;
    tmi_segment_read_far(reader, &far->segment, row->cm_count, is_tm ? &tm : NULL, real_abs(turn) > turn_min ? turn : 0);
}

static bool holds(const tapemark_point corners[4], tmi_point at)
{
    for (int i = 0; i < 4; i++) {
        const tapemark_point a = corners[i], b = corners[(i + 1) & 3];
        if ((b.x_px - a.x_px) * (at.y - a.y_px) - (b.y_px - a.y_px) * (at.x - a.x_px) < 0)
            return false;
    }
    return true;
}

/* Whether a marker was read at this place. */
static bool is_read(const tapemark_result *result, tmi_point at, bool cms)
{
    for (size_t i = 0; cms && i < result->cm_count; i++)
        if (holds(result->cms[i].corners, at))
            return true;
    for (size_t i = 0; i < result->tm_count; i++)
        if (holds(result->tms[i].corners, at))
            return true;
    return false;
}

static bool is_covered(const tapemark_result *result, const tmi_stripe *stripe)
{
    int inside = 0;
    for (int i = -2; i <= 2; i++) {
        const float t = 0.4f * (float)i * stripe->half_length;
        inside += is_read(result, (tmi_point){stripe->middle.x + t * stripe->along.x, stripe->middle.y + t * stripe->along.y}, false);
    }
    return inside > 2;
}

/* Makes the stripe as long as the row, so that the wave is sampled around it. */
static void centre_on(tmi_stripe *stripe, tmi_row *row)
{
    const float left = tmi_row_px(row, (float)(PITCH * row->first)), right = tmi_row_px(row, (float)(PITCH * (row->first + row->cm_count)));
    const float middle = 0.5f * (left + right);
    stripe->middle = (tmi_point){stripe->middle.x + middle * stripe->along.x, stripe->middle.y + middle * stripe->along.y};
    stripe->height += middle * stripe->taper;
    stripe->half_length = 0.5f * (right - left);
    row->origin -= middle;
}

/* Fits row and stripe to each other in turn. */
static bool settle(const tmi_reader *reader, tmi_far *far, tmi_stripe *stripe, tmi_row *row)
{
    uint32_t *work = &reader->result->stats.work;
    int cm_count = 0;
    for (int pass = 0; pass < 8; pass++) {
        if (pass > 0)
            tmi_wave_sample(reader->view, stripe, &far->wave, work);
        if (!tmi_wave_fit_row(&far->wave, row, work))
            return false;
        if (row->explained < (pass == 0 ? 0.75f : explained_min))
            return false;
        if (pass > 1 && row->cm_count == cm_count)
            return true;
        cm_count = row->cm_count;
        if (!tmi_wave_fit_across(reader->view, &far->wave, row, stripe, work))
            return false;
        centre_on(stripe, row);
    }
    return true;
}

static bool locate(const tmi_reader *reader, tmi_far *far, const tmi_stripe *found, tmi_row *row)
{
    uint32_t *work = &reader->result->stats.work;
    tmi_guess guesses[TMI_GUESSES];
    tmi_wave_sample(reader->view, found, &far->wave, work);
    tmi_wave_guess_rows(&far->wave, &far->sums, guesses, work);
    for (;;) {
        int best = 0;
        for (int i = 1; i < TMI_GUESSES; i++)
            if (guesses[i].gain > guesses[best].gain)
                best = i;
        if (guesses[best].gain == 0)
            return false;
        tmi_stripe stripe = *found;
        *row = (tmi_row){.origin = guesses[best].origin, .module = guesses[best].module, .cm_count = guesses[best].cm_count};
        guesses[best].gain = 0;
        tmi_wave_sample(reader->view, found, &far->wave, work);
        if (settle(reader, far, &stripe, row) && row->explained > 0.85f)
            return true;
    }
}

void tmi_far_read(const tmi_reader *reader, tmi_strokes *strokes, tmi_far *far)
{
    tmi_stripe stripe;
    tmi_row row;
    far->wave.prints.reach = 0;
    tmi_strokes_chain(strokes);
    while (tmi_may_go_on(reader) && tmi_strokes_next_stripe(strokes, &stripe))
        if (!is_covered(reader->result, &stripe) && locate(reader, far, &stripe, &row))
            read_row(reader, far, &row);
}
