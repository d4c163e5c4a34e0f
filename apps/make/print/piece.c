#include "piece.h"

#include <math.h>
#include <stdio.h>

static const drawing_colour ink = {0, 0, 0, 1};
static const drawing_colour label_gray = {0.25, 0.25, 0.25, 1};
static const drawing_colour mark_gray = {0.45, 0.45, 0.45, 1};
static const drawing_colour flap_gray = {0.7, 0.7, 0.7, 1};

#define MARK_WIDTH_MM 0.15
#define CROSS_ARM_MM 1.8
#define SMALL_TEXT_MM 2.5
#define BASELINE_MM 1.6  /* of the lower band, above its lower edge */

/* A piece at its place on the page. */
typedef struct placed_piece {
    drawing *page;
    const plan *wanted;
    const tape_layout *layout;
    const tape_piece *piece;
    drawing_point at;
    double right_mm, bottom_mm;  /* of the quiet zone */
} placed_piece;

double piece_length_mm(const plan *wanted, const tape_piece *piece)
{
    return (double)(piece->end_halves - piece->start_halves) * wanted->module_mm / 2;
}

double piece_height_mm(const plan *wanted)
{
    return (TAPEMARK_HEIGHT_MODULES + 2) * wanted->module_mm;
}

static double x_of_halves(const placed_piece *placed, int64_t at_halves)
{
    return placed->at.x_mm + (double)(at_halves - placed->piece->start_halves) * placed->wanted->module_mm / 2;
}

static placed_piece place(drawing *page, const plan *wanted, const tape_layout *layout, const tape_piece *piece,
                          drawing_point at)
{
    return (placed_piece){page, wanted, layout, piece, at, at.x_mm + piece_length_mm(wanted, piece),
                          at.y_mm + piece_height_mm(wanted)};
}

/* ---- Ink ----------------------------------------------------------------------------------------------- */

/* Whether columns begin to before end are one run of dark modules in that row. */
static bool is_run(const uint8_t *columns, size_t count, size_t begin, size_t end, unsigned row)
{
    if ((begin > 0 && (columns[begin - 1] >> row & 1) != 0) || (end < count && (columns[end] >> row & 1) != 0))
        return false;
    for (size_t x = begin; x < end; x++) {
        if ((columns[x] >> row & 1) == 0)
            return false;
    }
    return true;
}

/* A run and the same runs in the rows below it are one rectangle. */
static void add_run(const placed_piece *placed, const tape_columns *drawn, size_t begin, size_t end, unsigned row)
{
    double module_mm = placed->wanted->module_mm, top_mm = placed->at.y_mm + module_mm;
    unsigned below = row + 1;
    if (row > 0 && is_run(drawn->columns, drawn->count, begin, end, row - 1))
        return;
    while (below < TAPEMARK_HEIGHT_MODULES && is_run(drawn->columns, drawn->count, begin, end, below))
        below++;
    drawing_point from = {x_of_halves(placed, 2 * (drawn->first_module + (int64_t)begin)), top_mm + row * module_mm};
    drawing_point to = {x_of_halves(placed, 2 * (drawn->first_module + (int64_t)end)), top_mm + below * module_mm};
    drawing_add_rectangle(placed->page, from, to);
}

/* Pieces end in the middle of light columns, so that no run is cut. */
static void draw_ink(const placed_piece *placed, const tape_columns *drawn)
{
    size_t first = (size_t)(placed->piece->start_halves - 2 * drawn->first_module) / 2;
    size_t last = (size_t)(placed->piece->end_halves + 1 - 2 * drawn->first_module) / 2;
    for (unsigned row = 0; row < TAPEMARK_HEIGHT_MODULES; row++) {
        size_t x = first;
        while (x < last) {
            size_t begin = x;
            while (x < last && (drawn->columns[x] >> row & 1) != 0)
                x++;
            if (x > begin)
                add_run(placed, drawn, begin, x, row);
            else
                x++;
        }
    }
    drawing_set_colour(placed->page, ink);
    drawing_fill(placed->page);
}

