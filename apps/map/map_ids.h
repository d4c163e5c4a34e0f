/* What readers and writers of map files have to know about ids. */
#ifndef MAP_IDS_H
#define MAP_IDS_H

#include <stdbool.h>
#include <stdint.h>

/* A map_id_check and a map_id_bits of map_file.h. */
bool map_ids_check(int32_t id, const char *word, const char *checksum);
void map_ids_bits(int32_t id, char word[79], char checksum[9]);

#endif
