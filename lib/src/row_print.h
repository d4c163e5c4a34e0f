/* What a row of CMs looks like from afar: the share of dark along it, blurred as the camera blurs it. */
#ifndef TAPEMARK_ROW_PRINT_H
#define TAPEMARK_ROW_PRINT_H

#include "tapemark.h"

/* The parts of a row in tables of four entries a module: shares of dark, blurred. */
#define TMI_BLUR_MAX 4
#define TMI_PRINT_STEPS 4
#define TMI_PRINT_ENTRIES(columns) (((columns)-1 + 2 * TMI_BLUR_MAX) * TMI_PRINT_STEPS + 1)
typedef struct tmi_prints {
    float reach; /* modules over which they are blurred; 0: not yet filled in */
    float finder[TMI_PRINT_ENTRIES(7)], bars[TMI_PRINT_ENTRIES(7)];
    float light[TMI_PRINT_ENTRIES(TAPEMARK_CELL_COLUMNS)], dark[TMI_PRINT_ENTRIES(TAPEMARK_CELL_COLUMNS)];
} tmi_prints;

typedef struct tmi_row_print {
    const tmi_prints *prints;
    int first, cm_count; /* finder 0 is at u = 0 */
    uint32_t dark;
    bool turned;  /* its coding regions are seen standing on the head */
    bool bars[2]; /* at the left and the right end */
} tmi_row_print;

typedef struct tmi_blurred {
    float value, slope; /* share of dark, and its change per module */
} tmi_blurred;

/* Fills the tables in for modules of this size and a blur of this standard deviation, unless they are. */
void tmi_prints_prepare(tmi_prints *prints, float module_px, float blur_px);

/* Share of dark at u. */
tmi_blurred tmi_row_dark(const tmi_row_print *print, float u);

/* A step from 0 to 1 at x = 0, blurred over `reach` modules as the prints are. */
tmi_blurred tmi_step_up(float x, float reach);

#endif