/* ---- Upper band: ids ----------------------------------------------------------------------------------- */

/* How ids are written on a piece: smaller where modules are small, and not each of them where they are tiny. */
typedef struct id_style {
    double size_mm;
    size_t step;
} id_style;

#define ID_SIZE_MM 3.4
#define ID_SIZE_MIN_MM 1.4
#define ARROW_WIDTH 0.72  /* in sizes of the font, with the space behind it */
#define ARROW_HALF 0.24   /* of its head alone */

static double upper_baseline_mm(const placed_piece *placed)
{
    return placed->at.y_mm - 1.0;
}

static double id_width_mm(const placed_piece *placed, int32_t id, double size_mm)
{
    char text[STRIP_ID_BYTES];
    const drawing_font font = {size_mm, true, DRAWING_LEFT, 0};
    strip_format_id(id, text);
    return drawing_text_width_mm(placed->page, text, &font) + ARROW_WIDTH * size_mm;
}

static id_style choose_id_style(const placed_piece *placed)
{
    const tape_stretch *stretch = placed->piece->stretch;
    /* Magnitudes ascend; with its sign the last id is as wide as any. */
    int32_t last_id = placed->layout->ids[stretch->cm_end - 1];
    double widest_mm = id_width_mm(placed, last_id < 0 ? last_id : -last_id, ID_SIZE_MM) + 0.3 * ID_SIZE_MM;
    double room_mm = TAPEMARK_CM_PITCH_MODULES * placed->wanted->module_mm;
    double size_mm = widest_mm > room_mm ? ID_SIZE_MM * room_mm / widest_mm : ID_SIZE_MM;
    if (size_mm >= ID_SIZE_MIN_MM)
        return (id_style){size_mm, 1};
    return (id_style){ID_SIZE_MIN_MM, (size_t)ceil(widest_mm * ID_SIZE_MIN_MM / ID_SIZE_MM / room_mm)};
}

static void draw_arrow_up(drawing *page, drawing_point base, double size_mm)
{
    double half = ARROW_HALF * size_mm, stem = 0.08 * size_mm, height = 0.73 * size_mm, neck = 0.36 * size_mm;
    const drawing_point corners[] = {
        {base.x_mm + half, base.y_mm - height},      {base.x_mm + 2 * half, base.y_mm - neck},
        {base.x_mm + half + stem, base.y_mm - neck}, {base.x_mm + half + stem, base.y_mm},
        {base.x_mm + half - stem, base.y_mm},        {base.x_mm + half - stem, base.y_mm - neck},
        {base.x_mm, base.y_mm - neck}};
    drawing_add_polygon(page, corners, sizeof corners / sizeof *corners);
    drawing_fill(page);
}

/* An arrow and the id, together in the middle above the coding region, unless they would leave the piece. */
static bool draw_id(const placed_piece *placed, int32_t id, double middle_mm, double size_mm)
{
    char text[STRIP_ID_BYTES];
    const drawing_font font = {size_mm, true, DRAWING_LEFT, 0};
    double width_mm = id_width_mm(placed, id, size_mm), left_mm = middle_mm - width_mm / 2;
    double left_limit_mm = placed->at.x_mm + (placed->piece->joint_before ? CROSS_ARM_MM : 0);
    double right_limit_mm = placed->right_mm - (placed->piece->joint_after ? CROSS_ARM_MM : 0);
    if (left_mm < left_limit_mm || left_mm + width_mm > right_limit_mm)
        return false;
    drawing_point base = {left_mm, upper_baseline_mm(placed)};
    strip_format_id(id, text);
    draw_arrow_up(placed->page, base, size_mm);
    drawing_text(placed->page, text, (drawing_point){left_mm + ARROW_WIDTH * size_mm, base.y_mm}, &font);
    return true;
}

