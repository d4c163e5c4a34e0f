/* The plan as seen from above, with the tape in it. */
#include "frame_source.h"
#include "gray.h"
#include "preview_labels.h"
#include "print.h"
#include "strip.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PX_PER_MM 5.0
#define MARGIN_MM 11.0
#define FOOTER_MM 9.0
#define BAND_MIN_MM 1.0  /* the tape is drawn no thinner, so that it is seen in the largest room */
#define TEXT_MM 2.3

static const drawing_colour wall_colour = {0.25, 0.27, 0.3, 1};
static const drawing_colour grid_colour = {0.9, 0.91, 0.93, 1};
static const drawing_colour ink_colour = {0.05, 0.05, 0.05, 1};
static const drawing_colour paper_colour = {1, 1, 1, 1};
static const drawing_colour light_colour = {0.78, 0.78, 0.78, 1};
static const drawing_colour tm_colour = {0.8, 0.33, 0, 1};
static const drawing_colour id_colour = {0, 0.4, 0.25, 1};
static const drawing_colour line_colour = {0.1, 0.3, 0.65, 1};

typedef struct preview {
    const plan *wanted;
    const tape_layout *layout;
    drawing *page;
    double mm_per_m;
    double room_width_mm, room_height_mm;
    taken_area taken;
} preview;

static drawing_point on_page(const preview *view, double x_m, double y_m)
{
    return (drawing_point){MARGIN_MM + x_m * view->mm_per_m, MARGIN_MM + y_m * view->mm_per_m};
}

/* ---- The room ------------------------------------------------------------------------------------------ */

/* Large enough to read some ids of a long tape, and long for a corridor. */
static void choose_scale(preview *view)
{
    const plan *wanted = view->wanted;
    double longest_m = fmax(wanted->width_m, wanted->height_m), shortest_m = fmin(wanted->width_m, wanted->height_m);
    double by_count = sqrt((double)view->layout->cm_count / 150), by_shape = sqrt(longest_m / shortest_m / 1.5);
    double side_mm = 175 * fmin(fmax(fmax(by_count, by_shape), 1), 2.6);
    view->mm_per_m = side_mm / longest_m;
    view->room_width_mm = wanted->width_m * view->mm_per_m;
    view->room_height_mm = wanted->height_m * view->mm_per_m;
}

/* 1, 2 or 5 times a power of ten, up to `most_m`. */
static double round_length_m(double most_m)
{
    double power_m = pow(10, floor(log10(most_m)));
    double times = most_m / power_m;
    return power_m * (times >= 5 ? 5 : times >= 2 ? 2 : 1);
}

static void draw_grid(const preview *view)
{
    double step_m = round_length_m(fmax(view->wanted->width_m, view->wanted->height_m) / 5);
    for (double x_m = step_m; x_m < view->wanted->width_m; x_m += step_m)
        drawing_add_line(view->page, on_page(view, x_m, 0), on_page(view, x_m, view->wanted->height_m));
    for (double y_m = step_m; y_m < view->wanted->height_m; y_m += step_m)
        drawing_add_line(view->page, on_page(view, 0, y_m), on_page(view, view->wanted->width_m, y_m));
    drawing_set_colour(view->page, grid_colour);
    drawing_stroke(view->page, 0.125, 0);
}

/* The first frame of a file as gray. The view lives as long as source and converter. */
static bool read_background(frame_source *source, gray_converter *converter, gray_view *background,
                            error_text *error)
{
    frame first;
    frame_status status = frame_source_next(source, &first, error);
    if (status == FRAME_END)
        error_text_set(error, "holds no picture");
    return status == FRAME_READY && gray_from_frame(converter, &first, background, error);
}

