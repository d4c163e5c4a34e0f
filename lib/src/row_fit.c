#include "least_squares.h"
#include "real.h"
#include "regression.h"
#include "waveform.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES };

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

static tmi_row_print print_of(const tmi_wave *wave, const tmi_row *row)
{
    return (tmi_row_print){.prints = &wave->prints,
                           .first = row->first,
                           .cm_count = row->cm_count,
                           .dark = row->dark,
                           .turned = row->turned};
}

/* Levels of light and dark by regression over the modules from..to, and what they leave unexplained. */
TMI_ONCE static void fit_levels(const tmi_wave *wave, tmi_row *row, const tmi_row_print *print, float from, float to)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    const float zero = sample_gray(wave, first);
    tmi_regression fit = {0};
    for (int i = first; i <= last; i++) {
        const float x = tmi_row_dark(print, row_u(row, sample_px(wave, i))).value, y = sample_gray(wave, i) - zero;
        fit.n++;
        fit.x += x;
        fit.xx += x * x;
        fit.y += y;
        fit.yy += y * y;
        fit.xy += x * y;
    }
    float gain;
    const float share = tmi_explained(&fit, &gain);
    const float variance = fit.yy - fit.y * fit.y / fit.n;
    row->depth = -gain;
    row->light = zero + (fit.y - gain * fit.x) / fit.n;
    row->explained = variance > 0 ? share / variance : 0;
    row->misfit = gain < 0 ? real_sqrt(real_max(0, variance - share) / fit.n) / -gain : 1;
}

/* Beyond these there is no tape that could be read. */
static const float module_min_px = 0.2f, bend_max = 0.0025f;

