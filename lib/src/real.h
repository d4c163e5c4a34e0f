/* The little floating point arithmetic that the compiler cannot be asked for by name in freestanding C. */
#ifndef TAPEMARK_REAL_H
#define TAPEMARK_REAL_H

#include "view.h"

/* Functions that compilers would copy to where they are called, at a cost in code that no speed is worth. */
#ifdef __clang__
#define TMI_ONCE __attribute__((noinline))
#else
#define TMI_ONCE __attribute__((noinline, noclone))
#endif

static inline float real_sqrt(float x)
{
    return __builtin_sqrtf(x);
}

static inline float real_abs(float x)
{
    return __builtin_fabsf(x);
}

static inline float real_max(float a, float b)
{
    return a > b ? a : b;
}

static inline float real_min(float a, float b)
{
    return a < b ? a : b;
}

/* Cosine and sine of an angle in degrees, -360 to 360, to about 1e-4: by its half turns and a Taylor series. */
static inline tmi_point real_direction(float degrees)
{
    const float half_turns = (float)(int)(degrees * (1.0f / 180) + (degrees < 0 ? -0.5f : 0.5f));
    const float a = (degrees - 180 * half_turns) * 0.01745329252f, s = a * a; /* -pi/2 to pi/2 */
    const float cosine = 1 - s * (1 / 2.0f - s * (1 / 24.0f - s * (1 / 720.0f - s * (1 / 40320.0f))));
    const float sine = a * (1 - s * (1 / 6.0f - s * (1 / 120.0f - s * (1 / 5040.0f - s * (1 / 362880.0f)))));
    const float sign = (int)half_turns & 1 ? -1.0f : 1.0f;
    return (tmi_point){sign * cosine, sign * sine};
}

#endif
