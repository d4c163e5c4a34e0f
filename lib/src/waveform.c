#include "waveform.h"

#include "least_squares.h"
#include "real.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES, HEIGHT = TAPEMARK_HEIGHT_MODULES };

/* ---- Sampling ----------------------------------------------------------------------------------------------------
 */

void tmi_wave_sample(const tmi_view *view, const tmi_stripe *stripe, float reach, float step, tmi_wave *wave,
                     uint32_t *reads)
{
    wave->stripe = *stripe;
    wave->step = real_max(step, 2 * reach / (TMI_WAVE_SAMPLES - 1));
    wave->start = -reach;
    wave->count = (int)(2 * reach / wave->step) + 1;
    const tmi_point e = stripe->along;
    for (int i = 0; i < wave->count; i++) {
        const float t = wave->start + (float)i * wave->step;
        const float module = (stripe->height + stripe->taper * t) * (1.0f / HEIGHT);
        const tmi_point at = {stripe->middle.x + t * e.x, stripe->middle.y + t * e.y};
        float sum = 0;
        for (int v = -3; v <= 3; v++)
            sum += tmi_sample(view, at.x - (float)v * module * e.y, at.y + (float)v * module * e.x);
        wave->value[i] = (uint16_t)(sum * (64.0f / HEIGHT) + 0.5f);
    }
    *reads += (uint32_t)(HEIGHT * wave->count);
}

/* ---- What a row looks like
 * ------------------------------------------------------------------------------------------ */

/* Share of dark in each of a finder pattern's columns, and in those of a coding region: of a light CM, and of a dark
 * one; checksum cells as often dark as not, and a few data cells changed. */
enum { FINDER_COLUMNS = 7, BLOCK_COLUMNS = TAPEMARK_CELL_COLUMNS, BARS_COLUMNS = 7 };
static const float finder_dark[FINDER_COLUMNS] = {1, 2 / 7.0f, 5 / 7.0f, 5 / 7.0f, 5 / 7.0f, 2 / 7.0f, 1};
static const float light_dark[BLOCK_COLUMNS] = {1,    .17f, .31f, .17f, .17f, .31f, .17f, .17f,
                                                .31f, .17f, .17f, .17f, .17f, .31f, .15f, .29f};
static const float dark_dark[BLOCK_COLUMNS] = {1,    .97f, .83f, .97f, .97f, .83f, .97f, .97f,
                                               .83f, .97f, .97f, .97f, .97f, .83f, .7f,  .86f};

static const float bars_dark[BARS_COLUMNS] = {1, 0, 1, 0, 1, 0, 1};

typedef struct row_print {
    const tmi_prints *prints;
    int first, cm_count; /* finder 0 is at u = 0 */
    uint32_t dark;
    bool turned;  /* its coding regions are seen standing on the head */
    bool bars[2]; /* at the left and the right end */
} row_print;

/* Blur of the wave, standard deviation: of a good camera's optics, its pixels, and bilinear sampling; px. And that of
 * a module's own width, in modules. */
static const float blur_px = 0.7f, module_blur = 0.289f;

typedef struct blurred {
    float value, slope; /* share of dark, and its change per module */
} blurred;

/* Weights of the blur, for a sum over whole modules: from how far away it reaches. */
static float blur_reach(float module_px)
{
    const float sigma = blur_px / module_px;
    return real_min(TMI_BLUR_MAX, 2.6458f * real_sqrt(sigma * sigma + module_blur * module_blur));
}

/* Blurs the columns of a part of the print, with light around it, into a table of four entries a module that begins
 * TMI_BLUR_MAX modules before its first column's centre. */
static void blur_part(const float *columns, int count, float reach, float *table)
{
    const int entries = TMI_PRINT_ENTRIES(count);
    for (int i = 0; i < entries; i++) {
        const float u = (float)i * (1.0f / TMI_PRINT_STEPS) - TMI_BLUR_MAX;
        float sum = 0, weights = 0;
        for (int at = (int)(u - reach + 100) - 99; (float)at <= u + reach; at++) {
            const float x = ((float)at - u) / reach, k = real_max(0, 1 - x * x);
            weights += k * k;
            if (at >= 0 && at < count)
                sum += k * k * columns[at];
        }
        table[i] = sum / weights;
    }
}