static bool draw_background(const preview *view, error_text *error)
{
    const char *path = view->wanted->background_path;
    error_text reason;
    gray_view background;
    gray_converter converter = {0};
    if (path == NULL)
        return true;
    frame_source *source = frame_source_open_file(path, NULL, &reason);
    bool read = source != NULL && read_background(source, &converter, &background, &reason);
    if (read)
        drawing_picture(view->page, background.pixels, background.width_px, background.height_px,
                        background.stride_bytes, on_page(view, 0, 0),
                        on_page(view, view->wanted->width_m, view->wanted->height_m), 0.45);
    else
        error_text_set(error, "background picture %.200s: %.180s", path, reason.text);
    frame_source_close(source);
    gray_converter_release(&converter);
    return read;
}

static void draw_room_border(const preview *view)
{
    drawing_add_rectangle(view->page, on_page(view, 0, 0),
                          on_page(view, view->wanted->width_m, view->wanted->height_m));
    drawing_set_colour(view->page, wall_colour);
    drawing_stroke(view->page, 0.4, 0);
}

/* ---- Tape ---------------------------------------------------------------------------------------------- */

static line_axis axis_of(const preview *view, const plan_line *line)
{
    drawing_point from = on_page(view, line->from.x_m, line->from.y_m);
    drawing_point to = on_page(view, line->to.x_m, line->to.y_m);
    double length_mm = hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm);
    double divisor = length_mm > 0 ? length_mm : 1;
    return (line_axis){from, (to.x_mm - from.x_mm) / divisor, (to.y_mm - from.y_mm) / divisor, length_mm,
                        view->wanted->module_mm / 1000 * view->mm_per_m};
}

static double band_height_mm(const line_axis *axis)
{
    return fmax(TAPEMARK_HEIGHT_MODULES * axis->module_mm, BAND_MIN_MM);
}

/* On the side that it faces, beside a wall; in the middle of its line, on the floor. */
static double band_top_mm(const plan_line *line, const line_axis *axis)
{
    return line->mount == PLAN_ON_WALL ? 0.4 : -band_height_mm(axis) / 2;
}

static axis_box segment_box(const layout_segment *segment, const plan_line *line, const line_axis *axis)
{
    double top_mm = band_top_mm(line, axis);
    return (axis_box){segment->start_modules * axis->module_mm,
                       (double)strip_ink_end_modules(segment) * axis->module_mm, top_mm,
                       top_mm + band_height_mm(axis)};
}

/* As printed, where the preview has pixels enough for modules. */
static bool draw_modules(const preview *view, size_t index, const line_axis *axis, double top_mm,
                         error_text *error)
{
    const layout_segment *segment = &view->layout->segments[index];
    double module_mm = axis->module_mm;
    tape_columns drawn;
    const tape_stretch stretch = {.line = segment->line, .segment_begin = index, .segment_end = index + 1,
                                  .start_halves = 2 * (int64_t)segment->start_modules,
                                  .end_halves = 2 * strip_ink_end_modules(segment)};
    if (!strip_draw(view->layout, &stretch, &drawn, error))
        return false;
    for (unsigned row = 0; row < TAPEMARK_HEIGHT_MODULES; row++) {
        for (size_t x = 0; x < drawn.count;) {
            size_t begin = x;
            while (x < drawn.count && (drawn.columns[x] >> row & 1) != 0)
                x++;
            const axis_box run = {(double)(drawn.first_module + (int64_t)begin) * module_mm,
                                   (double)(drawn.first_module + (int64_t)x) * module_mm, top_mm + row * module_mm,
                                   top_mm + (row + 1) * module_mm};
            if (x > begin)
                add_axis_box(view->page, axis, &run);
            else
                x++;
        }
    }
    free(drawn.columns);
    drawing_set_colour(view->page, ink_colour);
    drawing_fill(view->page);
    return true;
}

/* Light and dark CMs as seen from afar. */
static void draw_blocks(const preview *view, const layout_segment *segment, const line_axis *axis,
                        const axis_box *band)
{
    for (size_t slot = 0; slot < segment->cm_count; slot++) {
        double u_mm = layout_cm_start_modules(segment, slot) * axis->module_mm;
        const axis_box block = {u_mm, u_mm + TAPEMARK_CM_WIDTH_MODULES * axis->module_mm, band->v_begin_mm,
                                 band->v_end_mm};
        add_axis_box(view->page, axis, &block);
        bool light = view->layout->ids[segment->first_cm + slot] >= 0;
        drawing_set_colour(view->page, light ? light_colour : ink_colour);
        drawing_fill(view->page);
    }
}

