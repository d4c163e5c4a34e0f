/* What panels look like, place by place. */
#ifndef SCENE_LOOKS_H
#define SCENE_LOOKS_H

#include "scene.h"

/* A panel ready to be painted. */
typedef struct panel_look {
    const scene_panel *panel;
    uint64_t seed;
    double light, dark;     /* linear light */
    double pattern_share;   /* of dark modules, for what is too far away to be told apart */
} panel_look;

panel_look panel_look_of(const scene *view, size_t panel_index);

/* Where on a panel, and how far a pixel reaches there; metres. */
typedef struct patch {
    double along_m, across_m;
    double reach_along_m, reach_across_m;
} patch;

/* Mean linear light of a patch. Of a shadow: the share of light that it leaves. */
double look_at(const panel_look *look, const patch *seen);

#endif