static void prepare_prints(tmi_prints *prints, float module_px)
{
    const float reach = blur_reach(module_px);
    if (real_abs(prints->reach - reach) < 0.02f * reach)
        return;
    prints->reach = reach;
    blur_part(finder_dark, FINDER_COLUMNS, reach, prints->finder);
    blur_part(light_dark, BLOCK_COLUMNS, reach, prints->light);
    blur_part(dark_dark, BLOCK_COLUMNS, reach, prints->dark);
    blur_part(bars_dark, BARS_COLUMNS, reach, prints->bars);
}

/* Adds a part of the print whose first column is at u = 0. */
static void add_part(const float *table, int count, float u, blurred *sum)
{
    const float at = (u + TMI_BLUR_MAX) * TMI_PRINT_STEPS;
    if (!(at >= 0 && at < (float)(TMI_PRINT_ENTRIES(count) - 1)))
        return;
    const int i = (int)at;
    const float rise = table[i + 1] - table[i];
    sum->value += table[i] + (at - (float)i) * rise;
    sum->slope += TMI_PRINT_STEPS * rise;
}

/* Adds a coding region whose first column as seen is at u = 0. */
static void add_block(const row_print *print, int cm, float u, blurred *sum)
{
    const float *table = print->dark >> cm & 1 ? print->prints->dark : print->prints->light;
    if (!print->turned) {
        add_part(table, BLOCK_COLUMNS, u, sum);
        return;
    }
    blurred turned = {0, 0};
    add_part(table, BLOCK_COLUMNS, BLOCK_COLUMNS - 1 - u, &turned);
    sum->value += turned.value;
    sum->slope -= turned.slope;
}

/* Share of dark at u, blurred. */
static blurred row_dark(const row_print *print, float u)
{
    const tmi_prints *p = print->prints;
    const float from = u - (float)(PITCH * print->first);
    blurred sum = {0, 0};
    /* Of each part the nearest ones: a block, and the finders to both sides of its middle. */
    int cm = (int)(from * (1.0f / PITCH) + 100) - 100;
    cm = cm < 0 ? 0 : cm > print->cm_count ? print->cm_count : cm;
    const float at = from - (float)(PITCH * cm);
    add_part(p->finder, FINDER_COLUMNS, at + 3, &sum);
    if (cm < print->cm_count) {
        add_part(p->finder, FINDER_COLUMNS, at - (PITCH - 3), &sum);
        add_block(print, cm, at - 5, &sum);
    }
    if (cm > 0)
        add_block(print, cm - 1, at + (PITCH - 5), &sum);
    if (print->bars[0])
        add_part(p->bars, BARS_COLUMNS, from + 11, &sum);
    if (print->bars[1])
        add_part(p->bars, BARS_COLUMNS, from - (float)(PITCH * print->cm_count) - 5, &sum);
    return sum;
}

/* ---- First look
 * ------------------------------------------------------------------------------------------------------ */

static void sum_up(const tmi_wave *wave, tmi_wave_sums *sums)
{
    sums->per_sum = 1 + (wave->count - 1) / TMI_SUMS;
    sums->count = wave->count / sums->per_sum;
    sums->sum[0] = sums->squares[0] = 0;
    float mean = 0;
    for (int i = 0; i < wave->count; i++)
        mean += (float)wave->value[i] * (1.0f / 64) / (float)wave->count;
    for (int i = 0; i < sums->count; i++) {
        float value = 0;
        for (int j = 0; j < sums->per_sum; j++)
            value += (float)wave->value[i * sums->per_sum + j];
        value = value * (1.0f / 64) / (float)sums->per_sum - mean;
        sums->sum[i + 1] = sums->sum[i] + value;
        sums->squares[i + 1] = sums->squares[i] + value * value;
    }
}

/* Regression of gray values on the share of dark. */
typedef struct fit_sums {
    float n, x, xx, y, yy, xy; /* x: dark, y: gray */
} fit_sums;

static void add_stretch(const tmi_wave_sums *s, int from, int to, float dark, fit_sums *fit)
{
    const float n = (float)(to - from), y = s->sum[to] - s->sum[from];
    fit->n += n;
    fit->x += n * dark;
    fit->xx += n * dark * dark;
    fit->y += y;
    fit->xy += y * dark;
}

