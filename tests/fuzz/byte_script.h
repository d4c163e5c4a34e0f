/* Bytes as a script: what is wanted is taken off its front, and is 0 when there is none left. */
#ifndef BYTE_SCRIPT_H
#define BYTE_SCRIPT_H

#include <string.h>

#include "fuzz_target.h"

typedef struct byte_script {
    const uint8_t *at;
    size_t left;
} byte_script;

static inline uint8_t script_byte(byte_script *script)
{
    if (script->left == 0)
        return 0;
    script->left--;
    return *script->at++;
}

static inline uint16_t script_u16(byte_script *script)
{
    const uint8_t low = script_byte(script);
    return (uint16_t)(low | script_byte(script) << 8);
}

static inline uint32_t script_u32(byte_script *script)
{
    const uint32_t low = script_u16(script);
    return low | (uint32_t)script_u16(script) << 16;
}

static inline int32_t script_i32(byte_script *script)
{
    const uint32_t bits = script_u32(script);
    int32_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* From least to most. */
static inline int32_t script_within(byte_script *script, int32_t least, int32_t most)
{
    return least + (int32_t)(script_u16(script) % (uint32_t)(most - least + 1));
}

/* Any float at all: half of them between 0 and 1, the rest of any bits, NaN and infinities among them. */
static inline float script_float(byte_script *script)
{
    const uint8_t kind = script_byte(script);
    const uint32_t bits = script_u32(script);
    float value;
    memcpy(&value, &bits, sizeof value);
    return kind % 2 == 0 ? (float)(bits >> 8) / (float)0xffffff : value;
}

/* Between least and most, in 256 steps. */
static inline float script_real(byte_script *script, float least, float most)
{
    return least + (most - least) * (float)script_byte(script) / 255;
}

#endif
