#include "map_file.h"

#include "json_file.h"
#include "map_read.h"

#include <stdlib.h>

bool map_file_read(const char *path, map_id_check check_id, tape_map *map, error_text *error)
{
    *map = (tape_map){0};
    cJSON *root = json_file_read(path, error);
    if (root == NULL)
        return false;
    bool done = false;
    if (cJSON_IsObject(root))
        done = map_read_own(root, check_id, map, error);
    else if (cJSON_IsArray(root))
        done = map_read_paper(root, check_id, map, error);
    else
        error_text_set(error, "is no map: expected an object with \"format\": \"%s\", or an array of code markers",
                       MAP_FORMAT_NAME);
    if (!done)
        tape_map_release(map);
    cJSON_Delete(root);
    return done;
}

void tape_map_release(tape_map *map)
{
    free(map->cms);
    free(map->segments);
    *map = (tape_map){0};
}

bool map_point_on_plan(const tape_map *map, map_point point)
{
    return map->width_m <= 0 || (point.x_m >= -MAP_TOLERANCE_M && point.x_m <= map->width_m + MAP_TOLERANCE_M &&
                                 point.y_m >= -MAP_TOLERANCE_M && point.y_m <= map->height_m + MAP_TOLERANCE_M);
}
