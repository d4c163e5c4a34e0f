/*
 * The map of a tape: which code marker (CM) hangs where on the floor plan, and which tape marker (TM) it is part
 * of. Reads the format of the marker's inventors: a JSON array with one object a CM and the keys
 *
 *     idcm_decimal   the id, a whole number
 *     x, y           its position on the plan, in metres
 *     idtm           the code of its TM, '0' and '1', or blank for a CM that stands alone
 *     n_tm           the running number of its TM, or blank
 *     idcm, checksum the 78 bits of its code word and the 8 of its checksum; may be left out
 *
 * Other keys are let pass.
 */
#ifndef PLATFORM_MAP_FILE_H
#define PLATFORM_MAP_FILE_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MAP_CODE_MAX = 64, MAP_NO_TM = -1 };

typedef struct map_cm {
    int32_t id;
    int32_t tm;  /* index in the map's tms, or MAP_NO_TM */
    double x_m;
    double y_m;
} map_cm;

typedef struct map_tm {
    char code[MAP_CODE_MAX + 1];
    bool complete;  /* all its CMs are on the map */
    double x_m;     /* mean of its CMs */
    double y_m;
} map_tm;

typedef struct tape_map {
    map_cm *cms;  /* in ascending order of ids, without repetition */
    size_t cm_count;
    map_tm *tms;
    size_t tm_count;
} tape_map;

/* Whether there is such an id, and its code word and checksum, as characters '0' and '1', are these; either may
 * be NULL. */
typedef bool (*map_id_check)(int32_t id, const char *word, const char *checksum);

/* Reads and checks a whole map; false, with the place in the file, when it is malformed or contradicts itself.
 * The caller releases the map. */
bool map_file_read(const char *path, map_id_check check_id, tape_map *map, error_text *error);

void tape_map_release(tape_map *map);

/* NULL for an id that is not on the map. */
const map_cm *tape_map_find_cm(const tape_map *map, int32_t id);

#endif
