/* What the parts of the reader of our own map format share. */
#ifndef PLATFORM_MAP_READING_H
#define PLATFORM_MAP_READING_H

#include "map_read.h"

/* What is being read, and where in the file. */
typedef struct map_reading {
    map_id_check check_id;
    tape_map *map;
    size_t segment;  /* index in the file */
    size_t cm;       /* index in its segment */
    error_text *error;
} map_reading;

typedef enum reading_place { IN_MAP, IN_SEGMENT, IN_CM } reading_place;

/* Says what is wrong, with the place in front; always false. */
__attribute__((format(printf, 3, 4)))
bool map_reading_refuse(const map_reading *reading, reading_place where, const char *format, ...);

bool map_reading_check_keys(const map_reading *reading, reading_place where, const cJSON *item,
                            const char *const *keys);

/* A number within bounds; `number` stays as it is where the key is missing. */
bool map_reading_number(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                        double least, double most, double *number);

bool map_reading_point(const map_reading *reading, reading_place where, const cJSON *item, const char *key,
                       map_point *point);

/* Both ends, and a direction that goes from one to the other; or neither: false in *given. */
bool map_reading_ends(const map_reading *reading, reading_place where, const cJSON *item, map_point *start,
                      map_point *end, bool *given);

/* Whether the ends of a segment, both of which are given, are as far apart as its modules take. */
bool map_reading_check_length(const map_reading *reading, const map_segment *segment);

/* Adds the CMs of a segment, whose code and ends have been read. */
bool map_reading_cms(map_reading *reading, const cJSON *cms, const map_segment *segment, bool ends_given);

double map_distance_m(map_point from, map_point to);

#endif
