/* Numbers that are right when they are near enough. */
#ifndef SCENE_NEAR_H
#define SCENE_NEAR_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static inline void assert_near_at(double value, double expected, double tolerance, const char *file, int line)
{
    if (!(fabs(value - expected) <= tolerance)) {
        print_error("%s:%d: %.5f is not within %.5f of %.5f\n", file, line, value, tolerance, expected);
        fail();
    }
}

#define assert_near(value, expected, tolerance) assert_near_at(value, expected, tolerance, __FILE__, __LINE__)

#endif
