/* The little floating point arithmetic that the compiler cannot be asked for by name in freestanding C. */
#ifndef TAPEMARK_REAL_H
#define TAPEMARK_REAL_H

static inline float real_sqrt(float x)
{
    return __builtin_sqrtf(x);
}

static inline float real_abs(float x)
{
    return x < 0 ? -x : x;
}

static inline float real_max(float a, float b)
{
    return a > b ? a : b;
}

static inline float real_min(float a, float b)
{
    return a < b ? a : b;
}

#endif
