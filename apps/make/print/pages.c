/* Pieces on the pages of a PDF. */
#include "paper.h"
#include "piece.h"

#include "tapemark.h"

#include <stdio.h>
#include <stdlib.h>

/* Where a piece's quiet zone begins, within the margins of its page. */
typedef struct piece_place {
    size_t page;  /* from 0 */
    drawing_point at;
} piece_place;

typedef struct print_job {
    const plan *wanted;
    const tape_layout *layout;
    bool roll;
    paper_room room;
    tape_stretches stretches;
    tape_pieces pieces;
    piece_place *places;  /* one a piece */
    size_t page_count;
} print_job;

/* ---- Cutting and placing ------------------------------------------------------------------------------- */

static bool cut_stretch(print_job *job, const tape_stretch *stretch, error_text *error)
{
    tape_columns drawn;
    int64_t needed_halves;
    if (!strip_draw(job->layout, stretch, &drawn, error))
        return false;
    bool done = strip_cut(job->layout, stretch, &drawn, &job->room.limits, &job->pieces, &needed_halves);
    if (!done && needed_halves > 0)
        paper_tell_too_narrow(job->wanted, &job->room, needed_halves, error);
    else if (!done)
        error_text_set(error, "not enough memory to cut a tape of %zu modules", drawn.count);
    free(drawn.columns);
    return done;
}

static double footprint_mm(const print_job *job, const tape_piece *piece)
{
    return piece_length_mm(job->wanted, piece) + 2 * PIECE_MARK_MM + (piece->joint_after ? PIECE_FLAP_MM : 0);
}

/* In order, side by side as far as there is room, row by row, page by page. */
static bool place_pieces(print_job *job, error_text *error)
{
    size_t row = 0;
    double taken_mm = 0;
    job->places = malloc(job->pieces.count * sizeof *job->places);
    if (job->places == NULL) {
        error_text_set(error, "not enough memory for %zu pieces of tape", job->pieces.count);
        return false;
    }
    job->page_count = 1;
    for (size_t i = 0; i < job->pieces.count; i++) {
        double width_mm = footprint_mm(job, &job->pieces.items[i]);
        if (taken_mm > 0 && taken_mm + width_mm > job->room.width_mm + 1e-6) {
            taken_mm = 0;
            row++;
        }
        if (row == job->room.rows) {
            row = 0;
            job->page_count++;
        }
        drawing_point at = {taken_mm + PIECE_MARK_MM,
                            PIECE_MARK_MM + PIECE_BAND_MM + (double)row * paper_row_mm(job->wanted)};
        job->places[i] = (piece_place){job->page_count - 1, at};
        taken_mm += width_mm;
    }
    return true;
}

/* ---- Drawing ------------------------------------------------------------------------------------------- */

#define RULER_MM 100
#define FOOTER_TEXT_MM (RULER_MM + 9.0)
#define FOOTER_WIDTH_MM 240.0

static void draw_ruler(drawing *page, double baseline_mm)
{
    const drawing_font font = {2.2, false, DRAWING_MIDDLE, 0};
    const double half_line_mm = 0.05;
    drawing_add_line(page, (drawing_point){-half_line_mm, baseline_mm},
                     (drawing_point){RULER_MM + half_line_mm, baseline_mm});
    for (int x_mm = 0; x_mm <= RULER_MM; x_mm += 5) {
        double tick_mm = x_mm % 50 == 0 ? 2.8 : x_mm % 10 == 0 ? 2.2 : 1.4;
        drawing_add_line(page, (drawing_point){x_mm, baseline_mm}, (drawing_point){x_mm, baseline_mm - tick_mm});
    }
    drawing_stroke(page, 2 * half_line_mm, 0);
    const drawing_font left = {2.2, false, DRAWING_LEFT, 0};
    drawing_text(page, "0", (drawing_point){-half_line_mm, baseline_mm + 2.4}, &left);
    drawing_text(page, "50", (drawing_point){RULER_MM / 2.0, baseline_mm + 2.4}, &font);
    drawing_text(page, "100 mm", (drawing_point){RULER_MM, baseline_mm + 2.4}, &font);
}

/* A line of text with another one at the right edge, smaller where both would not fit. */
static void draw_footer_line(drawing *page, const char *text, const char *right_text, double right_mm,
                             double baseline_mm, drawing_font font)
{
    const double between_mm = 4;
    double wanted_mm = drawing_text_width_mm(page, text, &font) + drawing_text_width_mm(page, right_text, &font);
    double room_mm = right_mm - FOOTER_TEXT_MM - between_mm;
    font.size_mm *= wanted_mm > room_mm ? room_mm / wanted_mm : 1;
    drawing_text(page, text, (drawing_point){FOOTER_TEXT_MM, baseline_mm}, &font);
    font.anchor = DRAWING_RIGHT;
    drawing_text(page, right_text, (drawing_point){right_mm, baseline_mm}, &font);
}

