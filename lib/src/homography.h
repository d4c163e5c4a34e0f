/* Plane to image in perspective. */
#ifndef TAPEMARK_HOMOGRAPHY_H
#define TAPEMARK_HOMOGRAPHY_H

#include "view.h"

/* Modules to pixels. For a CM, u runs along the tape from the centre of the left finder pattern (0) to that of the
 * right one (25), v across it, down, from the middle line (0). */
typedef struct tmi_homography {
    float h[8]; /* x = (h0 u + h1 v + h2) / w, y = (h3 u + h4 v + h5) / w, w = h6 u + h7 v + 1 */
} tmi_homography;

static inline tmi_point tmi_project(const tmi_homography *map, float u, float v)
{
    const float *h = map->h;
    const float w = 1 / (h[6] * u + h[7] * v + 1);
    return (tmi_point){(h[0] * u + h[1] * v + h[2]) * w, (h[3] * u + h[4] * v + h[5]) * w};
}

#endif