/* How many there was room for. */
static size_t draw_ids_of_segment(const placed_piece *placed, const layout_segment *segment, const id_style *style)
{
    const tape_piece *piece = placed->piece;
    size_t drawn = 0;
    for (size_t slot = 0; slot < segment->cm_count; slot++) {
        size_t cm = segment->first_cm + slot;
        int64_t middle_halves = 2 * (int64_t)layout_cm_start_modules(segment, slot) + TAPEMARK_CM_WIDTH_MODULES;
        bool on_piece = cm >= piece->stretch->cm_begin && cm < piece->stretch->cm_end &&
                        middle_halves > piece->start_halves && middle_halves < piece->end_halves;
        if (on_piece && (cm - piece->stretch->cm_begin) % style->step == 0 &&
            draw_id(placed, placed->layout->ids[cm], x_of_halves(placed, middle_halves), style->size_mm))
            drawn++;
    }
    return drawn;
}

/* Pieces without an id, of a finder pattern and bars, have a way up, too. */
static void draw_ids(const placed_piece *placed)
{
    const tape_piece *piece = placed->piece;
    const id_style style = choose_id_style(placed);
    size_t drawn = 0;
    for (size_t i = piece->segment_begin; i < piece->segment_end; i++)
        drawn += draw_ids_of_segment(placed, &placed->layout->segments[i], &style);
    double left_mm = (placed->at.x_mm + placed->right_mm) / 2 - ARROW_HALF * style.size_mm;
    if (drawn == 0)
        draw_arrow_up(placed->page, (drawing_point){left_mm, upper_baseline_mm(placed)}, style.size_mm);
}

/* ---- Lower band: line, joints, codes, metre marks ------------------------------------------------------ */

#define METRE_STEP_MM 100.0

/* What is taken in the lower band by the texts at its ends. */
typedef struct free_band {
    double left_mm, right_mm;
} free_band;

static const drawing_font small_left = {SMALL_TEXT_MM, false, DRAWING_LEFT, 0};
static const drawing_font small_right = {SMALL_TEXT_MM, false, DRAWING_RIGHT, 0};

static double lower_baseline_mm(const placed_piece *placed)
{
    return placed->bottom_mm + PIECE_BAND_MM - BASELINE_MM;
}

/* "L2 · 3|4": of line 2, the third piece's joint to the fourth. */
static free_band draw_end_labels(const placed_piece *placed)
{
    const double away_mm = CROSS_ARM_MM + 0.8;
    const tape_piece *piece = placed->piece;
    size_t line = piece->stretch->line + 1, number = piece->number;
    char text[80];
    if (piece->joint_before)
        snprintf(text, sizeof text, "L%zu \u00b7 %zu|%zu", line, number - 1, number);
    else
        snprintf(text, sizeof text, "L%zu", line);
    drawing_point left = {placed->at.x_mm + away_mm, lower_baseline_mm(placed)};
    drawing_text(placed->page, text, left, &small_left);
    free_band rest = {left.x_mm + drawing_text_width_mm(placed->page, text, &small_left) + 1.5, placed->right_mm};
    if (piece->joint_after) {
        snprintf(text, sizeof text, "L%zu \u00b7 %zu|%zu", line, number, number + 1);
        drawing_point right = {placed->right_mm - away_mm, lower_baseline_mm(placed)};
        rest.right_mm = right.x_mm - drawing_text_width_mm(placed->page, text, &small_right) - 1.5;
        if (rest.right_mm < left.x_mm)
            rest.right_mm = placed->right_mm;
        else
            drawing_text(placed->page, text, right, &small_right);
    }
    return rest;
}

static double line_start_mm(const placed_piece *placed)
{
    return x_of_halves(placed, 0);
}

