#include "stroke.h"

#include "least_squares.h"
#include "real.h"

/* Heights of what may be a tape, px: below, its blocks are not seen apart; above, finder patterns are. */
static const float narrowest_px = 2.7f, widest_px = 12;

/* A stripe has this many strokes at least. */
enum { STROKES_MIN = 5 };

/* And it is this many times as long as it is high: three CMs between their finder patterns, seen at an angle. */
static const float length_min = 6.5f;

void tmi_strokes_clear(tmi_strokes *strokes)
{
    strokes->count = 0;
    strokes->contrast_min = 0;
}

/* Makes room by leaving out what has less than the mean contrast. */
static void thin_out(tmi_strokes *strokes)
{
    int sum = 0, kept = 0;
    for (int i = 0; i < strokes->count; i++)
        sum += strokes->at[i].contrast;
    strokes->contrast_min = sum / strokes->count + 1;
    for (int i = 0; i < strokes->count; i++)
        if (strokes->at[i].contrast >= strokes->contrast_min)
            strokes->at[kept++] = strokes->at[i];
    strokes->count = kept;
}

void tmi_strokes_add(tmi_strokes *strokes, int32_t line, bool vertical, float from, float to, int contrast)
{
    const float width = to - from;
    if (!(width >= narrowest_px && width <= widest_px) || contrast < strokes->contrast_min)
        return;
    if (strokes->count == TMI_MAX_STROKES)
        thin_out(strokes);
    if (contrast < strokes->contrast_min)
        return;
    const uint32_t centre = (uint32_t)(128 * (from + to)); /* edges lie within the image */
    strokes->at[strokes->count++] = (tmi_stroke){.line = (uint16_t)line,
                                                 .centre = (uint16_t)(centre >> 8),
                                                 .centre_part = (uint8_t)(centre & 255),
                                                 .width = (unsigned)(8 * width + 0.5f) & 127u,
                                                 .contrast = (uint8_t)contrast,
                                                 .vertical = vertical};
}

/* ---- Chains ---------------------------------------------------------------------------------------------------- */

static int32_t order(const tmi_stroke *s)
{
    return s->line + (s->vertical ? 65536 : 0);
}

/* Shell's sort: by pass, then by line. */
static void sort(tmi_strokes *strokes)
{
    static const int steps[] = {132, 57, 23, 10, 4, 1};
    tmi_stroke *at = strokes->at;
    for (int s = 0; s < 6; s++)
        for (int i = steps[s]; i < strokes->count; i++) {
            const tmi_stroke moved = at[i];
            const int32_t place = order(&moved);
            int j = i;
            for (; j >= steps[s] && order(&at[j - steps[s]]) > place; j -= steps[s])
                at[j] = at[j - steps[s]];
            at[j] = moved;
        }
}

/* Chains run within 49 degrees of the axis that their scan lines cross: by no more than this many 1/16 px a px. */
enum { STEEPEST = 18 };

/* Whether b, further on, may follow the chain that a ends. From one finder pattern to the next there may be nothing
 * but a light CM: 25 modules, where the stroke has seven. Where the direction is known, one finder may be missing. */
static bool may_follow(const tmi_stroke *at, const tmi_stroke *a, const tmi_stroke *b, float *error)
{
    const int dx = b->line - a->line, drift = b->centre - a->centre, drift_max = dx * STEEPEST / 16 + 4;
    if (drift > drift_max || -drift > drift_max)
        return false;
    const int widths = a->width + b->width, change = a->width - b->width; /* 1/8 px */
    const int slack = widths / 10 + 5, reach = (a->count < 3 ? 4 : 7) * widths / 16 + 4;
    if (dx > reach || change > slack || -change > slack || a->contrast > 3 * b->contrast ||
        b->contrast > 3 * a->contrast)
        return false;
    const float dy = tmi_stroke_centre(b) - tmi_stroke_centre(a), go = (float)dx;
    *error = 0.2f * real_abs(dy);
    if (a->count < 2)
        return 16 * real_abs(dy) <= STEEPEST * go;
    const tmi_stroke *first = &at[a->first];
    const float base = (float)(a->line - first->line);
    *error = real_abs(dy - (tmi_stroke_centre(a) - tmi_stroke_centre(first)) / base * go);
    return *error <= (0.5f + 0.1f / 16 * (float)widths) * (1 + go / base);
}

/* Joins stroke i to the longest chain that it may follow, or else to the straightest one of those. */
static void join_chain(tmi_stroke *at, int i)
{
    tmi_stroke *s = &at[i];
    s->count = 1;
    s->first = (int16_t)i;
    s->before = -1;
    float least = 0;
    const int line_min = s->line - s->width - 6; /* 7.5 widths, and what rounding takes */
    for (int j = i - 1; j >= 0 && at[j].vertical == s->vertical && at[j].line >= line_min; j--) {
        const int count = at[j].count < 255 ? at[j].count + 1 : 255;
        float error;
        if (count < s->count || at[j].line == s->line || !may_follow(at, &at[j], s, &error) ||
            (count == s->count && error >= least))
            continue;
        s->count = (uint8_t)count;
        s->first = at[j].first;
        s->before = (int16_t)j;
        least = error;
    }
}