static bool draw_segment(preview *view, size_t index, error_text *error)
{
    const layout_segment *segment = &view->layout->segments[index];
    const plan_line *line = &view->wanted->lines[segment->line];
    const line_axis axis = axis_of(view, line);
    const axis_box band = segment_box(segment, line, &axis);
    double quiet_mm = layout_quiet_modules(segment) * axis.module_mm, edge_mm = fmin(axis.module_mm, 0.4);
    const axis_box paper = {band.u_begin_mm - quiet_mm, band.u_end_mm + quiet_mm, band.v_begin_mm - edge_mm,
                             band.v_end_mm + edge_mm};
    add_axis_box(view->page, &axis, &paper);
    drawing_set_colour(view->page, paper_colour);
    drawing_fill(view->page);
    take_box(&view->taken, &axis, &paper);
    if (axis.module_mm * PX_PER_MM >= 1)
        return draw_modules(view, index, &axis, band.v_begin_mm, error);
    draw_blocks(view, segment, &axis, &band);
    return true;
}

/* ---- What is written beside it -------------------------------------------------------------------------- */

static void draw_arrow(drawing *page, const line_axis *axis, double u_mm, double length_mm, double v_mm)
{
    const double head_mm = 1.6, half_mm = 0.6;
    drawing_add_line(page, axis_point(axis, u_mm, v_mm), axis_point(axis, u_mm + length_mm - head_mm, v_mm));
    drawing_stroke(page, 0.25, 0);
    const drawing_point head[3] = {axis_point(axis, u_mm + length_mm, v_mm),
                                   axis_point(axis, u_mm + length_mm - head_mm, v_mm - half_mm),
                                   axis_point(axis, u_mm + length_mm - head_mm, v_mm + half_mm)};
    drawing_add_polygon(page, head, 3);
    drawing_fill(page);
}

/* The number and direction of a line, behind its tape. */
static void draw_line_label(preview *view, size_t index)
{
    const plan_line *line = &view->wanted->lines[index];
    const line_axis axis = axis_of(view, line);
    const drawing_font font = {TEXT_MM, true, DRAWING_MIDDLE, 0};
    const double arrow_mm = 5;
    char text[32];
    snprintf(text, sizeof text, "L%zu", index + 1);
    double width_mm = drawing_text_width_mm(view->page, text, &font), height_mm = LABEL_HEIGHT * TEXT_MM;
    double v_mm = fmin(band_top_mm(line, &axis), 0) - 0.9 - height_mm;
    drawing_set_colour(view->page, line_colour);
    if (!label_along(view->page, &view->taken, &axis, text, width_mm / 2 + 0.5, v_mm, &font))
        return;
    double u_mm = width_mm + 1.7;
    const axis_box box = {u_mm, u_mm + arrow_mm, v_mm + 0.3, v_mm + height_mm - 0.3};
    if (u_mm + arrow_mm > axis.length_mm || !box_is_free(&view->taken, &axis, &box))
        return;
    take_box(&view->taken, &axis, &box);
    draw_arrow(view->page, &axis, u_mm, arrow_mm, v_mm + height_mm / 2);
}

/* Ids stand next to the tape, brackets of TMs behind them. */
#define ID_GAP_MM 0.7
#define BRACKET_GAP_MM (ID_GAP_MM + LABEL_HEIGHT * TEXT_MM + 0.6)
#define BRACKET_MM 0.8

