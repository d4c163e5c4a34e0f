#include "tm_codes.h"

static uint64_t all_ones(unsigned length)
{
    return (UINT64_C(1) << length) - 1;
}

static uint64_t mirrored(uint64_t code, unsigned length)
{
    uint64_t mirror = 0;
    for (unsigned i = 0; i < length; i++)
        mirror |= (code >> i & 1) << (length - 1 - i);
    return mirror;
}

/* The next smaller number with as many ones is, of the inverted one, the next larger: Gosper's hack. */
static void advance(tm_code_series *series, unsigned length)
{
    uint64_t all = all_ones(length), inverted = ~series->next & all;
    uint64_t lowest = inverted & (~inverted + 1), sum = inverted + lowest;
    if (inverted == 0) {
        series->exhausted = true;
    } else if (sum <= all) {
        series->next = ~(((sum ^ inverted) >> 2) / lowest | sum) & all;
    } else {
        series->ones++;
        series->next = all & ~(all >> series->ones);
    }
}

void tm_codes_init(tm_codes *codes, bool mirrored_too)
{
    *codes = (tm_codes){.mirrored_too = mirrored_too};
}

bool tm_codes_take(tm_codes *codes, unsigned length, bool starts_light, uint32_t *code)
{
    tm_code_series *series = &codes->of_length[length];
    uint64_t leading = UINT64_C(1) << (length - 1);
    if (starts_light) {
        series->leading_used = true;
        *code = (uint32_t)leading;
        return true;
    }
    while (!series->exhausted) {
        uint64_t candidate = series->next;
        advance(series, length);
        bool used = series->leading_used && candidate == leading;
        if (!used && (codes->mirrored_too || candidate > mirrored(candidate, length))) {
            *code = (uint32_t)candidate;
            return true;
        }
    }
    return false;
}

bool tm_code_light(uint32_t code, unsigned length, unsigned slot)
{
    return (code >> (length - 1 - slot) & 1) != 0;
}
