#include "drawing.h"
#include "drawing_file.h"
#include "drawing_png.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include <stdlib.h>

struct drawing {
    cairo_surface_t *surface;
    cairo_t *context;
    bool to_file;
    bool gray;         /* pixels of one byte, which hold how dark they are */
    drawing_file file;
    double unit;       /* the surface's units a millimetre */
};

static const double PT_PER_MM = 72.0 / 25.4;

/* fontconfig keeps what it has read of the fonts until the process ends, which leak checkers take for lost. They ask
 * programs for what is to be left out, and whether to tell, by these names. */
#if defined(__SANITIZE_ADDRESS__)
#define DRAWING_LEAK_CHECKED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DRAWING_LEAK_CHECKED
#endif
#endif
#ifdef DRAWING_LEAK_CHECKED
const char *__lsan_default_suppressions(void);
const char *__lsan_default_options(void);

const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig";
}

const char *__lsan_default_options(void)
{
    return "print_suppressions=0";
}
#endif

/* ---- Opening and closing ------------------------------------------------------------------------------- */

static cairo_status_t write_bytes(void *closure, const unsigned char *bytes, unsigned int size)
{
    return drawing_file_write(closure, bytes, size) ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_WRITE_ERROR;
}

/* Letters as they are designed, at any size: no hints for pixels, so that text is as wide on paper as on screen. */
static void choose_font_rendering(cairo_t *context)
{
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(context, options);
    cairo_font_options_destroy(options);
}

static drawing *drawing_new(error_text *error)
{
    drawing *page = calloc(1, sizeof *page);
    if (page == NULL)
        error_text_set(error, "not enough memory to draw");
    return page;
}

/* What cairo says about itself; the file knows better why it cannot be written. */
static bool has_failed(const drawing *page, error_text *error)
{
    cairo_status_t status = cairo_status(page->context);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(page->surface);
    if (status != CAIRO_STATUS_SUCCESS)
        error_text_set(error, "cannot be drawn: %s", cairo_status_to_string(status));
    return status != CAIRO_STATUS_SUCCESS;
}

static void release(drawing *page)
{
    cairo_destroy(page->context);
    cairo_surface_destroy(page->surface);
    free(page);
}

/* Takes a surface over. NULL when it or its context could not be made. */
static drawing *start(drawing *page, cairo_surface_t *surface, double unit, error_text *error)
{
    page->surface = surface;
    page->context = cairo_create(surface);
    page->unit = unit;
    if (has_failed(page, error)) {
        drawing_discard(page);
        return NULL;
    }
    cairo_scale(page->context, unit, unit);
    choose_font_rendering(page->context);
    return page;
}

/* NULL when the file cannot be written. */
static drawing *drawing_new_file(const char *path, error_text *error)
{
    drawing *page = drawing_new(error);
    if (page == NULL)
        return NULL;
    if (!drawing_file_open(&page->file, path, error)) {
        free(page);
        return NULL;
    }
    page->to_file = true;
    return page;
}

drawing *drawing_open_pdf(const char *path, const char *title, error_text *error)
{
    drawing *page = drawing_new_file(path, error);
    if (page == NULL)
        return NULL;
    cairo_surface_t *surface = cairo_pdf_surface_create_for_stream(write_bytes, &page->file, 1, 1);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, NULL);
    return start(page, surface, PT_PER_MM, error);
}

drawing *drawing_open_svg(const char *path, double width_mm, double height_mm, error_text *error)
{
    drawing *page = drawing_new_file(path, error);
    if (page == NULL)
        return NULL;
    /* With the unit set, the size is in that unit. */
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(write_bytes, &page->file, width_mm, height_mm);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_MM);
    return start(page, surface, 1, error);
}

drawing *drawing_open_pixels(drawing_pixels kind, int32_t width_px, int32_t height_px, double px_per_mm,
                             error_text *error)
{
    drawing *page = drawing_new(error);
    if (page == NULL)
        return NULL;
    page->gray = kind == DRAWING_GRAY;
    cairo_format_t format = page->gray ? CAIRO_FORMAT_A8 : CAIRO_FORMAT_RGB24;
    page = start(page, cairo_image_surface_create(format, width_px, height_px), px_per_mm, error);
    if (page != NULL && !page->gray) {
        cairo_set_source_rgb(page->context, 1, 1, 1);
        cairo_paint(page->context);
        cairo_set_source_rgb(page->context, 0, 0, 0);
    }
    return page;
}

