/* The waveform of a far tape: gray values along a stripe, and the row of finder patterns and blocks that explains
 * them. Nothing in it needs a module to be resolved. */
#ifndef TAPEMARK_WAVEFORM_H
#define TAPEMARK_WAVEFORM_H

#include "row_print.h"
#include "stroke.h"

#include "tapemark.h"

enum { TMI_WAVE_SAMPLES = 1024 };

/* Means over the tape's height, along the stripe. */
typedef struct tmi_wave {
    tmi_stripe stripe;
    float start, step; /* px from the stripe's middle */
    int count;
    tmi_prints prints;
    uint16_t value[TMI_WAVE_SAMPLES]; /* 64 times the gray level */
} tmi_wave;

/* Sums of the samples before each one, for a first look at many places. */
enum { TMI_SUMS = 400 };
typedef struct tmi_wave_sums {
    float sum[TMI_SUMS + 1], squares[TMI_SUMS + 1];
    int per_sum; /* samples in each */
    int count;
} tmi_wave_sums;

/* A row of CMs along the wave. The finder patterns first..first + cm_count lie at u = 25 k; u modules from finder 0
 * are at origin + module * u / (1 + bend * u), in px from the stripe's middle. */
typedef struct tmi_row {
    float origin, module, bend;
    float blur_px;      /* standard deviation */
    int first, cm_count;
    uint32_t dark;      /* CM k is dark: bit k - first */
    bool turned;        /* it rather stands on the head, as the row runs */
    float light, depth; /* gray level of light modules, and how much darker dark ones are */
    float explained;    /* share of the wave's variance, 0 to 1 */
    float misfit;       /* root mean square of what it leaves unexplained, in parts of the depth */
    float bars[2];      /* how well bars fit at the left and right end, up to 1 */
} tmi_row;

static inline float tmi_row_px(const tmi_row *row, float u)
{
    return row->origin + row->module * u / (1 + row->bend * u);
}

/* Where its ink begins and ends, bars left out, in modules. */
static inline float tmi_row_left(const tmi_row *row)
{
    return (float)(TAPEMARK_CM_PITCH_MODULES * row->first) - 3.5f;
}

static inline float tmi_row_right(const tmi_row *row)
{
    return (float)(TAPEMARK_CM_PITCH_MODULES * (row->first + row->cm_count)) + 3.5f;
}

/* The image point v modules across from the row's middle line. */
static inline tmi_point tmi_row_at(const tmi_stripe *stripe, const tmi_row *row, float u, float v)
{
    const float t = tmi_row_px(row, u);
    const float down = v * (stripe->height + stripe->taper * t) * (1.0f / TAPEMARK_HEIGHT_MODULES);
    return (tmi_point){stripe->middle.x + t * stripe->along.x - down * stripe->along.y,
                       stripe->middle.y + t * stripe->along.y + down * stripe->along.x};
}

/* Samples the stripe from -reach to reach around its middle, in steps of this or what there is room for; px. */
void tmi_wave_sample(const tmi_view *view, const tmi_stripe *stripe, float reach, float step, tmi_wave *wave,
                     uint32_t *reads);

/* A first guess of where the row lies: its leftmost finder, one module, the CMs on from there. */
typedef struct tmi_guess {
    float origin, module; /* px */
    float gain;           /* how much of the wave it explains; 0: none was found */
    int cm_count;
} tmi_guess;

enum { TMI_GUESSES = 3 };

/* A first look at a wave sampled in steps of about a third of the height. */
typedef struct tmi_glance {
    bool flat;       /* it rises and falls too little for a tape */
    float roughness; /* mean square of the change from one sample to the next, in variances */
} tmi_glance;
tmi_glance tmi_wave_glance(const tmi_wave *wave);

/* Guesses, one for each range of modules, from a wave of about five pitches. */
void tmi_wave_guess_rows(const tmi_wave *wave, float roughness, tmi_wave_sums *sums, tmi_guess guesses[TMI_GUESSES],
                         uint32_t *work);

/* Fits such a guess to the same wave; false where it does not come to fit. */
bool tmi_wave_fit_guess(tmi_wave *wave, tmi_row *row, uint32_t *work);

/* Fits such a guess, and follows the row to both ends. */
bool tmi_wave_fit_row(tmi_wave *wave, tmi_row *row, uint32_t *work);

/* Finds out how blurred the row is: the blur by which it explains most. */
void tmi_wave_fit_blur(tmi_wave *wave, tmi_row *row, uint32_t *work);

/* How far the wave is from the coding region of the row's CM k and the gaps beside it: root mean square, in parts of
 * the depth. */
float tmi_wave_block_misfit(const tmi_wave *wave, const tmi_row *row, int k);

/* Fits the stripe to the finder patterns of the row, across: its place, direction and height. How the height changes
 * along it is a matter of perspective, as is the row's bend, which is known better. */
bool tmi_wave_fit_across(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, tmi_stripe *stripe,
                         uint32_t *reads);

/* The rings of the row's finder patterns, all of them together. */
typedef struct tmi_rings {
    float strength; /* as against those of the print: about 1, or 0 where there is anything else of their size */
    float share;    /* of what is there besides a square, 0 to 1 */
} tmi_rings;

tmi_rings tmi_wave_rings(const tmi_view *view, const tmi_wave *wave, const tmi_row *row, uint32_t *reads);

#endif