static float explained(const fit_sums *fit, float *gain)
{
    const float xx = fit->xx - fit->x * fit->x / fit->n, xy = fit->xy - fit->x * fit->y / fit->n;
    *gain = xx > 0 ? xy / xx : 0;
    return xx > 0 && xy < 0 ? xy * xy / xx : 0;
}

/* How much of the wave a row with finders at `origin` + k * `pitch`, in sums, explains; its blocks are dark where
 * they are darker than the finders beside them. */
static float coarse_gain(const tmi_wave_sums *s, float origin, float pitch, int *first, int *count, float *share)
{
    const float module = pitch * (1.0f / PITCH);
    fit_sums fit = {0};
    int k = 0;
    float begin = 0;
    *count = -1;
    for (float at = origin; at + 4.5f * module < (float)s->count; at += pitch, k++) {
        const int a = (int)(at - 3.5f * module), b = (int)(at + 3.5f * module + 1);
        if (at - 4.5f * module < 0)
            continue;
        if (*count < 0) {
            *first = k;
            begin = at - 3.5f * module;
        } else {
            const int from = (int)(at - (PITCH - 3.5f) * module + 1), left = (int)(at - (PITCH - 4.5f) * module + 1);
            const int right = (int)(at - 4.5f * module + 1);
            const float finders = (s->sum[b] - s->sum[a]) / (float)(b - a);
            const float block = (s->sum[right] - s->sum[left]) / (float)(right - left);
            const bool dark = block < finders;
            add_stretch(s, from, left, 0, &fit);
            add_stretch(s, left, right, dark ? 0.9f : 0.25f, &fit);
            add_stretch(s, right, (int)(at - 3.5f * module + 1), 0, &fit);
        }
        add_stretch(s, (int)(at - 3.5f * module + 1), b, 0.65f, &fit);
        ++*count;
    }
    if (*count < 2)
        return 0;
    const int from = (int)(begin + 1), to = from + (int)fit.n;
    fit.yy = s->squares[to < s->count ? to : s->count] - s->squares[from] - fit.y * fit.y / fit.n;
    float slope;
    const float gain = explained(&fit, &slope);
    *share = fit.yy > 0 ? gain / fit.yy : 0;
    return gain;
}

/* Part of the wave's variance that a first look has to explain. */
static const float coarse_min = 0.35f;

/* Over five pitches, half a step makes a module at the ends. */
static const float pitch_step = 0.95f;

/* The pitch that explains most, between two bounds in sums. */
static void best_pitch(const tmi_wave *wave, const tmi_wave_sums *s, float least, float most, tmi_guess *guess,
                       uint32_t *work)
{
    const float unit = wave->step * (float)s->per_sum;
    uint32_t tried = 0;
    *guess = (tmi_guess){0};
    for (float pitch = most; pitch > least; pitch *= pitch_step) {
        const float hop = real_max(0.5f, pitch * (1.25f / PITCH));
        for (float origin = 0; origin < pitch; origin += hop) {
            int first = 0, count;
            float share = 0;
            const float gain = coarse_gain(s, origin, pitch, &first, &count, &share);
            tried += (uint32_t)(count > 0 ? count : 1);
            if (gain <= guess->gain || share < coarse_min)
                continue;
            *guess = (tmi_guess){.gain = gain,
                                 .origin = wave->start + unit * (origin + pitch * (float)first),
                                 .module = unit * pitch * (1.0f / PITCH),
                                 .cm_count = count};
        }
    }
    *work += tried / 2;
}

/* A tape seen at an angle has narrower modules than its height tells: three octaves' parts. */
static const float pitch_bounds[TMI_GUESSES + 1] = {1.15f, 0.85f, 0.63f, 0.47f};

/* The wave along a tape rises and falls by more than this part of its strokes' contrast; along a lone line, a gap
 * between boards or a shadow's edge it does not. Standard deviation. */
static const float swing_min = 0.15f;

bool tmi_wave_is_flat(const tmi_wave *wave)
{
    float sum = 0, squares = 0;
    for (int i = 0; i < wave->count; i++) {
        const float value = (float)(wave->value[i] - wave->value[0]) * (1.0f / 64);
        sum += value;
        squares += value * value;
    }
    const float n = (float)wave->count, swing = swing_min * wave->stripe.contrast;
    return squares - sum * sum / n < swing * swing * n;
}

