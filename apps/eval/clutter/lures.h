/* Patterns of modules made to be mistaken for tapes, without being one. */
#ifndef CLUTTER_LURES_H
#define CLUTTER_LURES_H

#include "patterns.h"

/* Runs of 1:1:3:1:1 everywhere: in rows, in columns or in both. */
module_pattern carpet_lure;

/* Finder patterns close together. */
module_pattern finder_carpet_lure;

/* Finder patterns a CM apart in both directions, anything between them. */
module_pattern finder_lattice_lure;

/* QR codes, the finder patterns of neighbours often a CM apart. */
module_pattern qr_row_lure;

/* Rows of light and dark blocks between bars, as of a TM from afar, but of other numbers or lengths. */
module_pattern bar_block_lure;

/* Square codes with a dark border: ArUco-like, of no dictionary. */
module_pattern square_code_lure;

/* CMs with finder patterns, L and notch as they should be, and cells at random between them: far from the few or many
 * ones of an id. */
module_pattern random_cells_lure;

#endif
