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

/* Whether the image holds the rectangle between (u0, v0) and (u1, v1) with a pixel to spare, which is more than
 * rounding takes. No corner must lie behind the camera: then all between them lies between their images. */
static inline bool tmi_rectangle_is_within(const tmi_view *view, const tmi_homography *map, float u0, float v0,
                                           float u1, float v1)
{
    const tmi_point corners[4] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
    for (int i = 0; i < 4; i++) {
        const tmi_point at = tmi_project(map, corners[i].x, corners[i].y);
        if (!(map->h[6] * corners[i].x + map->h[7] * corners[i].y > -1 && at.x > 1 && at.y > 1 &&
              at.x < (float)(view->width - 2) && at.y < (float)(view->height - 2)))
            return false;
    }
    return true;
}

#endif
