#include "elementary.h"

#include <math.h>

static const double pi = 3.14159265358979323846, ln_2 = 0.69314718055994530942;

direction direction_of(double angle_deg)
{
    const double quarters = floor(angle_deg / 90 + 0.5);
    const double x = (angle_deg - 90 * quarters) * (pi / 180), square = x * x;
    double cosine = 1, sine = 1;
    for (int k = 16; k >= 2; k -= 2) {
        cosine = 1 - square / (k * (k - 1)) * cosine;
        sine = 1 - square / (k * (k + 1)) * sine;
    }
    sine *= x;
    switch ((int)(quarters - 4 * floor(quarters / 4))) {
    case 0: return (direction){cosine, sine};
    case 1: return (direction){-sine, cosine};
    case 2: return (direction){-cosine, -sine};
    default: return (direction){sine, -cosine};
    }
}

double length_2d(double x, double y)
{
    return sqrt(x * x + y * y);
}

static double binary_logarithm(double value)
{
    int exponent;
    double mantissa = frexp(value, &exponent);
    if (mantissa < 0.70710678118654752440) {
        mantissa *= 2;
        exponent--;
    }
    const double ratio = (mantissa - 1) / (mantissa + 1), square = ratio * ratio;
    double series = 0;
    for (int k = 23; k >= 1; k -= 2)
        series = series * square + 1.0 / k;
    return exponent + 2 * ratio * series / ln_2;
}

static double power_of_two(double exponent)
{
    const double whole = floor(exponent + 0.5), rest = (exponent - whole) * ln_2;
    double series = 1;
    for (int k = 14; k >= 1; k--)
        series = 1 + rest / k * series;
    return ldexp(series, (int)fmin(fmax(whole, -2000), 2000));
}

double power(double base, double exponent)
{
    return base > 0 ? power_of_two(exponent * binary_logarithm(base)) : 0;
}

/* The sum of x^(2 k + 1) / (1 3 5 ... (2 k + 1)), times the density, is what lies between 0 and x. */
double normal_share_below(double value)
{
    const double far = 8;
    if (fabs(value) > far)
        return value > 0 ? 1 : 0;
    double term = value, sum = value;
    for (int k = 3; fabs(term) > 1e-17 * fabs(sum); k += 2) {
        term *= value * value / k;
        sum += term;
    }
    const double density = 0.39894228040143267794 * power_of_two(-0.5 * value * value / ln_2);
    return 0.5 + density * sum;
}
