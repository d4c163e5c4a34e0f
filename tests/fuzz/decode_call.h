/* A call of tapemark_decode() of which a script says all but the image. */
#ifndef DECODE_CALL_H
#define DECODE_CALL_H

#include "byte_script.h"
#include "tapemark.h"

enum { DECODE_CMS = 64, DECODE_TMS = 16, DECODE_FINDERS = 128, DECODE_KNOWN_IDS = 16 };

/* Everything in memory of exactly the size that the decoder is told. */
typedef struct decode_call {
    tapemark_config config;
    bool default_config;    /* NULL in its place */
    tapemark_result result;
    uint16_t missing_bytes; /* of the workspace */
    size_t misalignment;    /* likewise */
    bool no_workspace;      /* NULL in its place */
    int32_t *known_ids;
} decode_call;

/* Takes its part off the script, 9 to 110 bytes. The caller releases the call. */
decode_call decode_call_read(byte_script *script);
void decode_call_release(decode_call *call);

/* Decodes, and claims what tapemark.h promises of any call: what is refused, the ranges of all that is reported, the
 * bound on the work, and that neither what the workspace held nor where it lies makes a difference. */
tapemark_status decode_call_run(decode_call *call, const tapemark_image *image);

#endif
