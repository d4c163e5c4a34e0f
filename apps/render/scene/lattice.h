/* Points spread evenly over a pixel, all different in x and in y: an edge that lies along the pixels shifts by
 * 1 / count px at a time. Fibonacci numbers make the lattice (n, m) with the points (i / n, frac(i m / n)). */
#ifndef SCENE_LATTICE_H
#define SCENE_LATTICE_H

enum { LATTICE_MAX = 89 };

/* From the pixel's centre. */
typedef struct lattice {
    int count;
    double dx_px[LATTICE_MAX], dy_px[LATTICE_MAX];
} lattice;

/* 21 and 13, 34 and 21, 89 and 55. */
static inline lattice lattice_of(int count, int multiplier)
{
    lattice made = {.count = count};
    for (int i = 0; i < count; i++) {
        made.dx_px[i] = (i + 0.5) / count - 0.5;
        made.dy_px[i] = ((i * multiplier) % count + 0.5) / count - 0.5;
    }
    return made;
}

#endif
