/* Weighted least squares with three unknowns: gather the normal equations, then solve them. */
#ifndef TAPEMARK_LEAST_SQUARES_H
#define TAPEMARK_LEAST_SQUARES_H

#include <stdbool.h>

typedef struct tmi_normal {
    float a00, a01, a02, a11, a12, a22; /* symmetric matrix */
    float b0, b1, b2;
} tmi_normal;

/* Adds the equation x0 * p0 + x1 * p1 + x2 * p2 = y. */
static inline void tmi_normal_add(tmi_normal *n, float x0, float x1, float x2, float y, float weight)
{
    const float w0 = weight * x0, w1 = weight * x1, w2 = weight * x2;
    n->a00 += w0 * x0;
    n->a01 += w0 * x1;
    n->a02 += w0 * x2;
    n->a11 += w1 * x1;
    n->a12 += w1 * x2;
    n->a22 += w2 * x2;
    n->b0 += w0 * y;
    n->b1 += w1 * y;
    n->b2 += w2 * y;
}

/* False when the equations leave an unknown open. */
static inline bool tmi_normal_solve(const tmi_normal *n, float p[3])
{
    const float c00 = n->a11 * n->a22 - n->a12 * n->a12, c01 = n->a02 * n->a12 - n->a01 * n->a22;
    const float c02 = n->a01 * n->a12 - n->a02 * n->a11, c11 = n->a00 * n->a22 - n->a02 * n->a02;
    const float c12 = n->a01 * n->a02 - n->a00 * n->a12, c22 = n->a00 * n->a11 - n->a01 * n->a01;
    const float det = n->a00 * c00 + n->a01 * c01 + n->a02 * c02;
    if (!(det > 1e-3f * n->a00 * n->a11 * n->a22))
        return false;
    p[0] = (c00 * n->b0 + c01 * n->b1 + c02 * n->b2) / det;
    p[1] = (c01 * n->b0 + c11 * n->b1 + c12 * n->b2) / det;
    p[2] = (c02 * n->b0 + c12 * n->b1 + c22 * n->b2) / det;
    return true;
}

#endif