static void draw_bracket(preview *view, const layout_segment *segment)
{
    const plan_line *line = &view->wanted->lines[segment->line];
    const line_axis axis = axis_of(view, line);
    const axis_box band = segment_box(segment, line, &axis);
    const drawing_font font = {TEXT_MM, true, DRAWING_MIDDLE, 0};
    double v_mm = band.v_end_mm + BRACKET_GAP_MM;
    char code[TAPEMARK_TM_MAX_CMS + 1];
    const axis_box box = {band.u_begin_mm, band.u_end_mm, v_mm, v_mm + BRACKET_MM};
    if (!box_is_free(&view->taken, &axis, &box))
        return;
    take_box(&view->taken, &axis, &box);
    drawing_set_colour(view->page, tm_colour);
    drawing_add_line(view->page, axis_point(&axis, band.u_begin_mm, v_mm),
                     axis_point(&axis, band.u_begin_mm, v_mm + BRACKET_MM));
    drawing_add_line(view->page, axis_point(&axis, band.u_begin_mm, v_mm + BRACKET_MM),
                     axis_point(&axis, band.u_end_mm, v_mm + BRACKET_MM));
    drawing_add_line(view->page, axis_point(&axis, band.u_end_mm, v_mm + BRACKET_MM),
                     axis_point(&axis, band.u_end_mm, v_mm));
    drawing_stroke(view->page, 0.25, 0);
    strip_format_code(view->layout, segment, code);
    label_along(view->page, &view->taken, &axis, code, (band.u_begin_mm + band.u_end_mm) / 2,
                v_mm + BRACKET_MM + 0.6, &font);
}

/* With the white around it. */
static double widest_id_mm(const preview *view, const drawing_font *font)
{
    const tape_layout *layout = view->layout;
    char text[STRIP_ID_BYTES];
    int32_t last_id = layout->ids[layout->cm_count - 1];
    strip_format_id(last_id < 0 ? last_id : -last_id, text);
    return drawing_text_width_mm(view->page, text, font) + 0.5 * font->size_mm;
}

/* Each so many of a segment, as their width allows. */
static void draw_ids(preview *view, const layout_segment *segment)
{
    const plan_line *line = &view->wanted->lines[segment->line];
    const line_axis axis = axis_of(view, line);
    const drawing_font font = {TEXT_MM, false, DRAWING_MIDDLE, 0};
    double v_mm = band_top_mm(line, &axis) + band_height_mm(&axis) + ID_GAP_MM;
    char text[STRIP_ID_BYTES];
    double pitch_mm = TAPEMARK_CM_PITCH_MODULES * axis.module_mm;
    size_t step = (size_t)ceil(widest_id_mm(view, &font) / pitch_mm);
    drawing_set_colour(view->page, id_colour);
    for (size_t slot = 0; slot < segment->cm_count; slot += step) {
        int32_t id = view->layout->ids[segment->first_cm + slot];
        double middle_modules = layout_cm_start_modules(segment, slot) + TAPEMARK_CM_WIDTH_MODULES / 2.0;
        strip_format_id(id, text);
        label_along(view->page, &view->taken, &axis, text, middle_modules * axis.module_mm, v_mm, &font);
    }
}

/* Lines that hold no tape for want of ids are seen, too. */
static void draw_lines(const preview *view)
{
    for (int mount = PLAN_ON_WALL; mount <= PLAN_ON_FLOOR; mount++) {
        for (size_t i = 0; i < view->wanted->line_count; i++) {
            const plan_line *line = &view->wanted->lines[i];
            if (line->mount == (plan_mount)mount)
                drawing_add_line(view->page, on_page(view, line->from.x_m, line->from.y_m),
                                 on_page(view, line->to.x_m, line->to.y_m));
        }
        drawing_set_colour(view->page, mount == PLAN_ON_WALL ? wall_colour : line_colour);
        drawing_stroke(view->page, mount == PLAN_ON_WALL ? 0.5 : 0.2, mount == PLAN_ON_WALL ? 0 : 1.2);
    }
}

