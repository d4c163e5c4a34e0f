/* What the tests of this folder share: tapes laid by hand, what was printed as pixels, and what is read in them. */
#ifndef TEST_PRINTING_H
#define TEST_PRINTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "print.h"
#include "tapemark.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* ---- Tapes --------------------------------------------------------------------------------------------- */

/* Segments lie side by side in the order given. */
typedef struct hand_segment {
    size_t line;
    size_t cm_count;
    bool bars;
} hand_segment;

typedef struct hand_tape {
    plan wanted;
    tape_layout layout;
} hand_tape;

/* A plan of as many lines as needed, in a room of 100 x 100 m, with its tape; ids are taken in order. */
hand_tape hand_tape_new(double module_mm, const int32_t *ids, const hand_segment *segments, size_t segment_count);

/* TMs of six CMs, in one line or each in its own, and ids from first_id on; signs follow the bits of `codes`, six a
 * TM, the first CM's the highest. */
hand_tape hand_tape_of_tms(double module_mm, int32_t first_id, const unsigned *codes, size_t tm_count, bool apart);

void hand_tape_release(hand_tape *tape);

/* ---- Files --------------------------------------------------------------------------------------------- */

/* A new empty folder of this process, and a file in it. Static storage, until the next call but seven. */
const char *new_folder(void);
const char *path_in(const char *folder, const char *name);
void remove_folder(const char *folder);

/* How many entries a folder has; their names in order, at most 4096. */
size_t list_folder(const char *folder, char names[][64], size_t capacity);

/* The whole text of a file; the caller frees it. */
char *read_text(const char *path, size_t *size);

/* ---- Pixels -------------------------------------------------------------------------------------------- */

typedef struct raster {
    uint8_t *pixels;
    int32_t width_px, height_px;
    double px_per_mm;
} raster;

raster raster_read(const char *path, double dpi);
void raster_release(raster *picture);

/* Bilinear; white outside. (0, 0) is the centre of the first pixel. */
double raster_at(const raster *picture, double x_px, double y_px);

typedef struct raster_pages {
    raster *items;
    size_t count;
} raster_pages;

/* What pdftoppm makes of a PDF. */
raster_pages rasterise(const char *pdf_path, int dpi);
void raster_pages_release(raster_pages *pages);

void assert_text_has(const char *text, const char *wanted);

/* Not more than `tolerance` away. */
void assert_near(double seen, double wanted, double tolerance);

/* ---- Reading ------------------------------------------------------------------------------------------- */

enum { CMS_MAX = 256, TMS_MAX = 64 };

typedef struct readings {
    tapemark_cm cms[CMS_MAX];
    tapemark_tm tms[TMS_MAX];
    size_t cm_count, tm_count;
} readings;

/* What the decoder reads, CMs and TMs in rows from top to bottom, and from left to right within a row. */
void read_markers(const raster *picture, readings *read);

/* Segment `index` of the tape against what was read: its CMs from `*next_cm` on, its TM from `*next_tm` on, in the
 * right order, upright, and with the direction known. Both counts go on. */
void assert_reads_segment(const hand_tape *tape, size_t index, const readings *read, size_t *next_cm,
                          size_t *next_tm);

/* The same for all segments, and that nothing else was read. */
void assert_reads_all(const hand_tape *tape, const readings *read);

/* Looks at the modules of a segment between the corners of its ink, and at its quiet zone: each has to be as drawn by
 * tapemark_segment_draw(), and nothing may be dark in the quiet zone. */
void assert_modules(const raster *picture, const int32_t *ids, size_t cm_count, bool bars,
                    const tapemark_point corners[4]);

#endif
