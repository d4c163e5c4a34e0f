/* Functions that give the same bits on every machine, which those of C libraries do not: they need nothing beyond
 * what IEEE 754 fixes to the last bit. */
#ifndef SCENE_ELEMENTARY_H
#define SCENE_ELEMENTARY_H

/* The unit vector at an angle: its cosine and sine, exact at multiples of 90 degrees. */
typedef struct direction {
    double x, y;
} direction;

direction direction_of(double angle_deg);

double length_2d(double x, double y);

/* base, 0 or more, to the power of an exponent. */
double power(double base, double exponent);

/* Share of a normal distribution with a standard deviation of 1 that lies below a value. */
double normal_share_below(double value);

#endif