void tmi_wave_guess_rows(const tmi_wave *wave, tmi_wave_sums *sums, tmi_guess guesses[TMI_GUESSES], uint32_t *work)
{
    sum_up(wave, sums);
    const float full = wave->stripe.height * ((float)PITCH / HEIGHT) / (wave->step * (float)sums->per_sum);
    for (int i = 0; i < TMI_GUESSES; i++)
        best_pitch(wave, sums, full * pitch_bounds[i + 1], full * pitch_bounds[i], &guesses[i], work);
}

/* ---- Fitting
 * --------------------------------------------------------------------------------------------------------- */

static float sample_px(const tmi_wave *wave, int i)
{
    return wave->start + (float)i * wave->step;
}

static float sample_gray(const tmi_wave *wave, int i)
{
    return (float)wave->value[i] * (1.0f / 64);
}

static int sample_at(const tmi_wave *wave, float px)
{
    const float i = (px - wave->start) / wave->step + 0.5f;
    return (int)real_min(real_max(i, 0), (float)(wave->count - 1)); /* a NaN ends up as 0 */
}

static float row_u(const tmi_row *row, float px)
{
    const float t = px - row->origin;
    return t / (row->module - row->bend * t);
}

static row_print print_of(const tmi_wave *wave, const tmi_row *row)
{
    return (row_print){.prints = &wave->prints,
                       .first = row->first,
                       .cm_count = row->cm_count,
                       .dark = row->dark,
                       .turned = row->turned};
}

/* Levels of light and dark by regression over the modules from..to; returns the share of variance explained. */
static float fit_levels(const tmi_wave *wave, const tmi_row *row, const row_print *print, float from, float to,
                        float *light, float *depth)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    const float zero = sample_gray(wave, first);
    fit_sums fit = {0};
    for (int i = first; i <= last; i++) {
        const float x = row_dark(print, row_u(row, sample_px(wave, i))).value, y = sample_gray(wave, i) - zero;
        fit.n++;
        fit.x += x;
        fit.xx += x * x;
        fit.y += y;
        fit.yy += y * y;
        fit.xy += x * y;
    }
    float gain;
    const float share = explained(&fit, &gain);
    const float variance = fit.yy - fit.y * fit.y / fit.n;
    *depth = -gain;
    *light = zero + (fit.y - gain * fit.x) / fit.n;
    return variance > 0 ? share / variance : 0;
}

/* Beyond these there is no tape that could be read. */
static const float module_min_px = 0.2f, bend_max = 0.0025f;

/* One step of fitting origin, module and bend to the samples between the modules from..to. */
static bool fit_step(const tmi_wave *wave, tmi_row *row, const row_print *print, float from, float to, bool bends)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    const float middle = 0.5f * (from + to), half = 0.5f * (to - from);
    tmi_normal shift = {0};
    for (int i = first; i <= last; i++) {
        const float u = row_u(row, sample_px(wave, i)), x = (u - middle) / half;
        const blurred dark = row_dark(print, u);
        const float missing = row->light - row->depth * dark.value - sample_gray(wave, i);
        tmi_normal_add(&shift, dark.slope, dark.slope * x, dark.slope * x * x, missing / row->depth, 1);
    }
    if (!bends)
        tmi_normal_add(&shift, 0, 0, 1, 0, 1e6f);
    else
        tmi_normal_add(&shift, 0, 0, 1, 0, 1);
    float p[3];
    if (!tmi_normal_solve(&shift, p))
        return false;
    for (int k = 0; k < 3; k++)
        p[k] = real_max(-1, real_min(1, p[k]));
    /* Where the print is p further on: u + p0 + p1 x + p2 x^2, as a polynomial of u. */
    const float c2 = p[2] / (half * half), c1 = p[1] / half - 2 * c2 * middle;
    const float c0 = p[0] - p[1] * middle / half + c2 * middle * middle;
    row->origin -= c0 * row->module;
    row->module *= 1 - c1;
    row->bend += c2;
    const float nearest = 1 + row->bend * (row->bend < 0 ? to : from);
    return row->module > module_min_px && real_abs(row->bend) < bend_max && nearest > 0.4f;
}

/* How far the wave is from the print over the modules from..to: root mean square, in parts of the depth. */
static float misfit(const tmi_wave *wave, const tmi_row *row, const row_print *print, float from, float to)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    float sum = 0;
    for (int i = first; i <= last; i++) {
        const float dark = row_dark(print, row_u(row, sample_px(wave, i))).value;
        const float miss = (row->light - sample_gray(wave, i)) / row->depth - dark;
        sum += miss * miss;
    }
    return real_sqrt(sum / (float)(last - first + 1));
}

