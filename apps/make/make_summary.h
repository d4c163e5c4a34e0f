/* What was made, in a few lines for people. */
#ifndef MAKE_MAKE_SUMMARY_H
#define MAKE_MAKE_SUMMARY_H

#include "layout.h"

#include <stdio.h>

/* How much tape it is, which TMs, which ids, and what stands alone for want of codes. */
void make_summary_print(const plan *wanted, const tape_layout *layout, FILE *out);

#endif
