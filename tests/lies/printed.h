/* Prints made module by module, as no honest printer makes them, held before the camera and decoded. */
#ifndef LIES_PRINTED_H
#define LIES_PRINTED_H

#include "decoding.h"
#include "forgery.h"

enum { PRINT_COLUMNS_MAX = 400, PRINT_ROWS_MAX = 60, PAPER = 203, INK = 22 };

typedef struct printed {
    uint8_t shades[PRINT_COLUMNS_MAX * PRINT_ROWS_MAX]; /* row by row */
    int columns, rows;
} printed;

/* All paper. */
void print_nothing(printed *print, int columns, int rows);

void print_module(printed *print, int column, int row, bool dark);

/* A segment whose ink begins there. */
void print_segment(printed *print, int column, int row, const int32_t *ids, size_t cm_count, bool bars);

/* A CM whose ink begins there, with these cells. */
void print_cells(printed *print, int column, int row, const forged_cells cells);

/* What is left of a column, or above a row, exchanged with what is right of it, or below. */
void print_mirror_columns(printed *print);
void print_mirror_rows(printed *print);

/* Copies a rectangle of another print; what lies outside of either is left out. */
void print_copy(printed *to, int column, int row, const printed *from, int from_column, int from_row, int columns,
                int rows);

/* Seen by a good camera, with a margin of paper all around. */
const decoding *decode_print(const printed *print, scene_pose pose, const tapemark_config *config, const char *name);

#endif
