/* A straight line through points, by least squares: how much of y it explains. */
#ifndef TAPEMARK_REGRESSION_H
#define TAPEMARK_REGRESSION_H

/* Sums over the points; in a waveform x is the share of dark, y the gray value. */
typedef struct tmi_regression {
    float n, x, xx, y, yy, xy;
} tmi_regression;

/* What the line explains of the squares of y around their mean, where y falls with x; else 0. */
static inline float tmi_explained(const tmi_regression *fit, float *gain)
{
    const float xx = fit->xx - fit->x * fit->x / fit->n, xy = fit->xy - fit->x * fit->y / fit->n;
    *gain = xx > 0 ? xy / xx : 0;
    return xx > 0 && xy < 0 ? xy * xy / xx : 0;
}

#endif
