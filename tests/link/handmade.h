/* Messages made by hand: of fields that no sender writes, with checks that are right, or are not. */
#ifndef LINK_HANDMADE_H
#define LINK_HANDMADE_H

#include "link_test.h"

/* The CRC bit by bit, as textbooks have it. */
uint16_t slow_crc(const uint8_t *bytes, size_t count);

/* "PTMKF,1,2" as a sentence with both checks. */
message sentence_of(const char *fields);

/* The same with another CRC than it ought to have. */
message sentence_with_crc(const char *fields, const char *crc);

/* The payload of a packet up to its CRC, at most 60 bytes. */
message packet_of(const uint8_t *fields, size_t size);

#endif