static bool draw_tape(preview *view, error_text *error)
{
    const tape_layout *layout = view->layout;
    draw_lines(view);
    for (size_t i = 0; i < layout->segment_count; i++) {
        if (!draw_segment(view, i, error))
            return false;
    }
    for (size_t i = 0; i < view->wanted->line_count; i++)
        draw_line_label(view, i);
    for (size_t i = 0; i < layout->segment_count; i++) {
        if (layout->segments[i].bars)
            draw_bracket(view, &layout->segments[i]);
    }
    for (size_t i = 0; i < layout->segment_count; i++)
        draw_ids(view, &layout->segments[i]);
    return true;
}

/* ---- Below the room ------------------------------------------------------------------------------------ */

/* Between the margins; small rooms have room for the texts below them, too. */
static double content_width_mm(const preview *view)
{
    return fmax(view->room_width_mm, 110);
}

/* Short enough for the summary beside it. */
static void draw_scale_bar(const preview *view, double y_mm)
{
    const drawing_font font = {TEXT_MM, false, DRAWING_LEFT, 0};
    double longest_mm = fmax(view->room_width_mm, view->room_height_mm);
    double bar_m = round_length_m(fmin(longest_mm / 5, 0.3 * content_width_mm(view)) / view->mm_per_m);
    double end_mm = MARGIN_MM + bar_m * view->mm_per_m, tick_mm = 0.8;
    char text[32];
    snprintf(text, sizeof text, "%.4g m", bar_m);
    drawing_set_colour(view->page, wall_colour);
    drawing_add_line(view->page, (drawing_point){MARGIN_MM, y_mm}, (drawing_point){end_mm, y_mm});
    for (int end = 0; end < 2; end++) {
        double x_mm = end == 0 ? MARGIN_MM : end_mm;
        drawing_add_line(view->page, (drawing_point){x_mm, y_mm - tick_mm}, (drawing_point){x_mm, y_mm + tick_mm});
    }
    drawing_stroke(view->page, 0.25, 0);
    drawing_text(view->page, text, (drawing_point){end_mm + 1.2, y_mm + 0.36 * TEXT_MM}, &font);
}

static void draw_summary(const preview *view, double right_mm, double y_mm)
{
    const drawing_font font = {TEXT_MM, false, DRAWING_RIGHT, 0};
    const tape_layout *layout = view->layout;
    size_t tm_count = 0;
    char text[160];
    for (size_t i = 0; i < layout->segment_count; i++)
        tm_count += layout->segments[i].bars ? 1 : 0;
    snprintf(text, sizeof text, "%zu code markers, %zu tape markers, module %.4g mm", layout->cm_count, tm_count,
             view->wanted->module_mm);
    drawing_text(view->page, text, (drawing_point){right_mm, y_mm + 0.36 * TEXT_MM}, &font);
}

static bool draw_all(preview *view, error_text *error)
{
    if (!draw_background(view, error))
        return false;
    if (view->wanted->background_path == NULL)
        draw_grid(view);
    draw_room_border(view);
    if (!draw_tape(view, error))
        return false;
    double y_mm = 2 * MARGIN_MM + view->room_height_mm;
    draw_scale_bar(view, y_mm);
    draw_summary(view, content_width_mm(view) + MARGIN_MM, y_mm);
    return true;
}

bool print_preview(const plan *wanted, const tape_layout *layout, const char *path, error_text *error)
{
    preview view = {.wanted = wanted, .layout = layout};
    choose_scale(&view);
    double width_mm = content_width_mm(&view) + 2 * MARGIN_MM;
    double height_mm = view.room_height_mm + 2 * MARGIN_MM + FOOTER_MM;
    if (!taken_area_init(&view.taken, width_mm, height_mm)) {
        error_text_set(error, "not enough memory for a picture of the plan");
        return false;
    }
    view.page = drawing_open_pixels(DRAWING_COLOUR, (int32_t)ceil(width_mm * PX_PER_MM),
                                    (int32_t)ceil(height_mm * PX_PER_MM), PX_PER_MM, error);
    bool drawn = view.page != NULL && draw_all(&view, error) &&
                 drawing_write_png(view.page, path, PX_PER_MM * 25.4, error);
    drawing_discard(view.page);
    free(view.taken.cells);
    return drawn;
}
