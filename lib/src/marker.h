/* One code marker: from the finder patterns at its two ends to its cells. */
#ifndef TAPEMARK_MARKER_H
#define TAPEMARK_MARKER_H

#include "finder.h"
#include "word.h"

/* Modules of one CM to pixels: u along the tape from the centre of the left finder pattern (0) to that of the
 * right one (25), v across it, down, from the middle line (0). */
typedef struct tmi_homography {
    float h[8]; /* x = (h0 u + h1 v + h2) / w, y = (h3 u + h4 v + h5) / w, w = h6 u + h7 v + 1 */
} tmi_homography;

/* `right` of both finders runs from the left one to the right one. */
void tmi_homography_between(const tmi_finder *left, const tmi_finder *right, tmi_homography *out);

tmi_point tmi_project(const tmi_homography *map, float u, float v);

/* Samples the coding region, in the light and under the blur that its finder patterns show. False where those
 * differ too little between light and dark. */
bool tmi_marker_sample(const tmi_view *view, const tmi_homography *map, float contrast_min, tmi_cells *cells,
                       uint32_t *reads);

#endif