static void draw_footer(drawing *page, const print_job *job, size_t page_index, double width_mm, double bottom_mm)
{
    double right_mm = width_mm < 2 * FOOTER_WIDTH_MM ? width_mm : FOOTER_WIDTH_MM;
    char text[120], number[60];
    drawing_set_colour(page, (drawing_colour){0.15, 0.15, 0.15, 1});
    draw_ruler(page, bottom_mm - 3.0);
    snprintf(number, sizeof number, "Page %zu of %zu", page_index + 1, job->page_count);
    draw_footer_line(page, "Print at 100 %, do not fit to page.", number, right_mm, bottom_mm - 4.0,
                     (drawing_font){2.8, true, DRAWING_LEFT, 0});
    snprintf(text, sizeof text, "Then the ruler measures 100 mm, and the ink is %.2f mm high. Arrows: this way up.",
             TAPEMARK_HEIGHT_MODULES * job->wanted->module_mm);
    draw_footer_line(page, text, job->roll ? "Tapemark" : job->room.name, right_mm, bottom_mm - 0.6,
                     (drawing_font){2.4, false, DRAWING_LEFT, 0});
}

/* A roll's page is as wide as what is on it. */
static double content_width_mm(const print_job *job, size_t begin, size_t end)
{
    double width_mm = FOOTER_WIDTH_MM;
    if (!job->roll)
        return job->room.width_mm;
    for (size_t i = begin; i < end; i++) {
        double right_mm = job->places[i].at.x_mm - PIECE_MARK_MM + footprint_mm(job, &job->pieces.items[i]);
        width_mm = right_mm > width_mm ? right_mm : width_mm;
    }
    return width_mm;
}

/* Columns of the stretch drawn last: pieces come in the order of stretches. */
typedef struct stretch_columns {
    const tape_stretch *stretch;
    tape_columns drawn;
} stretch_columns;

static bool draw_stretch(const print_job *job, const tape_stretch *stretch, stretch_columns *current,
                         error_text *error)
{
    if (current->stretch == stretch)
        return true;
    free(current->drawn.columns);
    *current = (stretch_columns){0};
    tape_columns drawn;
    if (!strip_draw(job->layout, stretch, &drawn, error))
        return false;
    *current = (stretch_columns){stretch, drawn};
    return true;
}

/* Pieces `begin` to before `end` make a page. */
static bool draw_page(drawing *page, const print_job *job, size_t begin, size_t end, stretch_columns *columns,
                      error_text *error)
{
    static const piece_style style = {.labels = true, .marks = true};
    const paper_room *room = &job->room;
    double width_mm = content_width_mm(job, begin, end), height_mm = room->height_mm;
    if (job->roll)
        height_mm = PIECE_MARK_MM + paper_row_mm(job->wanted) + PAPER_FOOTER_MM;
    drawing_begin_page(page, width_mm * room->scale_x + 2 * room->margin_mm,
                       height_mm * room->scale_y + 2 * room->margin_mm,
                       (drawing_point){room->margin_mm, room->margin_mm}, room->scale_x, room->scale_y);
    draw_footer(page, job, job->places[begin].page, width_mm, height_mm);
    for (size_t i = begin; i < end; i++) {
        const tape_piece *piece = &job->pieces.items[i];
        if (!draw_stretch(job, piece->stretch, columns, error))
            return false;
        piece_draw(page, job->wanted, job->layout, piece, &columns->drawn, &style, job->places[i].at);
    }
    drawing_end_page(page);
    return true;
}

static bool draw_pages(const print_job *job, const char *path, error_text *error)
{
    stretch_columns columns = {0};
    bool drawn = true;
    drawing *pages = drawing_open_pdf(path, "Tapemark", error);
    if (pages == NULL)
        return false;
    size_t begin = 0;
    while (drawn && begin < job->pieces.count) {
        size_t end = begin;
        while (end < job->pieces.count && job->places[end].page == job->places[begin].page)
            end++;
        drawn = draw_page(pages, job, begin, end, &columns, error);
        begin = end;
    }
    free(columns.drawn.columns);
    if (drawn)
        return drawing_close(pages, error);
    drawing_discard(pages);
    return false;
}

static void summarise(const print_job *job, print_summary *summary)
{
    *summary = (print_summary){.pages = job->page_count, .pieces = job->pieces.count};
    for (size_t i = 0; i < job->pieces.count; i++)
        summary->joints += job->pieces.items[i].joint_after ? 1 : 0;
}

bool print_pdf(const plan *wanted, const tape_layout *layout, const print_settings *settings, const char *path,
               print_summary *summary, error_text *error)
{
    print_job job = {.wanted = wanted, .layout = layout, .roll = settings->paper == PRINT_ROLL};
    if (!paper_measure(wanted, settings, &job.room, error) ||
        !strip_select(layout, settings, false, &job.stretches, error))
        return false;
    bool done = true;
    for (size_t i = 0; done && i < job.stretches.count; i++)
        done = cut_stretch(&job, &job.stretches.items[i], error);
    done = done && place_pieces(&job, error) && draw_pages(&job, path, error);
    if (done)
        summarise(&job, summary);
    free(job.places);
    free(job.pieces.items);
    free(job.stretches.items);
    return done;
}
