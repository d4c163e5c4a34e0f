/* The map of a tape that has been laid out. */
#ifndef MAKE_LAYOUT_MAP_H
#define MAKE_LAYOUT_MAP_H

#include "layout.h"
#include "map_file.h"

/* False when memory runs out. The caller releases the map. */
bool layout_map(const plan *wanted, const tape_layout *layout, tape_map *map, error_text *error);

#endif
