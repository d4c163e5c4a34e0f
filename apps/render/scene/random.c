#include "random.h"

static uint64_t mix(uint64_t z)
{
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* SplitMix64 (Steele, Lea, Flood 2014). */
uint64_t random_bits(random_source *source)
{
    source->state += UINT64_C(0x9e3779b97f4a7c15);
    return mix(source->state);
}

double random_unit(random_source *source)
{
    return (double)(random_bits(source) >> 11) * 0x1p-53;
}

/* The sum of four even numbers: near enough to normal for noise, and much cheaper than a logarithm a pixel. */
static float normal_of(uint64_t bits)
{
    int32_t sum = (int32_t)(bits & 0xffff) + (int32_t)(bits >> 16 & 0xffff) + (int32_t)(bits >> 32 & 0xffff) +
                  (int32_t)(bits >> 48);
    const float root_3_by_65536 = 2.6428964e-5f;
    return ((float)sum - 131070.0f) * root_3_by_65536;
}

float random_normal(random_source *source)
{
    return normal_of(random_bits(source));
}

float random_normal_at(uint64_t seed, int64_t x, int64_t y)
{
    return normal_of(random_at(seed, x, y));
}

uint64_t random_at(uint64_t seed, int64_t x, int64_t y)
{
    return mix(mix(seed + UINT64_C(0x9e3779b97f4a7c15) * (uint64_t)x) + UINT64_C(0xd1342543de82ef95) * (uint64_t)y);
}
