/* Where the markers that were read hang on the floor plan. */
#ifndef DECODE_PLACES_H
#define DECODE_PLACES_H

#include "map_file.h"
#include "tapemark.h"

/* Which CM and segment of the map an id belongs to. */
typedef struct place_entry {
    int32_t id;
    size_t cm;
    size_t segment;
} place_entry;

typedef struct places {
    tape_map map;
    place_entry *entries;  /* in ascending order of ids */
    int32_t *ids;          /* the same order */
} places;

bool places_load(const char *map_path, places *loaded, error_text *error);
void places_release(places *loaded);

/* Makes the map's ids the only ones that are read. The places must outlive the configuration. */
void places_configure(const places *known, tapemark_config *config);

/* These give false when the map does not tell. `known` may be NULL: there is no map. */
bool places_find_cm(const places *known, int32_t id, map_point *point);

/* The middle of a TM: of the one that its CMs belong to, when any were read and all agree; without any, of the
 * only one with its code (or that code backwards, when the direction is not known). */
bool places_find_tm(const places *known, const tapemark_result *result, size_t tm_index, map_point *point);

#endif
