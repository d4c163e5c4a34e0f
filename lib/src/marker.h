/* One code marker: from the finder patterns at its two ends to its cells. */
#ifndef TAPEMARK_MARKER_H
#define TAPEMARK_MARKER_H

#include "finder.h"
#include "word.h"

/* Maps the modules of the CM between two finders, whose `right` runs from the left one to the right one, as far as
 * they tell as parallelograms. */
void tmi_marker_map(const tmi_finder *left, const tmi_finder *right, tmi_homography *map);

/* Sets such a map right in perspective, by the ring edges of both finders. */
void tmi_marker_refine(const tmi_view *view, const tmi_finder *left, const tmi_finder *right, tmi_homography *map,
                       uint32_t *reads);

/* The maps of all CMs between `count` finders of a row, from all of them together: on one line, with one
 * perspective. More exact than one by one where they are small. False, and no map touched, where there are fewer
 * than four or they do not lie so. */
bool tmi_row_maps(const tmi_view *view, const tmi_finder *finders, int count, tmi_homography *maps, uint32_t *reads);

/* A first look at the coding region: one sample a cell, in the light that the finders show. */
void tmi_marker_glance(const tmi_view *view, const tmi_homography *map, const tmi_finder *left,
                       const tmi_finder *right, tmi_cells *cells, uint32_t *reads);

/* Samples the coding region, in the light and under the blur that its finder patterns show. False where those
 * differ too little between light and dark. */
bool tmi_marker_sample(const tmi_view *view, const tmi_homography *map, float contrast_min, tmi_cells *cells,
                       uint32_t *reads);

#endif
