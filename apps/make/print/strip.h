/*
 * What is to be printed, still in one dimension: stretches of tape along a line, and the pieces they are cut into.
 * Places are counted in half modules from the beginning of the line: tape is cut in the middle of light columns.
 */
#ifndef PRINT_STRIP_H
#define PRINT_STRIP_H

#include "print.h"
#include "tapemark.h"

/* CMs that follow one another, with their quiet zones and bars where their segments end within. */
typedef struct tape_stretch {
    size_t line;
    size_t segment_begin, segment_end;  /* indices in the layout, the second one behind the last */
    size_t cm_begin, cm_end;
    int64_t start_halves, end_halves;
    bool cut_before, cut_after;  /* the tape goes on there: a piece to mend it with */
} tape_stretch;

typedef struct tape_stretches {
    tape_stretch *items;
    size_t count;
} tape_stretches;

/* All of the tape, or what the settings' `only` names; `by_segment`: no stretch goes on into the next segment.
 * The caller frees the items. */
bool strip_select(const tape_layout *layout, const print_settings *settings, bool by_segment, tape_stretches *all,
                  error_text *error);

/* The modules of a stretch: the columns that it touches from the left, bit 0 of each the top row, 1 is dark. */
typedef struct tape_columns {
    uint8_t *columns;
    int64_t first_module;
    size_t count;
} tape_columns;

/* The caller frees the columns. */
bool strip_draw(const tape_layout *layout, const tape_stretch *stretch, tape_columns *drawn, error_text *error);

/* Of the paper, without the white around it. */
typedef struct strip_limits {
    int64_t longest_halves;         /* of a piece whose end is no joint */
    int64_t longest_joined_halves;  /* of one with a joint, and a flap to glue, at its end */
    bool seams_first;               /* rather more pieces than a joint within a segment */
} strip_limits;

typedef struct tape_piece {
    const tape_stretch *stretch;
    int64_t start_halves, end_halves;
    size_t segment_begin, segment_end;  /* of which parts are on it */
    size_t number;                      /* from 1 along its line */
    bool joint_before, joint_after;     /* to the previous and to the next piece */
} tape_piece;

typedef struct tape_pieces {
    tape_piece *items;
    size_t count, capacity;
} tape_pieces;

/* Adds the pieces of a stretch: as few as possible, and of these cuts, those with the fewest joints within a segment
 * (the other way round with seams_first). False with `needed_halves` the longest way between two places for a joint
 * when the limits are below it; or with 0 when memory runs out. */
bool strip_cut(const tape_layout *layout, const tape_stretch *stretch, const tape_columns *drawn,
               const strip_limits *limits, tape_pieces *pieces, int64_t *needed_halves);

/* Right edge of a segment's ink. */
int64_t strip_ink_end_modules(const layout_segment *segment);

enum { STRIP_ID_BYTES = 24 };

/* As people read it, with a minus sign. */
void strip_format_id(int32_t id, char text[STRIP_ID_BYTES]);

/* A TM's bits, '1' for a light CM. */
void strip_format_code(const tape_layout *layout, const layout_segment *segment, char code[TAPEMARK_TM_MAX_CMS + 1]);

#endif