/* A tick every 10 cm along the line, at the edge of the paper once it is cut; a long one every metre. */
static void draw_metre_mark(const placed_piece *placed, const free_band *band, int64_t step, double x_mm)
{
    const double edge_mm = placed->bottom_mm + PIECE_BAND_MM, text_gap_mm = 0.7;
    bool whole = step % 10 == 0;
    const drawing_font font = {SMALL_TEXT_MM, whole, DRAWING_LEFT, 0};
    char text[32];
    snprintf(text, sizeof text, "%.1f m", (double)step * METRE_STEP_MM / 1000);
    double left_mm = x_mm + text_gap_mm, right_mm = left_mm + drawing_text_width_mm(placed->page, text, &font);
    bool is_free = x_mm >= band->left_mm && right_mm <= band->right_mm;
    drawing_add_line(placed->page, (drawing_point){x_mm, edge_mm - (whole && is_free ? 3.6 : 1.1)},
                     (drawing_point){x_mm, edge_mm});
    drawing_stroke(placed->page, whole ? 0.3 : MARK_WIDTH_MM, 0);
    if (is_free)
        drawing_text(placed->page, text, (drawing_point){left_mm, lower_baseline_mm(placed)}, &font);
}

static void draw_metre_marks(const placed_piece *placed, const free_band *band)
{
    double zero_mm = line_start_mm(placed);
    int64_t step = (int64_t)ceil((placed->at.x_mm - zero_mm) / METRE_STEP_MM - 1e-9);
    for (; zero_mm + (double)step * METRE_STEP_MM <= placed->right_mm + 1e-6; step++)
        draw_metre_mark(placed, band, step, zero_mm + (double)step * METRE_STEP_MM);
}

/* The next place from `x_mm` on where text does not run into a metre mark. */
static double clear_of_metre_marks(const placed_piece *placed, double x_mm, double width_mm)
{
    const double label_mm = 6.5 * SMALL_TEXT_MM / 2.5 * 2;
    double zero_mm = line_start_mm(placed);
    double mark_mm = zero_mm + floor((x_mm - zero_mm) / METRE_STEP_MM) * METRE_STEP_MM;
    if (mark_mm >= placed->at.x_mm && x_mm < mark_mm + label_mm)
        return mark_mm + label_mm;
    double next_mm = mark_mm + METRE_STEP_MM;
    return x_mm + width_mm > next_mm - 1 && next_mm <= placed->right_mm ? next_mm + label_mm : x_mm;
}

/* On each piece that a TM is on: at its beginning there, or where there is room. */
static void draw_code(const placed_piece *placed, const layout_segment *segment, const free_band *band)
{
    char text[TAPEMARK_TM_MAX_CMS + 4] = "TM ";
    strip_format_code(placed->layout, segment, text + 3);
    double left_mm = x_of_halves(placed, 2 * (int64_t)segment->start_modules);
    double right_mm = x_of_halves(placed, 2 * strip_ink_end_modules(segment));
    left_mm = left_mm > band->left_mm ? left_mm : band->left_mm;
    right_mm = right_mm < band->right_mm ? right_mm : band->right_mm;
    double width_mm = drawing_text_width_mm(placed->page, text, &small_left);
    left_mm = clear_of_metre_marks(placed, left_mm, width_mm);
    if (left_mm + width_mm <= right_mm)
        drawing_text(placed->page, text, (drawing_point){left_mm, lower_baseline_mm(placed)}, &small_left);
}

void piece_draw_labels(drawing *page, const plan *wanted, const tape_layout *layout, const tape_piece *piece,
                       drawing_point at)
{
    const placed_piece placed = place(page, wanted, layout, piece, at);
    drawing_set_colour(page, label_gray);
    draw_ids(&placed);
    free_band band = draw_end_labels(&placed);
    draw_metre_marks(&placed, &band);
    for (size_t i = piece->segment_begin; i < piece->segment_end; i++) {
        if (layout->segments[i].bars)
            draw_code(&placed, &layout->segments[i], &band);
    }
}

