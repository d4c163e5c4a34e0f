/*
 * The map of a tape: which code marker (CM) hangs where on the floor plan, and which tape marker (TM) it is part of.
 *
 * The plan is seen from above: x to the right, y down, in metres, as pictures have it. Directions are those in which
 * a tape reads, from the left end of its ink to the right end; a tape on a wall faces the side to the right of that
 * direction as the plan shows it.
 */
#ifndef PLATFORM_MAP_FILE_H
#define PLATFORM_MAP_FILE_H

#include "error_text.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MAP_CODE_MAX = 64 };

typedef struct map_point {
    double x_m, y_m;
} map_point;

typedef enum map_mount { MAP_MOUNT_UNKNOWN, MAP_ON_WALL, MAP_ON_FLOOR } map_mount;

typedef struct map_cm {
    int32_t id;
    map_point centre;
    map_point start, end;  /* of the ink; both at the centre where the map does not tell */
} map_cm;

/* A TM, or a CM that stands alone. */
typedef struct map_segment {
    char code[MAP_CODE_MAX + 1];  /* '1' for a light CM, '0' for a dark one; empty for a CM that stands alone */
    size_t first_cm;              /* its CMs stand in the map one after another, as it reads */
    size_t cm_count;
    bool complete;                /* all CMs of the code are on the map */
    map_point start, end;         /* of the ink, bars included; both at the centre where the map does not tell */
    map_mount mount;
    double above_floor_m;         /* of its middle; 0 where unknown */
} map_segment;

typedef struct tape_map {
    double width_m, height_m;  /* of the plan; 0 where unknown */
    double module_mm;          /* 0 where unknown */
    map_cm *cms;               /* segment by segment */
    size_t cm_count;
    map_segment *segments;
    size_t segment_count;
} tape_map;

/* Whether there is such an id, and its code word and checksum, as characters '0' and '1', are these; either may
 * be NULL. */
typedef bool (*map_id_check)(int32_t id, const char *word, const char *checksum);

/* The code word of an id, 78 characters '0' and '1', and its checksum, 8 of them; both end with a NUL. */
typedef void (*map_id_bits)(int32_t id, char word[79], char checksum[9]);

/* Reads and checks a whole map, ours or the inventors'; which, its content tells. False, with the place in the file,
 * when it is malformed or contradicts itself. The caller releases the map. */
bool map_file_read(const char *path, map_id_check check_id, tape_map *map, error_text *error);

/* Writes a map in our format, or in that of the marker's inventors. False, with nothing left behind, when the file
 * cannot be written. */
bool map_file_write(const char *path, const tape_map *map, error_text *error);
bool map_file_write_paper(const char *path, const tape_map *map, map_id_bits bits_of, error_text *error);

void tape_map_release(tape_map *map);

#endif