void tmi_strokes_chain(tmi_strokes *strokes)
{
    sort(strokes);
    for (int i = 0; i < strokes->count; i++)
        join_chain(strokes->at, i);
}

/* ---- Stripes --------------------------------------------------------------------------------------------------- */

/* A straight line through the centres and one through the widths: value = p[0] + p[1] * x, x from the middle. */
typedef struct stripe_lines {
    float centre[3], width[3];
} stripe_lines;

static bool fit_lines(const tmi_strokes *strokes, int last, float middle, float reach, stripe_lines *lines)
{
    tmi_normal centre = {0}, width = {0};
    tmi_normal_add(&centre, 0, 0, 1, 0, 1);
    tmi_normal_add(&width, 0, 0, 1, 0, 1);
    for (int i = last; i >= 0; i = strokes->at[i].before) {
        const tmi_stroke *s = &strokes->at[i];
        const float x = (float)s->line - middle;
        if (real_abs(tmi_stroke_centre(s) - lines->centre[0] - lines->centre[1] * x) > reach ||
            real_abs(tmi_stroke_width(s) - lines->width[0] - lines->width[1] * x) > 2 * reach)
            continue;
        tmi_normal_add(&centre, 1, x, 0, tmi_stroke_centre(s), 1);
        tmi_normal_add(&width, 1, x, 0, tmi_stroke_width(s), 1);
    }
    return tmi_normal_solve(&centre, lines->centre) && tmi_normal_solve(&width, lines->width);
}

static void use_up(tmi_strokes *strokes, bool vertical, float from, float to, const stripe_lines *lines)
{
    const float middle = 0.5f * (from + to);
    for (int i = 0; i < strokes->count; i++) {
        tmi_stroke *s = &strokes->at[i];
        const float x = (float)s->line - middle;
        if (s->vertical == vertical && (float)s->line >= from && (float)s->line <= to &&
            real_abs(tmi_stroke_centre(s) - lines->centre[0] - lines->centre[1] * x) < 0.5f * lines->width[0])
            s->count = 0;
    }
}

/* The last stroke of the longest chain, or -1. */
static int longest(const tmi_strokes *strokes)
{
    int best = -1, most = STROKES_MIN - 1;
    for (int i = 0; i < strokes->count; i++)
        if (strokes->at[i].count > most) {
            most = strokes->at[i].count;
            best = i;
        }
    return best;
}

/* Cuts the chain off where it runs into strokes that are used up. */
static int fresh_part(tmi_strokes *strokes, int last)
{
    int count = 0;
    for (int i = last; i >= 0; i = strokes->at[i].before) {
        count++;
        if (strokes->at[i].before >= 0 && strokes->at[strokes->at[i].before].count == 0)
            strokes->at[i].before = -1;
    }
    return count;
}

static tmi_stripe stripe_of(const tmi_stroke *last, float from, const stripe_lines *lines, float contrast)
{
    const float slope = lines->centre[1], cosine = 1 / real_sqrt(1 + slope * slope);
    const float middle = 0.5f * (from + (float)last->line);
    tmi_stripe out = {.middle = {middle, lines->centre[0]},
                      .along = {cosine, slope * cosine},
                      .half_length = 0.5f * ((float)last->line - from) / cosine,
                      .height = lines->width[0] * cosine,
                      .taper = lines->width[1] * cosine * cosine,
                      .contrast = contrast};
    if (!last->vertical) {
        out.middle = (tmi_point){lines->centre[0], middle};
        out.along = (tmi_point){slope * cosine, cosine};
    }
    return out;
}

bool tmi_strokes_next_stripe(tmi_strokes *strokes, tmi_stripe *stripe)
{
    for (int last; (last = longest(strokes)) >= 0;) {
        const int count = fresh_part(strokes, last);
        int first = last;
        float width = 0, centre = 0, contrast = 0;
        for (int i = last; i >= 0; i = strokes->at[i].before) {
            width += tmi_stroke_width(&strokes->at[i]) / (float)count;
            centre += tmi_stroke_centre(&strokes->at[i]) / (float)count;
            contrast += (float)strokes->at[i].contrast / (float)count;
            first = i;
        }
        const float from = (float)strokes->at[first].line, to = (float)strokes->at[last].line;
        const float middle = 0.5f * (from + to);
        stripe_lines lines = {{centre, 0, 0}, {width, 0, 0}};
        const bool fits = count >= STROKES_MIN && to > from && fit_lines(strokes, last, middle, 1e6f, &lines) &&
                          fit_lines(strokes, last, middle, 0.3f + 0.1f * width, &lines);
        if (!fits) {
            strokes->at[last].count = 0;
            continue;
        }
        use_up(strokes, strokes->at[last].vertical, from, to, &lines);
        strokes->at[last].count = 0;
        *stripe = stripe_of(&strokes->at[last], from, &lines, contrast);
        if (2 * stripe->half_length > length_min * stripe->height)
            return true;
    }
    return false;
}
