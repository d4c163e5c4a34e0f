#include "paper.h"
#include "piece.h"

#include <math.h>
#include <string.h>

typedef struct paper_kind {
    const char *option, *name;
    double width_mm, height_mm;  /* lying */
    double margin_mm;
} paper_kind;

static const paper_kind kinds[] = {
    [PRINT_A4] = {"a4", "A4", 297, 210, 10},
    [PRINT_A3] = {"a3", "A3", 420, 297, 10},
    [PRINT_LETTER] = {"letter", "Letter", 279.4, 215.9, 10},
    [PRINT_ROLL] = {"roll", "a roll", DRAWING_PDF_SIDE_MAX_MM, DRAWING_PDF_SIDE_MAX_MM, 3},
};

#define SCALE_MIN 0.9
#define SCALE_MAX 1.1
#define MARGIN_MAX_MM 25.0

bool print_paper_parse(const char *text, print_paper *paper)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (strcmp(text, kinds[i].option) == 0) {
            *paper = (print_paper)i;
            return true;
        }
    }
    return false;
}

double paper_row_mm(const plan *wanted)
{
    return piece_height_mm(wanted) + 2 * PIECE_BAND_MM + PIECE_MARK_MM;
}

/* Rounded down, so that it does fit. */
static void tell_too_large(const plan *wanted, const paper_room *room, double largest_mm, error_text *error)
{
    error_text_set(error, "a module of %.10g mm is too large for %s with margins of %.10g mm: at most %.2f mm fit",
                   wanted->module_mm, room->name, room->margin_mm, floor(largest_mm * 100) / 100);
}

void paper_tell_too_narrow(const plan *wanted, const paper_room *room, int64_t needed_halves, error_text *error)
{
    double joined_mm = room->width_mm - 2 * PIECE_MARK_MM - PIECE_FLAP_MM;
    double by_height_mm = (room->height_mm - PAPER_FOOTER_MM - 2 * PIECE_MARK_MM - 2 * PIECE_BAND_MM) / 9;
    double by_width_mm = 2 * joined_mm / (double)needed_halves;
    tell_too_large(wanted, room, by_width_mm < by_height_mm ? by_width_mm : by_height_mm, error);
}

static bool set_scale(const print_settings *settings, paper_room *room, error_text *error)
{
    room->scale_x = settings->scale_x == 0 ? 1 : settings->scale_x;
    room->scale_y = settings->scale_y == 0 ? 1 : settings->scale_y;
    bool in_range = room->scale_x >= SCALE_MIN && room->scale_x <= SCALE_MAX && room->scale_y >= SCALE_MIN &&
                    room->scale_y <= SCALE_MAX;
    if (!in_range)
        error_text_set(error, "a scale correction is from %.1f to %.1f, not %.10g and %.10g", SCALE_MIN, SCALE_MAX,
                       room->scale_x, room->scale_y);
    return in_range;
}

static int64_t halves_within(const plan *wanted, double length_mm)
{
    /* What is exactly as long as the paper has room for is not to be lost to rounding. */
    return (int64_t)floor(2 * length_mm / wanted->module_mm + 1e-6);
}

bool paper_measure(const plan *wanted, const print_settings *settings, paper_room *room, error_text *error)
{
    const paper_kind *kind = &kinds[settings->paper];
    *room = (paper_room){.name = kind->name, .page_width_mm = kind->width_mm, .page_height_mm = kind->height_mm,
                         .margin_mm = settings->margin_mm == 0 ? kind->margin_mm : settings->margin_mm};
    if (!(room->margin_mm >= 0 && room->margin_mm <= MARGIN_MAX_MM)) {
        error_text_set(error, "a margin is from 0 to %.0f mm, not %.10g", MARGIN_MAX_MM, room->margin_mm);
        return false;
    }
    if (!set_scale(settings, room, error))
        return false;
    room->width_mm = (room->page_width_mm - 2 * room->margin_mm) / room->scale_x;
    room->height_mm = (room->page_height_mm - 2 * room->margin_mm) / room->scale_y;
    double rows = floor((room->height_mm - PAPER_FOOTER_MM - PIECE_MARK_MM) / paper_row_mm(wanted) + 1e-9);
    room->limits.seams_first = settings->paper == PRINT_ROLL;
    room->limits.longest_halves = halves_within(wanted, room->width_mm - 2 * PIECE_MARK_MM);
    room->limits.longest_joined_halves = halves_within(wanted, room->width_mm - 2 * PIECE_MARK_MM - PIECE_FLAP_MM);
    if (!(rows >= 1)) {
        /* 17 modules, the coding region, are the longest way between two places for a joint. */
        paper_tell_too_narrow(wanted, room, 34, error);
        return false;
    }
    room->rows = settings->paper == PRINT_ROLL ? 1 : (size_t)rows;
    return true;
}
