/* Which code markers go where along the lines of a plan. */
#ifndef MAKE_LAYOUT_H
#define MAKE_LAYOUT_H

#include "plan.h"
#include "tapemark.h"

/* A piece of tape that reads as one: a TM, or a CM that stands alone. */
typedef struct layout_segment {
    size_t line;           /* index in the plan's lines */
    size_t first_cm;       /* index in the layout's ids of its first CM, as it reads */
    size_t cm_count;
    bool bars;             /* a TM: three CMs or more */
    uint32_t start_modules;  /* from the beginning of its line to the left edge of its ink, behind the quiet zone */
} layout_segment;

typedef struct tape_layout {
    int32_t *ids;          /* in the order of drawing: |id| ascends by one from the plan's first id */
    size_t cm_count;
    layout_segment *segments;  /* in the order of drawing: line by line, and along each */
    size_t segment_count;
    size_t codeless_cms;   /* CMs that stand alone for want of a code, on stretches that would hold a TM */
} tape_layout;

/* Lays a tape along the lines of a plan: see README.md in this folder for which TMs, codes and ids go where. False
 * when there are not enough ids or codes, with how much of it could be covered. The caller releases the layout. */
bool layout_make(const plan *wanted, tape_layout *layout, error_text *error);

void layout_release(tape_layout *layout);

/* Modules of a segment's quiet zone before and after its ink: 2 at the ends of a TM, 1 of a CM that stands alone. */
unsigned layout_quiet_modules(const layout_segment *segment);

/* With its quiet zone. */
uint32_t layout_segment_modules(const layout_segment *segment);

/* Left edge of the ink of a CM of a segment, counted from the beginning of its line; it is 32 modules wide. */
uint32_t layout_cm_start_modules(const layout_segment *segment, size_t slot);

#endif
