/* A serial line on which anything may happen, and what a receiver at its end has to make of it. */
#ifndef TEST_DAMAGED_LINE_H
#define TEST_DAMAGED_LINE_H

#include "records.h"

/* What was seen at the receiver's end. By encoding, where there are two. */
typedef struct line_tally {
    unsigned long sent[2];
    unsigned long damaged[2]; /* of those: not a byte in their place is missing from the others */
    unsigned long lost;       /* that came undamaged, and were not received with their last byte: there may be none */
    unsigned long wrong[2];   /* received, and never sent: as many as the checks let pass */
} line_tally;

/* Puts records in both encodings and noise on a line, damages it, and lets a receiver read it. `script` says what
 * records, noise and damage: any bytes will do. Adds what was seen to the tally. */
void run_damaged_line(const uint8_t *script, size_t size, line_tally *tally);

#endif
