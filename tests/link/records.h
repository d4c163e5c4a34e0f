/* Records for the tests of the link: as text, drawn at random, and out of vectors.txt. */
#ifndef TEST_RECORDS_H
#define TEST_RECORDS_H

#include "tapemark_sender.h"

#include <stdio.h>

enum { RECORD_TYPES = TAPEMARK_RECORD_COMMAND, RECORD_TEXT_BYTES = 256 };

/* The next of a repeatable row of numbers; a state of 0 is none. */
uint32_t next_random(uint32_t *state);

/* From 0 to count - 1. */
uint32_t random_below(uint32_t *state, uint32_t count);

/* A record as a receiver would give it: fields that are not known are 0. Favours values at the ends of their ranges,
 * and zeros. */
tapemark_record random_record(uint32_t *state, uint8_t type);

/* Each field at the value that takes the most characters and bytes. */
tapemark_record longest_record(uint8_t type);

/* A record in the way of vectors.txt: "CM seq=4711 index=1 ...". */
void record_to_text(const tapemark_record *record, char text[RECORD_TEXT_BYTES]);

typedef struct test_vector {
    char fields[RECORD_TEXT_BYTES];
    uint8_t sentence[TAPEMARK_SENTENCE_MAX_BYTES];
    size_t sentence_size;
    uint8_t packet[TAPEMARK_PACKET_MAX_BYTES];
    size_t packet_size;
} test_vector;

/* The next vector of the file; false at its end. */
bool read_vector(FILE *file, test_vector *vector);

#endif
