/* Finder patterns: from a hit on a scan line to a located square. */
#ifndef TAPEMARK_FINDER_H
#define TAPEMARK_FINDER_H

#include "homography.h"
#include "view.h"

#include <stdbool.h>

/* The 7 x 7 modules of a finder pattern as seen: a parallelogram, for perspective changes little within it.
 * The pattern looks the same when turned by a quarter, so which of the two axes runs along the tape is not
 * known from it alone. The axes are right-handed: `down` lies clockwise of `right` in the image. */
typedef struct tmi_finder {
    tmi_point centre;
    tmi_point right;   /* one module, px */
    tmi_point down;    /* one module, px */
    float score;       /* normalised correlation with the ideal pattern */
    float dark, light; /* gray values of its modules */
} tmi_finder;

/* Starts from a point within the core and a guess of one module's length along a scan line; looks around in 16
 * directions for the rings, and fits the square. False where there is none. `reads` grows by the pixels read. */
bool tmi_finder_locate(const tmi_view *view, tmi_point start, float module_px, float contrast, tmi_finder *finder,
                       uint32_t *reads);

/* Moves a finder that is off by up to about half a module to where its ring edges are, and scores it. */
bool tmi_finder_refine(const tmi_view *view, tmi_finder *finder, uint32_t *reads);

/* Correlation of the 9 x 9 modules around it (light margin included) with the ideal pattern; sets score, dark
 * and light. */
void tmi_finder_score(const tmi_view *view, tmi_finder *finder, uint32_t *reads);

/* Moves a finder to where, up to four modules along and one across, 25 of its modules correlate best with the ideal
 * pattern; sets score, dark and light from these. */
void tmi_finder_seek(const tmi_view *view, tmi_finder *finder, uint32_t *reads);

/* The print of a finder: whether the module (u, v) from its centre is dark. Its margin is light. */
static inline bool tmi_finder_is_dark(int u, int v)
{
    const int a = u < 0 ? -u : u, b = v < 0 ? -v : v, ring = a > b ? a : b;
    return ring <= 1 || ring == 3;
}

/* The finder's modules to pixels, (0, 0) at its centre. */
static inline tmi_homography tmi_finder_map(const tmi_finder *f)
{
    return (tmi_homography){{f->right.x, f->down.x, f->centre.x, f->right.y, f->down.y, f->centre.y, 0, 0}};
}

/* How far the modules of a finder lie from where a map has them, in modules: a shift, and how it grows with u and
 * v, both from the finder's centre. */
typedef struct tmi_offsets {
    float u[3], v[3];
} tmi_offsets;

/* How much the offsets move the finder's corners at most, roughly, in modules. */
float tmi_offsets_size(const tmi_offsets *by);

/* Measures the offsets of the finder whose centre the map has at (u0, 0), from the edges of its three rings as far
 * as they have this contrast. `span`, how far to look to both sides, is at most half a module. */
bool tmi_finder_offsets(const tmi_view *view, const tmi_homography *map, float u0, float span, float contrast_min,
                        tmi_offsets *out, uint32_t *reads);

static inline tmi_point tmi_at(const tmi_finder *finder, float u, float v)
{
    return (tmi_point){finder->centre.x + u * finder->right.x + v * finder->down.x,
                       finder->centre.y + u * finder->right.y + v * finder->down.y};
}

#endif
