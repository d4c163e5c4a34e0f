/*
 * One piece of tape, drawn: ink, and outside of its quiet zone what people need to read.
 *
 *       ┼ ▲ 17            ▲ −18          ┼     upper band: ids, and which way is up
 *       ──────────────────────────────────     quiet zone and ink, nine modules in height
 *       ┼ L1 · 2|3   TM 1000   | 1.2 m   ┼     lower band: line and joints, codes, metre marks
 */
#ifndef PRINT_PIECE_H
#define PRINT_PIECE_H

#include "drawing.h"
#include "strip.h"

#define PIECE_BAND_MM 4.5  /* height of each of the two bands */
#define PIECE_FLAP_MM 6.0  /* white paper beyond a joint, which the next piece is glued onto */
#define PIECE_MARK_MM 2.5  /* what cut and joint marks take around a piece */

typedef struct piece_style {
    bool labels;
    bool marks;  /* where to cut and to join */
} piece_style;

double piece_length_mm(const plan *wanted, const tape_piece *piece);

/* Of the ink with its quiet zone. */
double piece_height_mm(const plan *wanted);

/* `at` is the top left corner of the quiet zone; where the piece is cut within the tape, of what is seen of it. */
void piece_draw(drawing *page, const plan *wanted, const tape_layout *layout, const tape_piece *piece,
                const tape_columns *drawn, const piece_style *style, drawing_point at);

/* The two bands alone. */
void piece_draw_labels(drawing *page, const plan *wanted, const tape_layout *layout, const tape_piece *piece,
                       drawing_point at);

#endif
