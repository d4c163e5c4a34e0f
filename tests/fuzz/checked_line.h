/* The checks that stand at the end of what goes over the line, put right after everything else was changed: else next
 * to nothing of what is made up would get past them. */
#ifndef CHECKED_LINE_H
#define CHECKED_LINE_H

#include "fuzz_target.h"

/* Sentences, from $ to the two digits after *, and packets, between two bytes of 0, get the CRC and the sum of what
 * is in them. */
void check_line(uint8_t *bytes, size_t size);

#endif
