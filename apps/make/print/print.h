/*
 * The tape on paper: pages for printers, vector and pixel pictures of each segment, and a picture of the plan.
 *
 * All of it is written at true size, the module of the plan. Functions that write a folder of files number them in
 * the order of drawing and name the ids that they hold: tape-003-cm0017-0020.svg. On failure the error names the file
 * or the setting; the file that failed is removed, files of the same folder that were finished before it stay.
 */
#ifndef PRINT_PRINT_H
#define PRINT_PRINT_H

#include "layout.h"

typedef enum print_paper { PRINT_A4, PRINT_A3, PRINT_LETTER, PRINT_ROLL } print_paper;

typedef enum print_picture_format { PRINT_PNG, PRINT_PGM } print_picture_format;

/* Of ids without their signs, both ends included. */
typedef struct print_id_range {
    int32_t first, last;
} print_id_range;

/* Zeroed settings, with a dpi where pictures are wanted, are good ones. */
typedef struct print_settings {
    print_paper paper;           /* sheets lie on their longer side */
    double margin_mm;            /* that stays white on each side of a page, up to 25; 0: 10 on sheets, 3 on a roll */
    double scale_x, scale_y;     /* what lengths along and across the tape are multiplied by, for printers that
                                    stretch, 0.9 to 1.1; 0: 1 */
    const print_id_range *only;  /* print just these CMs, as pieces to mend a tape with; NULL: all of it */
    size_t only_count;
    double dpi;                  /* of pictures */
    bool without_labels;         /* of SVG and pictures: just ink and quiet zone */
} print_settings;

/* What was written, for the user to be told. */
typedef struct print_summary {
    size_t pages;   /* of a PDF; files of a folder */
    size_t pieces;  /* to be cut out */
    size_t joints;  /* where two of them are to be glued together */
} print_summary;

/* Whether `text` names a paper: a4, a3, letter or roll. */
bool print_paper_parse(const char *text, print_paper *paper);

/* One PDF with all pieces. Sheets: the tape in tiles, joined where a column of modules is light. Roll: one page as
 * long as the tape, several where that is longer than a PDF's page can be. */
bool print_pdf(const plan *wanted, const tape_layout *layout, const print_settings *settings, const char *path,
               print_summary *summary, error_text *error);

/* An SVG for each segment. */
bool print_svgs(const plan *wanted, const tape_layout *layout, const print_settings *settings, const char *folder,
                print_summary *summary, error_text *error);

/* A gray picture for each segment, each pixel as dark as the share of it that ink covers. */
bool print_pictures(const plan *wanted, const tape_layout *layout, const print_settings *settings,
                    print_picture_format format, const char *folder, print_summary *summary, error_text *error);

/* A picture of the plan as seen from above with the tape drawn in, as PNG. */
bool print_preview(const plan *wanted, const tape_layout *layout, const char *path, error_text *error);

#endif