/* One step of fitting origin, module and bend to the samples between the modules from..to. */
static bool fit_step(const tmi_wave *wave, tmi_row *row, const tmi_row_print *print, float from, float to, bool bends)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    const float middle = 0.5f * (from + to), half = 0.5f * (to - from);
    tmi_normal shift = {0};
    for (int i = first; i <= last; i++) {
        const float u = row_u(row, sample_px(wave, i)), x = (u - middle) / half;
        const tmi_blurred dark = tmi_row_dark(print, u);
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
TMI_ONCE static float misfit(const tmi_wave *wave, const tmi_row *row, const tmi_row_print *print, float from,
                             float to)
{
    const int first = sample_at(wave, tmi_row_px(row, from)), last = sample_at(wave, tmi_row_px(row, to));
    float sum = 0;
    for (int i = first; i <= last; i++) {
        const float dark = tmi_row_dark(print, row_u(row, sample_px(wave, i))).value;
        const float miss = (row->light - sample_gray(wave, i)) / row->depth - dark;
        sum += miss * miss;
    }
    return real_sqrt(sum / (float)(last - first + 1));
}

/* Mean gray between the modules from..to. */
TMI_ONCE static float mean_gray(const tmi_wave *wave, const tmi_row *row, float from, float to)
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

/* What fits no better than this after that many steps will not come to fit. Blocks that are all light, or all dark,
 * leave little to explain. */
enum { FIT_STEPS = 4 };
static const float explained_min[FIT_STEPS] = {0.5f, 0.58f, 0.66f, 0.72f}, hopeless_misfit = 0.12f;

TMI_ONCE static bool fit_row(const tmi_wave *wave, tmi_row *row, int steps, uint32_t *work)
{
    find_code(wave, row);
    const tmi_row_print print = print_of(wave, row);
    for (int step = 0; step < steps; step++) {
        fit_levels(wave, row, &print, tmi_row_left(row), tmi_row_right(row));
        *work += (uint32_t)(0.5f * (tmi_row_right(row) - tmi_row_left(row)) * row->module / wave->step);
        if (!(row->depth > 1) || (row->explained < explained_min[step] && row->misfit > hopeless_misfit) ||
            !fit_step(wave, row, &print, tmi_row_left(row), tmi_row_right(row), row->cm_count > 3))
            return false;
    }
    return true;
}

/* A finder and its block have to fit this well to belong to the row, and bars to be some. */
static const float slot_misfit_max = 0.2f, bars_misfit_max = 0.2f;

/* How badly CM k of the row fits: its block and the finder beyond it. */
static float slot_misfit(const tmi_wave *wave, const tmi_row *row, int k, bool right)
{
    const tmi_row_print print = print_of(wave, row);
    const float u = (float)(PITCH * (row->first + k));
    return right ? misfit(wave, row, &print, u + 4, u + 28.5f) : misfit(wave, row, &print, u - 3.5f, u + 21);
}

float tmi_wave_block_misfit(const tmi_wave *wave, const tmi_row *row, int k)
{
    const tmi_row_print print = print_of(wave, row);
    const float u = (float)(PITCH * (row->first + k));
    return misfit(wave, row, &print, u + 3.5f, u + 21.5f);
}

/* Paper or a wall beyond the tape's end fits a light block well, but not the finder at its far end. */
static const float finder_misfit_max = 0.28f;

static float end_finder_misfit(const tmi_wave *wave, const tmi_row *row, bool right)
{
    const tmi_row_print print = print_of(wave, row);
    const float u = right ? tmi_row_right(row) - 3.5f : tmi_row_left(row) + 3.5f;
    return misfit(wave, row, &print, u - 3.5f, u + 3.5f);
}

static bool fits_at_end(const tmi_wave *wave, const tmi_row *row, bool right)
{
    return slot_misfit(wave, row, right ? row->cm_count - 1 : 0, right) <= slot_misfit_max &&
           end_finder_misfit(wave, row, right) <= finder_misfit_max;
}

/* Leaves out CMs at the ends that do not fit. */
static void trim(const tmi_wave *wave, tmi_row *row)
{
    while (row->cm_count > 0 && !fits_at_end(wave, row, true)) {
        row->cm_count--;
        row->dark &= (1u << row->cm_count) - 1;
    }
    while (row->cm_count > 0 && !fits_at_end(wave, row, false)) {
        row->cm_count--;
        row->first++;
        row->dark >>= 1;
    }
}

static float bars_misfit(const tmi_wave *wave, const tmi_row *row, bool right)
{
    tmi_row_print print = print_of(wave, row);
    print.bars[right] = true;
    return right ? misfit(wave, row, &print, tmi_row_right(row) + 0.5f, tmi_row_right(row) + 9.5f)
                 : misfit(wave, row, &print, tmi_row_left(row) - 9.5f, tmi_row_left(row) - 0.5f);
}

static bool in_wave(const tmi_wave *wave, const tmi_row *row, float u)
{
    const float px = tmi_row_px(row, u);
    return px > wave->start && px < -wave->start;
}

/* Goes on by one CM, where there is one that fits better than this. */
TMI_ONCE static bool extend(const tmi_wave *wave, tmi_row *row, bool right, float misfit_max, uint32_t *work)
{
    tmi_row longer = *row;
    longer.cm_count++;
    if (!right) {
        longer.first--;
        longer.dark <<= 1;
    }
    if (longer.cm_count > TAPEMARK_TM_MAX_CMS || !in_wave(wave, &longer, tmi_row_left(&longer)) ||
        !in_wave(wave, &longer, tmi_row_right(&longer)))
        return false;
    find_code(wave, &longer);
    if (slot_misfit(wave, &longer, right ? longer.cm_count - 1 : 0, right) > misfit_max ||
        end_finder_misfit(wave, &longer, right) > finder_misfit_max || !fit_row(wave, &longer, 2, work))
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
    tmi_row_print print = print_of(wave, row);
    print.bars[0] = print.bars[1] = true;
    for (int step = 0; step <= STEPS; step++) {
        const float from = tmi_row_left(row) - beyond, to = tmi_row_right(row) + beyond;
        fit_levels(wave, row, &print, from, to);
        *work += (uint32_t)(0.5f * (to - from) * row->module / wave->step);
        if (!(row->depth > 1) || (step < STEPS && !fit_step(wave, row, &print, from, to, true)))
            return false;
    }
    return true;
}

/* Blur of a wave, standard deviation: of a good camera's optics, its pixels, and bilinear sampling; px. */
static const float usual_blur_px = 0.7f;

bool tmi_wave_fit_guess(tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    row->blur_px = usual_blur_px;
    tmi_prints_prepare(&wave->prints, row->module, row->blur_px);
    return row->cm_count <= TAPEMARK_TM_MAX_CMS && fit_row(wave, row, FIT_STEPS, work);
}

bool tmi_wave_fit_row(tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    tmi_prints_prepare(&wave->prints, row->module, row->blur_px);
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

/* What a blur has to explain more than the usual one, a px away from it: what CMs show differs from the print by as
 * much as a little blur does. */
static const float unusual = 0.03f;

void tmi_wave_fit_blur(tmi_wave *wave, tmi_row *row, uint32_t *work)
{
    static const float blurs_px[] = {0.5f, 0.6f, 0.7f, 0.85f, 1.05f};
    const bool bars = row->bars[0] > 0 && row->bars[1] > 0;
    const float beyond = bars ? TAPEMARK_BAR_MODULES + 1 : 0;
    tmi_row_print print = print_of(wave, row);
    print.bars[0] = print.bars[1] = bars;
    float most = 0;
    for (int i = 0; i < 5; i++) {
        tmi_row tried = *row;
        const float from = tmi_row_left(row) - beyond, to = tmi_row_right(row) + beyond;
        tmi_prints_prepare(&wave->prints, row->module, blurs_px[i]);
        fit_levels(wave, &tried, &print, from, to);
        *work += (uint32_t)(0.5f * (to - from) * row->module / wave->step);
        const float worth = tried.explained - unusual * real_abs(blurs_px[i] - usual_blur_px);
        if (worth > most) {
            most = worth;
            row->blur_px = blurs_px[i];
        }
    }
    tmi_prints_prepare(&wave->prints, row->module, row->blur_px);
}
