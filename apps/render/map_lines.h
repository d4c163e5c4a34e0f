/* Where the ink of a map's segments lies on the plan. */
#ifndef RENDER_MAP_LINES_H
#define RENDER_MAP_LINES_H

#include "map_file.h"
#include "scene.h"

double line_length_m(scene_line line);

/* On a wall; it does as well where the map does not tell. */
bool map_segment_hangs(const map_segment *segment);

/* From the left end of a segment's ink to the right one. Maps of the inventors tell only where the middles of the CMs
 * are: then from the first to the last of them, and on; a CM that stands alone reads as its neighbour in the map and
 * it lie. `module_m` counts where the map does not tell it. False when all that does not help. */
bool map_segment_line(const tape_map *map, size_t segment, double module_m, scene_line *line);

#endif
