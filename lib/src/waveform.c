#include "waveform.h"

#include "real.h"
#include "regression.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES, HEIGHT = TAPEMARK_HEIGHT_MODULES };

/* ---- Sampling ------------------------------------------------------------------------------------------------ */

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

/* ---- First look ---------------------------------------------------------------------------------------------- */

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

static void add_stretch(const tmi_wave_sums *s, int from, int to, float dark, tmi_regression *fit)
{
    const float n = (float)(to - from), y = s->sum[to] - s->sum[from];
    fit->n += n;
    fit->x += n * dark;
    fit->xx += n * dark * dark;
    fit->y += y;
    fit->xy += y * dark;
}

/* How much of the wave a row with finders at `origin` + k * `pitch`, in sums, explains; its blocks are dark where
 * they are darker than the finders beside them. */
static float coarse_gain(const tmi_wave_sums *s, float origin, float pitch, int *first, int *count, float *share)
{
    const float module = pitch * (1.0f / PITCH);
    tmi_regression fit = {0};
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
    const float gain = tmi_explained(&fit, &slope);
    *share = fit.yy > 0 ? gain / fit.yy : 0;
    return gain;
}

/* Part of the wave's variance that a first look has to explain. */
static const float coarse_min = 0.25f;

/* Over five pitches, half a step makes a module at the ends. */
static const float pitch_step = 0.95f;

/* The pitch that explains most, between two bounds in sums. */
static void best_pitch(const tmi_wave *wave, const tmi_wave_sums *s, float least, float most, tmi_guess *guess,
                       uint32_t *work)
{
    const float unit = wave->step * (float)s->per_sum;
    uint32_t tried = 0;
    for (float pitch = most; pitch > least; pitch *= pitch_step) {
        const float hop = real_max(0.5f, pitch * (1.25f / PITCH));
        for (float origin = 0; origin < pitch; origin += hop) {
            int first = 0, count;
            float share = 0;
            float gain = coarse_gain(s, origin, pitch, &first, &count, &share);
            gain *= share * share;
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

/* The wave along a tape rises and falls by more than this part of its strokes' contrast, be it dark throughout but
 * for its finder patterns; along a lone line, a gap between boards or a shadow's edge it does not. Standard
 * deviation. */
static const float swing_min = 0.2f;

tmi_glance tmi_wave_glance(const tmi_wave *wave)
{
    float sum = 0, squares = 0, changes = 0, before = 0;
    for (int i = 0; i < wave->count; i++) {
        const float value = (float)(wave->value[i] - wave->value[0]) * (1.0f / 64);
        sum += value;
        squares += value * value;
        changes += (value - before) * (value - before);
        before = value;
    }
    const float n = (float)wave->count, swing = swing_min * wave->stripe.contrast;
    const float variance = squares - sum * sum / n;
    return (tmi_glance){variance<swing * swing * n, variance> 0 ? changes / variance : 0};
}

/* From one sample of the glance to the next, letters change more than blocks do that are as long as that: no pitch is
 * tried that is too long for how rough the wave is. A row of pitch p, in glances, has a roughness of 10 / p at most.
 */
static const float roughness_max[TMI_GUESSES] = {1.5f, 1.9f, 2.6f};

void tmi_wave_guess_rows(const tmi_wave *wave, float roughness, tmi_wave_sums *sums, tmi_guess guesses[TMI_GUESSES],
                         uint32_t *work)
{
    sum_up(wave, sums);
    const float full = wave->stripe.height * ((float)PITCH / HEIGHT) / (wave->step * (float)sums->per_sum);
    for (int i = 0; i < TMI_GUESSES; i++) {
        guesses[i] = (tmi_guess){0};
        if (roughness < roughness_max[i])
            best_pitch(wave, sums, full * pitch_bounds[i + 1], full * pitch_bounds[i], &guesses[i], work);
    }
}
