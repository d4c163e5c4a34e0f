/* The map of a tape that has been laid out. */
#ifndef MAKE_LAYOUT_MAP_H
#define MAKE_LAYOUT_MAP_H

#include "layout.h"
#include "map_file.h"

/* False when memory runs out. The caller releases the map. */
bool layout_map(const plan *wanted, const tape_layout *layout, tape_map *map, error_text *error);

/* The printed bits of an id as characters, for maps in the format of the marker's inventors. */
void layout_id_bits(int32_t id, char word[79], char checksum[9]);

#endif