void drawing_begin_page(drawing *page, double width_mm, double height_mm, drawing_point origin, double scale_x,
                        double scale_y)
{
    cairo_pdf_surface_set_size(page->surface, width_mm * page->unit, height_mm * page->unit);
    cairo_save(page->context);
    cairo_translate(page->context, origin.x_mm, origin.y_mm);
    cairo_scale(page->context, scale_x, scale_y);
    cairo_set_source_rgb(page->context, 0, 0, 0);
}

void drawing_end_page(drawing *page)
{
    cairo_restore(page->context);
    cairo_show_page(page->context);
}

bool drawing_close(drawing *page, error_text *error)
{
    if (page == NULL)
        return false;
    cairo_surface_finish(page->surface);
    bool complete = !has_failed(page, error);
    if (page->to_file && (complete || page->file.error_number != 0))
        complete = drawing_file_publish(&page->file, error);
    else if (page->to_file)
        drawing_file_discard(&page->file);
    release(page);
    return complete;
}

void drawing_discard(drawing *page)
{
    if (page == NULL)
        return;
    cairo_surface_finish(page->surface);
    if (page->to_file)
        drawing_file_discard(&page->file);
    release(page);
}

/* ---- Pixels ----------------------------------------------------------------------------------------- */

/* Pixels of one byte hold ink until they are shown; PNG and callers want light. */
static void invert(uint8_t *target, const uint8_t *source, int32_t count)
{
    for (int32_t x = 0; x < count; x++)
        target[x] = (uint8_t)(255 - source[x]);
}

void drawing_copy_gray(drawing *page, uint8_t *pixels)
{
    cairo_surface_flush(page->surface);
    const uint8_t *rows = cairo_image_surface_get_data(page->surface);
    size_t stride = (size_t)cairo_image_surface_get_stride(page->surface);
    int32_t width_px = cairo_image_surface_get_width(page->surface);
    size_t height_px = (size_t)cairo_image_surface_get_height(page->surface);
    for (size_t y = 0; y < height_px; y++)
        invert(pixels + y * (size_t)width_px, rows + y * stride, width_px);
}

bool drawing_write_gray_png(const uint8_t *pixels, int32_t width_px, int32_t height_px, const char *path, double dpi,
                            error_text *error)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, width_px, height_px);
    cairo_status_t status = cairo_surface_status(surface);
    bool written = false;
    if (status != CAIRO_STATUS_SUCCESS) {
        error_text_set(error, "%.300s: cannot be made: %s", path, cairo_status_to_string(status));
    } else {
        cairo_surface_flush(surface);
        uint8_t *rows = cairo_image_surface_get_data(surface);
        size_t stride = (size_t)cairo_image_surface_get_stride(surface);
        for (size_t y = 0; y < (size_t)height_px; y++)
            for (size_t x = 0; x < (size_t)width_px; x++)
                rows[y * stride + x] = pixels[y * (size_t)width_px + x];
        cairo_surface_mark_dirty(surface);
        written = drawing_png_write(surface, path, dpi, error);
    }
    cairo_surface_destroy(surface);
    return written;
}

bool drawing_write_png(drawing *page, const char *path, double dpi, error_text *error)
{
    return !has_failed(page, error) && drawing_png_write(page->surface, path, dpi, error);
}

/* ---- Shapes -------------------------------------------------------------------------------------------- */

void drawing_set_colour(drawing *page, drawing_colour colour)
{
    if (page->gray)
        cairo_set_source_rgba(page->context, 0, 0, 0, (1 - colour.green) * colour.opacity);
    else
        cairo_set_source_rgba(page->context, colour.red, colour.green, colour.blue, colour.opacity);
}

/* cairo rounds each corner to 1/256 of the surface's unit. Its own rectangles round width and height instead, and
 * would overlap or leave slits between neighbours. */
