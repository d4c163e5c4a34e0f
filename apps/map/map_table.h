/* A map file as the table in which the library looks places up. */
#ifndef MAP_TABLE_H
#define MAP_TABLE_H

#include "map_file.h"
#include "tapemark.h"

typedef struct map_table {
    tapemark_map map;  /* of the arrays below, which it owns */
    int32_t *ids;
    tapemark_map_cm *cms;
    tapemark_map_tm *tms;
} map_table;

/* Reads a map file, ours or that of the marker's inventors. False, with what is wrong and where, on failure. */
bool map_table_load(const char *path, map_table *table, error_text *error);

/* Makes a table of a map that has been read. False when memory runs out. */
bool map_table_make(const tape_map *source, map_table *table, error_text *error);

/* A zeroed table is fine. */
void map_table_release(map_table *table);

/* Makes the map's ids the only ones that are read. The table must outlive the configuration. */
void map_table_configure(const map_table *table, tapemark_config *config);

#endif
