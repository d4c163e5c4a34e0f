#include "least_squares.h"
#include "real.h"
#include "waveform.h"

enum { PITCH = TAPEMARK_CM_PITCH_MODULES, HEIGHT = TAPEMARK_HEIGHT_MODULES };

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
    const tmi_row_print finder = {.prints = &wave->prints};
    float seen[ACROSS];
    sample_across(view, wave, row, u, module, seen);
    const float above = 0.5f * (seen[0] + seen[1]), below = 0.5f * (seen[ACROSS - 1] + seen[ACROSS - 2]);
    tmi_normal normal = {0};
    tmi_normal_add(&normal, 0, 0, 1, 0, 1);
    for (int j = 3; j < ACROSS - 3; j++) {
        const float v = across_v(j);
        const tmi_blurred ink = tmi_row_dark(&finder, v), up = tmi_step_up(-4.5f - v, reach),
                          down = tmi_step_up(v - 4.5f, reach);
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
    const float half = 0.5f * (tmi_row_px(row, tmi_row_right(row)) - tmi_row_px(row, tmi_row_left(row)));
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

/* ---- What finders show inside -------------------------------------------------------------------------------- */

/* A line of 2 h modules around 0, blurred. */
static float bar(float x, float h, float reach)
{
    return tmi_step_up(x + h, reach).value - tmi_step_up(x - h, reach).value;
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