void drawing_add_rectangle(drawing *page, drawing_point from, drawing_point to)
{
    const drawing_point corners[4] = {from, {to.x_mm, from.y_mm}, to, {from.x_mm, to.y_mm}};
    drawing_add_polygon(page, corners, 4);
}

void drawing_add_polygon(drawing *page, const drawing_point *corners, size_t count)
{
    for (size_t i = 0; i < count; i++)
        cairo_line_to(page->context, corners[i].x_mm, corners[i].y_mm);
    cairo_close_path(page->context);
    cairo_new_sub_path(page->context);
}

void drawing_add_line(drawing *page, drawing_point from, drawing_point to)
{
    cairo_move_to(page->context, from.x_mm, from.y_mm);
    cairo_line_to(page->context, to.x_mm, to.y_mm);
}

void drawing_fill(drawing *page)
{
    cairo_fill(page->context);
}

void drawing_stroke(drawing *page, double width_mm, double dash_mm)
{
    cairo_set_line_width(page->context, width_mm);
    cairo_set_dash(page->context, &dash_mm, dash_mm > 0 ? 1 : 0, 0);
    cairo_stroke(page->context);
}

static void choose_font(drawing *page, const drawing_font *font)
{
    cairo_select_font_face(page->context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           font->bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(page->context, font->size_mm);
}

double drawing_text_width_mm(drawing *page, const char *text, const drawing_font *font)
{
    cairo_text_extents_t extents;
    choose_font(page, font);
    cairo_text_extents(page->context, text, &extents);
    return extents.x_advance;
}

void drawing_text(drawing *page, const char *text, drawing_point at, const drawing_font *font)
{
    const double radians_per_degree = 0.017453292519943295;
    double width_mm = drawing_text_width_mm(page, text, font);
    double before_mm = font->anchor == DRAWING_LEFT ? 0 : font->anchor == DRAWING_MIDDLE ? width_mm / 2 : width_mm;
    cairo_save(page->context);
    cairo_translate(page->context, at.x_mm, at.y_mm);
    cairo_rotate(page->context, font->angle_deg * radians_per_degree);
    cairo_move_to(page->context, -before_mm, 0);
    cairo_show_text(page->context, text);
    cairo_restore(page->context);
    cairo_new_path(page->context);
}

static void fill_rgb(cairo_surface_t *target, const uint8_t *pixels, int32_t width_px, int32_t height_px,
                     ptrdiff_t stride_bytes)
{
    cairo_surface_flush(target);
    uint8_t *rows = cairo_image_surface_get_data(target);
    ptrdiff_t target_stride = cairo_image_surface_get_stride(target);
    for (ptrdiff_t y = 0; y < height_px; y++) {
        uint32_t *row = (uint32_t *)(void *)(rows + y * target_stride);
        for (ptrdiff_t x = 0; x < width_px; x++)
            row[x] = pixels[y * stride_bytes + x] * 0x010101u;
    }
    cairo_surface_mark_dirty(target);
}

void drawing_picture(drawing *page, const uint8_t *pixels, int32_t width_px, int32_t height_px,
                     ptrdiff_t stride_bytes, drawing_point from, drawing_point to, double opacity)
{
    cairo_surface_t *picture = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px);
    if (cairo_surface_status(picture) == CAIRO_STATUS_SUCCESS)
        fill_rgb(picture, pixels, width_px, height_px, stride_bytes);
    cairo_save(page->context);
    cairo_translate(page->context, from.x_mm, from.y_mm);
    cairo_scale(page->context, (to.x_mm - from.x_mm) / width_px, (to.y_mm - from.y_mm) / height_px);
    cairo_rectangle(page->context, 0, 0, width_px, height_px);
    cairo_clip(page->context);
    cairo_set_source_surface(page->context, picture, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(page->context), CAIRO_FILTER_GOOD);
    /* Else its outermost pixels would fade into what lies around it. */
    cairo_pattern_set_extend(cairo_get_source(page->context), CAIRO_EXTEND_PAD);
    cairo_paint_with_alpha(page->context, opacity);
    cairo_restore(page->context);
    cairo_surface_destroy(picture);
}