/* Mean gray between the modules from..to. */
static float mean_gray(const tmi_wave *wave, const tmi_row *row, float from, float to)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    float sum = 0;
    for (int i = first; i <= last; i++)
        sum += sample_gray(wave, i);
    return sum / (float)(last - first + 1);
}

/* Which blocks are dark: darker than the finders beside them. */
static void find_code(const tmi_wave *wave, tmi_row *row)
{
    row->dark = 0;
    for (int k = 0; k < row->cm_count; k++) {
        const float u = (float)(PITCH * (row->first + k));
        const float finders = 0.5f * (mean_gray(wave, row, u - 3, u + 3) + mean_gray(wave, row, u + 22, u + 28));
        if (mean_gray(wave, row, u + 5.5f, u + 19.5f) < finders)
            row->dark |= 1u << k;
    }
}

static float left_end(const tmi_row *row)
{
    return (float)(PITCH * row->first) - 3.5f;
}

static float right_end(const tmi_row *row)
{
    return (float)(PITCH * (row->first + row->cm_count)) + 3.5f;
}

/* What fits no better than this after that many steps will not come to fit. */
enum { FIT_STEPS = 4 };
static const float explained_min[FIT_STEPS] = {0.35f, 0.5f, 0.6f, 0.7f};

static bool fit_row(const tmi_wave *wave, tmi_row *row, int steps, uint32_t *work)
{
    find_code(wave, row);
    const row_print print = print_of(wave, row);
    for (int step = 0; step < steps; step++) {
        row->explained = fit_levels(wave, row, &print, left_end(row), right_end(row), &row->light, &row->depth);
        *work += (uint32_t)(0.5f * (right_end(row) - left_end(row)) * row->module / wave->step);
        if (!(row->depth > 1) || row->explained < explained_min[step] ||
            !fit_step(wave, row, &print, left_end(row), right_end(row), row->cm_count > 3))
            return false;
    }
    return true;
}

/* A finder and its block have to fit this well to belong to the row, and bars to be some. */
static const float slot_misfit_max = 0.2f, bars_misfit_max = 0.2f;

/* How badly CM k of the row fits: its block and the finder beyond it. */
static float slot_misfit(const tmi_wave *wave, const tmi_row *row, int k, bool right)
{
    const row_print print = print_of(wave, row);
    const float u = (float)(PITCH * (row->first + k));
    return right ? misfit(wave, row, &print, u + 4, u + 28.5f) : misfit(wave, row, &print, u - 3.5f, u + 21);
}

/* Leaves out CMs at the ends that do not fit. */
static void trim(const tmi_wave *wave, tmi_row *row)
{
    while (row->cm_count > 0 && slot_misfit(wave, row, row->cm_count - 1, true) > slot_misfit_max) {
        row->cm_count--;
        row->dark &= (1u << row->cm_count) - 1;
    }
    while (row->cm_count > 0 && slot_misfit(wave, row, 0, false) > slot_misfit_max) {
        row->cm_count--;
        row->first++;
        row->dark >>= 1;
    }
}

static float bars_misfit(const tmi_wave *wave, const tmi_row *row, bool right)
{
    row_print print = print_of(wave, row);
    print.bars[right] = true;
    return right ? misfit(wave, row, &print, right_end(row) + 0.5f, right_end(row) + 9.5f)
                 : misfit(wave, row, &print, left_end(row) - 9.5f, left_end(row) - 0.5f);
}

static bool in_wave(const tmi_wave *wave, const tmi_row *row, float u)
{
    const float px = tmi_row_px(row, u);
    return px > wave->start && px < -wave->start;
}

/* Goes on by one CM, where there is one that fits better than this. */
static bool extend(const tmi_wave *wave, tmi_row *row, bool right, float misfit_max, uint32_t *work)
{
    tmi_row longer = *row;
    longer.cm_count++;
    if (!right) {
        longer.first--;
        longer.dark <<= 1;
    }
    if (longer.cm_count > TAPEMARK_TM_MAX_CMS || !in_wave(wave, &longer, left_end(&longer)) ||
        !in_wave(wave, &longer, right_end(&longer)))
        return false;
    find_code(wave, &longer);
    if (slot_misfit(wave, &longer, right ? longer.cm_count - 1 : 0, right) > misfit_max ||
        !fit_row(wave, &longer, 2, work))
        return false;
    *row = longer;
    return true;
}

