/* What the readers of map files share. */
#ifndef PLATFORM_MAP_READ_H
#define PLATFORM_MAP_READ_H

#include "map_file.h"

#include <cjson/cJSON.h>

/* What the files say of themselves. */
#define MAP_FORMAT_NAME "tapemark-map"
enum { MAP_FORMAT_VERSION = 1 };

/* A TM has three CMs or more. */
enum { MAP_CODE_MIN = 3 };

/* The plan of the largest hall is smaller. */
#define MAP_COORDINATE_MAX_M 1e6

/* By how much what a map says twice may differ, and places may lie outside of the plan. */
#define MAP_TOLERANCE_M 0.0005

/* Each makes a map, zeroed before, of a whole file. On failure the caller releases what has been made of it. */
bool map_read_own(const cJSON *root, map_id_check check_id, tape_map *map, error_text *error);
bool map_read_paper(const cJSON *root, map_id_check check_id, tape_map *map, error_text *error);

/* Whether a point is on the plan; anywhere, when the plan's size is unknown. */
bool map_point_on_plan(const tape_map *map, map_point point);

#endif
