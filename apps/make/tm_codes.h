/*
 * The codes of tape markers (TM), each handed out once. The first CM is the code's most significant bit, 1 is light.
 *
 * Fewest light CMs first, and among equals those that are light further left. A code that reads the same from both
 * ends is left out, and of a code and its mirror image only the first: whoever reads a TM upside down would take
 * one for the other. Cameras that know which way is up have all codes.
 */
#ifndef MAKE_TM_CODES_H
#define MAKE_TM_CODES_H

#include "tapemark.h"

typedef struct tm_code_series {
    uint64_t next;
    unsigned ones;      /* of `next` */
    bool exhausted;
    bool leading_used;  /* 10…0 was handed out before its turn */
} tm_code_series;

typedef struct tm_codes {
    bool mirrored_too;
    tm_code_series of_length[TAPEMARK_TM_MAX_CMS + 1];
} tm_codes;

void tm_codes_init(tm_codes *codes, bool mirrored_too);

/* False when all codes of this length, TAPEMARK_TM_MIN_CMS to TAPEMARK_TM_MAX_CMS, are in use. starts_light: the
 * first CM must be a light one, as that with the id 0 can only be; such a code is asked for before all others of
 * its length. */
bool tm_codes_take(tm_codes *codes, unsigned length, bool starts_light, uint32_t *code);

/* Whether a CM of a TM is light. */
bool tm_code_light(uint32_t code, unsigned length, unsigned slot);

#endif
