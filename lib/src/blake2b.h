/* BLAKE2b (RFC 7693) for the one use that a tape marker has for it: 78 bytes in, one byte out, no key. */
#ifndef TMI_BLAKE2B_H
#define TMI_BLAKE2B_H

#include <stdint.h>

enum { TMI_BLAKE2B_MESSAGE_BYTES = 78, TMI_BLAKE2B_BLOCK_WORDS = 16 };

/* The digest of the message in `block`: its byte i in bits 8 (i % 8) and up of word i / 8, zeros after it. */
uint8_t tmi_blake2b_78(const uint64_t block[TMI_BLAKE2B_BLOCK_WORDS]);

#endif