/* Goes on by CMs until bars fit better than another CM. */
static void find_end(const tmi_wave *wave, tmi_row *row, bool right, uint32_t *work)
{
    float bars;
    do
        bars = bars_misfit(wave, row, right);
    while (extend(wave, row, right, real_min(bars, slot_misfit_max), work));
    row->bars[right] = 1 - bars / bars_misfit_max;
}

/* Fits the row once more together with the bars at its ends. */
static bool fit_with_bars(const tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    enum { STEPS = 3 };
    const float beyond = TAPEMARK_BAR_MODULES + 1;
    row_print print = print_of(wave, row);
    print.bars[0] = print.bars[1] = true;
    for (int step = 0; step <= STEPS; step++) {
        const float from = left_end(row) - beyond, to = right_end(row) + beyond;
        row->explained = fit_levels(wave, row, &print, from, to, &row->light, &row->depth);
        *work += (uint32_t)(0.5f * (to - from) * row->module / wave->step);
        if (!(row->depth > 1) || (step < STEPS && !fit_step(wave, row, &print, from, to, true)))
            return false;
    }
    return true;
}

bool tmi_wave_fit_guess(tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    prepare_prints(&wave->prints, row->module);
    return row->cm_count <= TAPEMARK_TM_MAX_CMS && fit_row(wave, row, FIT_STEPS, work);
}

bool tmi_wave_fit_row(tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    prepare_prints(&wave->prints, row->module);
    if (!fit_row(wave, row, FIT_STEPS, work))
        return false;
    trim(wave, row);
    if (row->cm_count < 2 || !fit_row(wave, row, 2, work))
        return false;
    find_end(wave, row, false, work);
    find_end(wave, row, true, work);
    if (row->bars[0] > 0 && row->bars[1] > 0) {
        if (!fit_with_bars(wave, row, work))
            return false;
        for (int right = 0; right < 2; right++)
            row->bars[right] = 1 - bars_misfit(wave, row, right) / bars_misfit_max;
    }
    return true;
}

/* ---- Across
 * ---------------------------------------------------------------------------------------------------------- */

/* A step from 0 to 1 at x = 0, blurred as row_dark() is. */
static blurred step_up(float x, float reach)
{
    const float t = real_max(-1, real_min(1, x / reach)), tt = t * t;
    return (blurred){0.5f + 0.9375f * t * (1 - tt * (0.6667f - 0.2f * tt)), 0.9375f * (1 - tt) * (1 - tt) / reach};
}

enum { ACROSS = 21 }; /* samples across, half a module apart */

static float across_v(int j)
{
    return 0.5f * (float)(j - ACROSS / 2);
}

/* What is seen across the stripe in the columns of a finder pattern, as shares of dark. */
static void sample_across(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, float u, float module,
                          float dark[ACROSS])
{
    const tmi_point e = wave->stripe.along;
    for (int j = 0; j < ACROSS; j++) {
        const float v = across_v(j) * module;
        float sum = 0;
        for (int k = -3; k <= 3; k++) {
            const float t = tmi_row_px(row, u + (float)k);
            sum += tmi_sample(view, wave->stripe.middle.x + t * e.x - v * e.y,
                              wave->stripe.middle.y + t * e.y + v * e.x);
        }
        dark[j] = (row->light - sum * (1.0f / 7)) / row->depth;
    }
}

/* Where a finder pattern lies across the stripe: a shift, px, and how much larger its height is. Beyond the quiet
 * zone there may be anything: it is taken for what is seen three modules from the ink. */
