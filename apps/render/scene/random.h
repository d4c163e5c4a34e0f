/* Random numbers that are the same on every machine. */
#ifndef SCENE_RANDOM_H
#define SCENE_RANDOM_H

#include <stdint.h>

/* Any value is a good seed. */
typedef struct random_source {
    uint64_t state;
} random_source;

uint64_t random_bits(random_source *source);

/* Even over 0 to 1, without 1. */
double random_unit(random_source *source);

/* Mean 0, standard deviation 1; never beyond 3.5. */
float random_normal(random_source *source);

/* The same for the same place and seed, without a sequence. */
float random_normal_at(uint64_t seed, int64_t x, int64_t y);

/* The same 64 bits for the same place and seed, without a sequence. */
uint64_t random_at(uint64_t seed, int64_t x, int64_t y);

#endif
