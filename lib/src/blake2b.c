#include "blake2b.h"

#include <string.h>

/* Digest length 1, no key, fan-out 1, depth 1: the parameter block's first word, RFC 7693 section 2.5. */
#define PARAMETERS UINT64_C(0x01010001)

static const uint64_t initial_state[8] = {
    UINT64_C(0x6a09e667f3bcc908), UINT64_C(0xbb67ae8584caa73b), UINT64_C(0x3c6ef372fe94f82b),
    UINT64_C(0xa54ff53a5f1d36f1), UINT64_C(0x510e527fade682d1), UINT64_C(0x9b05688c2b3e6c1f),
    UINT64_C(0x1f83d9abfb41bd6b), UINT64_C(0x5be0cd19137e2179),
};

/* The RFC's ten permutations; rounds 10 and 11 use the first two again. */
static const uint8_t sigma[12][16] = {
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
    {11, 8, 12, 0, 5, 2, 15, 13, 10, 14, 3, 6, 7, 1, 9, 4}, {7, 9, 3, 1, 13, 12, 11, 14, 2, 6, 5, 10, 4, 0, 15, 8},
    {9, 0, 5, 7, 2, 4, 10, 15, 14, 1, 11, 12, 6, 8, 3, 13}, {2, 12, 6, 10, 0, 11, 8, 3, 4, 13, 7, 5, 15, 14, 1, 9},
    {12, 5, 1, 15, 14, 13, 4, 10, 0, 7, 6, 3, 9, 2, 8, 11}, {13, 11, 7, 14, 12, 1, 3, 9, 5, 0, 15, 4, 8, 6, 2, 10},
    {6, 15, 14, 9, 11, 3, 0, 8, 12, 2, 13, 7, 1, 4, 10, 5}, {10, 2, 8, 4, 7, 6, 1, 5, 15, 11, 9, 14, 3, 12, 13, 0},
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, {14, 10, 4, 8, 9, 15, 13, 6, 1, 12, 0, 2, 11, 7, 5, 3},
};

static inline uint64_t rotate_right(uint64_t value, unsigned bits)
{
    return value >> bits | value << (64 - bits);
}

static inline void mix(uint64_t *a, uint64_t *b, uint64_t *c, uint64_t *d, uint64_t x, uint64_t y)
{
    *a += *b + x;
    *d = rotate_right(*d ^ *a, 32);
    *c += *d;
    *b = rotate_right(*b ^ *c, 24);
    *a += *b + y;
    *d = rotate_right(*d ^ *a, 16);
    *c += *d;
    *b = rotate_right(*b ^ *c, 63);
}

uint8_t tmi_blake2b_78(const uint64_t block[TMI_BLAKE2B_BLOCK_WORDS])
{
    uint64_t v[16];
    memcpy(v, initial_state, sizeof initial_state);
    memcpy(v + 8, initial_state, sizeof initial_state);
    v[0] ^= PARAMETERS;
    v[12] ^= TMI_BLAKE2B_MESSAGE_BYTES;
    v[14] = ~v[14]; /* the first block is the last one */

    for (unsigned round = 0; round < 12; round++) {
        const uint8_t *s = sigma[round];
        mix(&v[0], &v[4], &v[8], &v[12], block[s[0]], block[s[1]]);
        mix(&v[1], &v[5], &v[9], &v[13], block[s[2]], block[s[3]]);
        mix(&v[2], &v[6], &v[10], &v[14], block[s[4]], block[s[5]]);
        mix(&v[3], &v[7], &v[11], &v[15], block[s[6]], block[s[7]]);
        mix(&v[0], &v[5], &v[10], &v[15], block[s[8]], block[s[9]]);
        mix(&v[1], &v[6], &v[11], &v[12], block[s[10]], block[s[11]]);
        mix(&v[2], &v[7], &v[8], &v[13], block[s[12]], block[s[13]]);
        mix(&v[3], &v[4], &v[9], &v[14], block[s[14]], block[s[15]]);
    }
    return (uint8_t)(initial_state[0] ^ PARAMETERS ^ v[0] ^ v[8]);
}
