/*
 * The device's end of the link: records in, bytes out. No heap, no globals, no I/O. What comes back on the line,
 * commands, is read with tapemark_receiver as well.
 */
#ifndef TAPEMARK_SENDER_H
#define TAPEMARK_SENDER_H

#include "tapemark_receiver.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum tapemark_encoding { TAPEMARK_SENTENCES, TAPEMARK_PACKETS } tapemark_encoding;

/* Writes one record. Fields whose flag is not set are left out, whatever they hold.
 *
 * Answers the number of bytes written; with a size of TAPEMARK_SENTENCE_MAX_BYTES every record fits. 0, the buffer's
 * content undefined, when it does not, when the type is none that is sent, or when a field is out of the range that
 * the format gives it: an angle of 3600, a confidence of 101, a text with a comma. */
size_t tapemark_record_write(const tapemark_record *record, tapemark_encoding encoding, uint8_t *buffer, size_t size);

/* Makes a text of a record from any string: as much as fits, NUL at the end, and '_' for each byte that may not be in
 * one. `size` is that of the member, at least 1. */
void tapemark_text_fit(char *member, size_t size, const char *text);

#ifdef __cplusplus
}
#endif

#endif
