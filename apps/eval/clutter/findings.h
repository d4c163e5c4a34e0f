/* What the decoder reads where there is nothing to be read. */
#ifndef CLUTTER_FINDINGS_H
#define CLUTTER_FINDINGS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "tapemark.h"

enum { FINDING_CMS_MAX = 64, FINDING_TMS_MAX = 16 };

/* One frame's. */
typedef struct finding {
    tapemark_result result;
    tapemark_cm cms[FINDING_CMS_MAX];
    tapemark_tm tms[FINDING_TMS_MAX];
    double decode_ms;
} finding;

/* All frames' of a kind. */
typedef struct kind_findings {
    size_t frames, cms, tms;
    size_t frames_with_finders, frames_with_candidates;  /* something to look at; pairs tried as a CM */
    double decode_ms_sum, decode_ms_max;
} kind_findings;

/* Decodes a frame with the default configuration; `workspace` is large enough. */
void find_markers(const tapemark_image *image, uint8_t *workspace, size_t workspace_bytes, finding *found);

void kind_findings_add(kind_findings *all, const finding *found);

/* The members of a JSON object, without its braces. */
void kind_findings_write(FILE *file, const kind_findings *all);

/* A JSON array of what was reported in a frame: none of it is there. */
void finding_write(FILE *file, const finding *found);

#endif
