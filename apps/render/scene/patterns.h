/* Patterns of square modules without an end: what may be taken for a marker. */
#ifndef SCENE_PATTERNS_H
#define SCENE_PATTERNS_H

#include "scene.h"

/* Whether a module is dark. */
typedef bool module_pattern(uint64_t seed, int32_t column, int32_t row);

/* NULL for clutter that is not made of modules. */
module_pattern *module_pattern_of(scene_clutter kind);

#endif
