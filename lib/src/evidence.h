/* What the 112 cells of a CM show, set against what all words share: from this any word's fit is a short sum. */
#ifndef TAPEMARK_EVIDENCE_H
#define TAPEMARK_EVIDENCE_H

#include "code.h"

#include "tapemark.h"

/* The coding region as sampled: 0 is light, 1 is dark, and anything near that may occur. */
typedef struct tmi_cells {
    float value[TAPEMARK_CELLS];
    /* What each module gives to its next one along the tape and across it: the blur, in modules. */
    float leak_along, leak_across;
    bool narrow; /* modules are narrower, one way, than words need to be told from each other */
} tmi_cells;

/* Turns the cells by half a turn: as seen by a reader who stands on the head. */
void tmi_cells_turn(tmi_cells *cells);

/* What a print looks like under the blur of these cells; bit 15 of a row is its first column, 1 is dark. All around
 * it there is a light module. */
void tmi_cells_draw(const tmi_cells *cells, const uint16_t rows[TAPEMARK_CELL_ROWS], float out[TAPEMARK_CELLS]);

/* Correlation with what all words share, a quick measure of whether this way up is the right one. Adjusts the
 * scale of the cells to it. */
float tmi_blank_score(tmi_cells *cells);

/* The same both ways up, which are mostly compared with the same. */
void tmi_blank_scores(tmi_cells *cells, tmi_cells *turned, float scores[2]);

/* The cells that a word decides are numbered as bits: its 78 of data in printed order, then its 8 of checksum. A bit
 * is set where the word differs from the blank one, that is, from no ones (or, where most cells are dark, no zeros)
 * with a checksum of all 0 (or all 1). */
enum { TMI_BITS = TAPEMARK_DATA_BITS + TMI_CHECKSUM_BITS };

/* Sums over the 112 cells of a bit's blurred cell times what is seen there, and times the blank word. */
typedef struct tmi_bump {
    float on_seen;
    float on_blank;
} tmi_bump;

typedef struct tmi_evidence {
    float along[3], across[3];      /* overlap of two bumps that many cells apart */
    float last_along, first_across; /* of a bump with itself where the region's edge cuts it off */
    float leak_along, leak_across;
    float per_energy[2][2]; /* one over the square of a bump: whether in the first row, and in the last column */
    float sign; /* +1: ones are dark on light; -1: zeros are light on dark */
    float seen_sum, seen_energy, blank_sum, blank_energy, seen_blank;
    tmi_bump bumps[TMI_BITS];
} tmi_evidence;

/* From cells whose scale tmi_blank_score() has adjusted. */
void tmi_evidence_gather(tmi_evidence *e, const tmi_cells *cells);

/* How much of each bit is there, 0 to 1: the amounts of all bumps that together come nearest to what the cells show
 * beyond the blank word. What a one leaks into its neighbours is thus not counted for them. */
void tmi_evidence_amounts(const tmi_evidence *e, float amounts[TMI_BITS]);

/* Normalised correlation of the cells with the blank word in which `count` bits are changed. */
float tmi_evidence_correlate(const tmi_evidence *e, const uint8_t *changed, unsigned count);

/* By how much the squared error falls when one bit is set; the square of its bump, summed; and what two bumps share:
 * setting both gains twice that less than each for itself. */
float tmi_evidence_gain(const tmi_evidence *e, int bit);
float tmi_evidence_energy(const tmi_evidence *e, int bit);
float tmi_evidence_overlap(const tmi_evidence *e, int bit, int other_bit);

#endif