/* ---- Marks --------------------------------------------------------------------------------------------- */

static void add_corner(drawing *page, drawing_point corner, double right, double down)
{
    const double gap_mm = 0.5;
    drawing_add_line(page, (drawing_point){corner.x_mm + right * gap_mm, corner.y_mm},
                     (drawing_point){corner.x_mm + right * PIECE_MARK_MM, corner.y_mm});
    drawing_add_line(page, (drawing_point){corner.x_mm, corner.y_mm + down * gap_mm},
                     (drawing_point){corner.x_mm, corner.y_mm + down * PIECE_MARK_MM});
}

static void draw_cut_marks(const placed_piece *placed, double flap_end_mm)
{
    double top_mm = placed->at.y_mm - PIECE_BAND_MM, bottom_mm = placed->bottom_mm + PIECE_BAND_MM;
    add_corner(placed->page, (drawing_point){placed->at.x_mm, top_mm}, -1, -1);
    add_corner(placed->page, (drawing_point){placed->at.x_mm, bottom_mm}, -1, 1);
    add_corner(placed->page, (drawing_point){flap_end_mm, top_mm}, 1, -1);
    add_corner(placed->page, (drawing_point){flap_end_mm, bottom_mm}, 1, 1);
    drawing_set_colour(placed->page, mark_gray);
    drawing_stroke(placed->page, MARK_WIDTH_MM, 0);
}

/* A cross in each band, which lies half on each of two neighbours. */
static void draw_joint_marks(const placed_piece *placed, double x_mm)
{
    const double middles_mm[2] = {placed->at.y_mm - PIECE_BAND_MM / 2, placed->bottom_mm + PIECE_BAND_MM / 2};
    for (int i = 0; i < 2; i++) {
        drawing_add_line(placed->page, (drawing_point){x_mm - CROSS_ARM_MM, middles_mm[i]},
                         (drawing_point){x_mm + CROSS_ARM_MM, middles_mm[i]});
        drawing_add_line(placed->page, (drawing_point){x_mm, middles_mm[i] - CROSS_ARM_MM},
                         (drawing_point){x_mm, middles_mm[i] + CROSS_ARM_MM});
    }
    drawing_set_colour(placed->page, ink);
    drawing_stroke(placed->page, MARK_WIDTH_MM, 0);
}

static void draw_flap(const placed_piece *placed)
{
    const drawing_font font = {SMALL_TEXT_MM, false, DRAWING_MIDDLE, 90};
    drawing_point middle = {placed->right_mm + PIECE_FLAP_MM / 2 - 0.35 * SMALL_TEXT_MM,
                            (placed->at.y_mm + placed->bottom_mm) / 2};
    drawing_set_colour(placed->page, flap_gray);
    drawing_text(placed->page, "glue", middle, &font);
}

static void draw_marks(const placed_piece *placed)
{
    const tape_piece *piece = placed->piece;
    bool cut_before = piece->stretch->cut_before && piece->start_halves == piece->stretch->start_halves;
    bool cut_after = piece->stretch->cut_after && piece->end_halves == piece->stretch->end_halves;
    draw_cut_marks(placed, placed->right_mm + (piece->joint_after ? PIECE_FLAP_MM : 0));
    if (piece->joint_before || cut_before)
        draw_joint_marks(placed, placed->at.x_mm);
    if (piece->joint_after || cut_after)
        draw_joint_marks(placed, placed->right_mm);
    if (piece->joint_after)
        draw_flap(placed);
}

void piece_draw(drawing *page, const plan *wanted, const tape_layout *layout, const tape_piece *piece,
                const tape_columns *drawn, const piece_style *style, drawing_point at)
{
    const placed_piece placed = place(page, wanted, layout, piece, at);
    draw_ink(&placed, drawn);
    if (style->labels)
        piece_draw_labels(page, wanted, layout, piece, at);
    if (style->marks)
        draw_marks(&placed);
}