static bool fit_across(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, float u, float *shift,
                       float *growth)
{
    const float module = (wave->stripe.height + wave->stripe.taper * tmi_row_px(row, u)) * (1.0f / HEIGHT);
    const float reach = wave->prints.reach;
    const row_print finder = {.prints = &wave->prints};
    float seen[ACROSS];
    sample_across(view, wave, row, u, module, seen);
    const float above = 0.5f * (seen[0] + seen[1]), below = 0.5f * (seen[ACROSS - 1] + seen[ACROSS - 2]);
    tmi_normal normal = {0};
    tmi_normal_add(&normal, 0, 0, 1, 0, 1);
    for (int j = 3; j < ACROSS - 3; j++) {
        const float v = across_v(j);
        const blurred ink = row_dark(&finder, v), up = step_up(-4.5f - v, reach), down = step_up(v - 4.5f, reach);
        const float miss = seen[j] - ink.value - above * up.value - below * down.value;
        const float slope = ink.slope - above * up.slope + below * down.slope;
        tmi_normal_add(&normal, slope, slope * v, 0, miss, 1);
    }
    float p[3];
    if (!tmi_normal_solve(&normal, p))
        return false;
    *shift = -p[0] * module;
    *growth = -p[1];
    return real_abs(p[0]) < 1.5f && real_abs(p[1]) < 0.4f;
}

bool tmi_wave_fit_across(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, tmi_stripe *stripe,
                         uint32_t *reads)
{
    tmi_normal shift = {0};
    float growth = 0;
    tmi_normal_add(&shift, 0, 0, 1, 0, 1);
    const float half = 0.5f * (tmi_row_px(row, right_end(row)) - tmi_row_px(row, left_end(row)));
    int good = 0;
    for (int k = 0; k <= row->cm_count; k++) {
        const float u = (float)(PITCH * (row->first + k)), x = tmi_row_px(row, u) / half;
        float by, more;
        *reads += ACROSS * 7;
        if (!fit_across(view, wave, row, u, &by, &more))
            continue;
        tmi_normal_add(&shift, 1, x, 0, by, 1);
        growth += more;
        good++;
    }
    float p[3];
    if (2 * good < row->cm_count + 1 || !tmi_normal_solve(&shift, p))
        return false;
    const tmi_stripe *old = &wave->stripe;
    const float tilt = p[1] / half;
    *stripe = *old;
    stripe->middle = (tmi_point){old->middle.x - p[0] * old->along.y, old->middle.y + p[0] * old->along.x};
    const float length = 1 / real_sqrt(1 + tilt * tilt);
    stripe->along =
        (tmi_point){(old->along.x - tilt * old->along.y) * length, (old->along.y + tilt * old->along.x) * length};
    stripe->height = old->height * (1 + growth / (float)good);
    stripe->taper = -row->bend * stripe->height / row->module;
    return true;
}

/* ---- What finders show inside
 * ---------------------------------------------------------------------------------------- */

/* A line of 2 h modules around 0, blurred. */
static float bar(float x, float h, float reach)
{
    return step_up(x + h, reach).value - step_up(x - h, reach).value;
}

tmi_rings tmi_wave_rings(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, uint32_t *reads)
{
    const tmi_stripe *stripe = &wave->stripe;
    const float reach = wave->prints.reach;
    float n = 0, d = 0, dd = 0, s = 0, ss = 0, r = 0, rr = 0, rs = 0, rd = 0, sd = 0;
    for (int v = -4; v <= 4; v++)
        for (int u = -3; u <= 3; u++) {
            float sum = 0;
            for (int k = 0; k <= row->cm_count; k++) {
                const tmi_point at = tmi_row_at(stripe, row, (float)(PITCH * (row->first + k) + u), (float)v);
                sum += tmi_sample(view, at.x, at.y);
            }
            const float dark = (row->light - sum / (float)(row->cm_count + 1)) / row->depth;
            const float x = (float)u, y = (float)v;
            const float rings = bar(x, 1.5f, reach) * bar(y, 1.5f, reach) - bar(x, 2.5f, reach) * bar(y, 2.5f, reach);
            const float square = bar(x, 3.5f, reach) * bar(y, 3.5f, reach);
            n++;
            d += dark;
            dd += dark * dark;
            s += square;
            ss += square * square;
            r += rings;
            rr += rings * rings;
            rs += rings * square;
            rd += rings * dark;
            sd += square * dark;
        }
    *reads += (uint32_t)(63 * (row->cm_count + 1));
    rs -= r * s / n;
    rd -= r * d / n;
    sd -= s * d / n;
    rr -= r * r / n;
    ss -= s * s / n;
    dd -= d * d / n;
    const float along = rr - rs * rs / ss, strength = (rd - rs * sd / ss) / along;
    return (tmi_rings){strength, strength * strength * along / (dd - sd * sd / ss)};
}
