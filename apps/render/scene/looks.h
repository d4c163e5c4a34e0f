/* What panels look like, place by place. */
#ifndef SCENE_LOOKS_H
#define SCENE_LOOKS_H

#include "scene.h"

enum { NOISE_SIDE = 128 };

typedef struct noise_table {
    float tones[NOISE_SIDE][NOISE_SIDE];  /* even over -1 to 1 */
} noise_table;

void fill_noise_table(uint64_t seed, noise_table *noise);

/* A panel ready to be painted. */
typedef struct panel_look {
    const scene_panel *panel;
    uint64_t seed;
    double light, dark;     /* linear light */
    double pattern_share;   /* of dark modules, for what is too far away to be told apart */
    const noise_table *noise;
} panel_look;

panel_look panel_look_of(const scene *view, const noise_table *noise, size_t panel_index);

/* Where on a panel, and how far a pixel reaches there; metres. */
typedef struct patch {
    double along_m, across_m;
    double reach_along_m, reach_across_m;
} patch;

/* Mean linear light of a patch. Of a shadow: the share of light that it leaves. */
double look_at(const panel_look *look, const patch *seen);

#endif
