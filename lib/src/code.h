/* The marker's code, for the decoder: where each bit is printed, and ids and checksums straight from the
 * positions of a word's ones, without packing the word first.
 *
 * "Positions" are bit indexes in printed order, 0 to 77. Those of a negative id are its positive twin's: the
 * zeros of the word as printed. */
#ifndef TMI_CODE_H
#define TMI_CODE_H

#include "tapemark.h"

#define TMI_CHECKSUM_BITS 8

/* Stands for no id where an id is returned. */
#define TMI_NO_ID INT32_MIN

/* Cells, as row * 16 + column, of the data bits in printed order and of the checksum, highest bit first. */
extern const uint8_t tmi_data_cell[TAPEMARK_DATA_BITS];
extern const uint8_t tmi_checksum_cell[TMI_CHECKSUM_BITS];

/* Cells that are dark, or light, in every CM. Bit 15 is column 0. */
extern const uint16_t tmi_dark_rows[TAPEMARK_CELL_ROWS];
extern const uint16_t tmi_light_rows[TAPEMARK_CELL_ROWS];

/* Checksum as printed. Up to four distinct positions, in any order. */
uint8_t tmi_checksum_of_positions(const uint8_t *positions, unsigned count, bool negative);

/* TMI_NO_ID for more than four positions, for one above 77 or given twice, and for a negative word without
 * any: there is no -0. Any order will do. */
int32_t tmi_id_of_positions(const uint8_t *positions, unsigned count, bool negative);

/* Positions, ascending, of the word of an id that is in range; returns how many there are. */
unsigned tmi_positions_of_id(int32_t id, uint8_t positions[TAPEMARK_MAX_ONES]);

#endif
