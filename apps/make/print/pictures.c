/* Each segment as a file of its own: SVG, PNG or PGM. */
#include "output_file.h"
#include "piece.h"
#include "sampling.h"

#include "tapemark.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double MM_PER_INCH = 25.4;

typedef struct picture_job {
    const plan *wanted;
    const tape_layout *layout;
    const print_settings *settings;
    const char *folder;
    const char *ending;
    tape_stretches stretches;
} picture_job;

typedef bool (*write_piece)(const picture_job *job, const tape_piece *piece, const tape_columns *drawn,
                            const char *path, error_text *error);

/* ---- Files --------------------------------------------------------------------------------------------- */

static int digits_of(size_t number, int least)
{
    int digits = 1;
    for (size_t rest = number; rest >= 10 && digits < 20; rest /= 10)
        digits++;
    return digits > least ? digits : least;
}

static long magnitude(int32_t id)
{
    return labs((long)id);
}

/* tape-003-cm0017-0020.png: names that sort in the order of drawing. NULL when memory runs out. */
static char *make_path(const picture_job *job, const tape_stretch *stretch)
{
    const tape_layout *layout = job->layout;
    long first = magnitude(layout->ids[stretch->cm_begin]), last = magnitude(layout->ids[stretch->cm_end - 1]);
    int number_digits = digits_of(layout->segment_count, 3);
    int id_digits = digits_of((size_t)magnitude(layout->ids[layout->cm_count - 1]), 4);
    char after[32] = "";
    if (first != last)
        snprintf(after, sizeof after, "-%0*ld", id_digits, last);
    static const char format[] = "%s/tape-%0*zu-cm%0*ld%s.%s";
    size_t number = stretch->segment_begin + 1;
    int length = snprintf(NULL, 0, format, job->folder, number_digits, number, id_digits, first, after, job->ending);
    char *path = malloc((size_t)length + 1);
    if (path != NULL)
        snprintf(path, (size_t)length + 1, format, job->folder, number_digits, number, id_digits, first, after,
                 job->ending);
    return path;
}

static bool write_stretch(const picture_job *job, const tape_stretch *stretch, write_piece write, error_text *error)
{
    tape_columns drawn;
    const tape_piece piece = {.stretch = stretch, .start_halves = stretch->start_halves,
                              .end_halves = stretch->end_halves, .segment_begin = stretch->segment_begin,
                              .segment_end = stretch->segment_end, .number = 1};
    if (!strip_draw(job->layout, stretch, &drawn, error))
        return false;
    char *path = make_path(job, stretch);
    bool written = path != NULL && write(job, &piece, &drawn, path, error);
    if (path == NULL)
        error_text_set(error, "not enough memory");
    free(path);
    free(drawn.columns);
    return written;
}

static bool write_all(const picture_job *job, write_piece write, print_summary *summary, error_text *error)
{
    for (size_t i = 0; i < job->stretches.count; i++) {
        if (!write_stretch(job, &job->stretches.items[i], write, error))
            return false;
    }
    *summary = (print_summary){.pages = job->stretches.count, .pieces = job->stretches.count};
    return true;
}

static double band_mm(const picture_job *job)
{
    return job->settings->without_labels ? 0 : PIECE_BAND_MM;
}

/* ---- SVG ----------------------------------------------------------------------------------------------- */

static bool write_svg(const picture_job *job, const tape_piece *piece, const tape_columns *drawn, const char *path,
                      error_text *error)
{
    const piece_style style = {.labels = !job->settings->without_labels};
    double height_mm = piece_height_mm(job->wanted) + 2 * band_mm(job);
    drawing *page = drawing_open_svg(path, piece_length_mm(job->wanted, piece), height_mm, error);
    if (page == NULL)
        return false;
    piece_draw(page, job->wanted, job->layout, piece, drawn, &style, (drawing_point){0, band_mm(job)});
    return drawing_close(page, error);
}

bool print_svgs(const plan *wanted, const tape_layout *layout, const print_settings *settings, const char *folder,
                print_summary *summary, error_text *error)
{
    picture_job job = {wanted, layout, settings, folder, "svg", {NULL, 0}};
    if (!strip_select(layout, settings, true, &job.stretches, error))
        return false;
    bool done = write_all(&job, write_svg, summary, error);
    free(job.stretches.items);
    return done;
}

/* ---- Pixels -------------------------------------------------------------------------------------------- */

typedef struct picture_size {
    double module_px;
    int32_t width_px, height_px;
    int32_t band_px;  /* of the height, above and below the quiet zone */
} picture_size;

static double px_per_mm(const picture_job *job)
{
    return job->settings->dpi / MM_PER_INCH;
}

/* Whole pixels that hold a length; a hair's breadth more than whole ones is rounding. */
static double whole_px(double length_px)
{
    return ceil(length_px - 1e-6);
}

/* False where cairo, and with it PNG, ends. */
static bool measure(const picture_job *job, int64_t length_halves, picture_size *size)
{
    double module_px = job->wanted->module_mm * px_per_mm(job);
    double width_px = whole_px((double)length_halves / 2 * module_px);
    double band_px = whole_px(band_mm(job) * px_per_mm(job));
    double height_px = whole_px((TAPEMARK_HEIGHT_MODULES + 2) * module_px) + 2 * band_px;
    if (!(width_px <= DRAWING_SIDE_MAX_PX && height_px <= DRAWING_SIDE_MAX_PX))
        return false;
    *size = (picture_size){module_px, (int32_t)width_px, (int32_t)height_px, (int32_t)band_px};
    return true;
}

/* Before anything is written: the largest picture has to be possible, and modules to be seen. */
static bool check_dpi(const picture_job *job, error_text *error)
{
    int64_t longest_halves = 0;
    picture_size size;
    for (size_t i = 0; i < job->stretches.count; i++) {
        int64_t halves = job->stretches.items[i].end_halves - job->stretches.items[i].start_halves;
        longest_halves = halves > longest_halves ? halves : longest_halves;
    }
    double dpi = job->settings->dpi, least_dpi = MM_PER_INCH / job->wanted->module_mm;
    double length_mm = (double)longest_halves / 2 * job->wanted->module_mm;
    double highest_dpi = floor(10 * DRAWING_SIDE_MAX_PX * MM_PER_INCH / length_mm) / 10;
    if (!(dpi >= least_dpi - 1e-9))
        error_text_set(error, "at %.10g dpi a module of %.10g mm is less than a pixel: use %.1f dpi or more", dpi,
                       job->wanted->module_mm, ceil(10 * least_dpi) / 10);
    else if (!measure(job, longest_halves, &size))
        error_text_set(error, "at %.10g dpi the longest segment has more than %d px: use %.1f dpi or less", dpi,
                       (int)DRAWING_SIDE_MAX_PX, highest_dpi);
    else
        return true;
    return false;
}

static bool write_pgm(const uint8_t *pixels, const picture_size *size, const char *path, error_text *error)
{
    error_text reason;
    output_file *file = output_file_open(path, &reason);
    if (file != NULL) {
        FILE *stream = output_file_stream(file);
        fprintf(stream, "P5\n%d %d\n255\n", (int)size->width_px, (int)size->height_px);
        fwrite(pixels, 1, (size_t)size->width_px * (size_t)size->height_px, stream);
    }
    if (file != NULL && output_file_publish(file, &reason))
        return true;
    error_text_set(error, "%.200s: %.180s", path, reason.text);
    return false;
}

/* White paper, with labels if these are wanted. */
static bool draw_paper(const picture_job *job, const tape_piece *piece, const picture_size *size, uint8_t *pixels,
                       error_text *error)
{
    if (size->band_px == 0)
        return true;
    drawing *page = drawing_open_pixels(DRAWING_GRAY, size->width_px, size->height_px, px_per_mm(job), error);
    if (page == NULL)
        return false;
    piece_draw_labels(page, job->wanted, job->layout, piece, (drawing_point){0, size->band_px / px_per_mm(job)});
    drawing_copy_gray(page, pixels);
    return drawing_close(page, error);
}

static bool draw_pixels(const picture_job *job, const tape_piece *piece, const tape_columns *drawn,
                        const picture_size *size, uint8_t *pixels, error_text *error)
{
    if (!draw_paper(job, piece, size, pixels, error))
        return false;
    uint8_t *quiet_zone = pixels + (size_t)size->band_px * (size_t)size->width_px;
    if (sample_piece(piece, drawn, size->module_px, quiet_zone, (size_t)size->width_px,
                     (size_t)(size->height_px - 2 * size->band_px)))
        return true;
    error_text_set(error, "not enough memory for a picture of %d x %d px", (int)size->width_px,
                   (int)size->height_px);
    return false;
}

static bool write_picture(const picture_job *job, const tape_piece *piece, const tape_columns *drawn,
                          const char *path, bool png, error_text *error)
{
    picture_size size;
    if (!measure(job, piece->end_halves - piece->start_halves, &size)) {
        error_text_set(error, "%.300s: would be too large", path);
        return false;
    }
    uint8_t *pixels = malloc((size_t)size.width_px * (size_t)size.height_px);
    if (pixels == NULL) {
        error_text_set(error, "not enough memory for a picture of %d x %d px", (int)size.width_px,
                       (int)size.height_px);
        return false;
    }
    bool written = draw_pixels(job, piece, drawn, &size, pixels, error);
    if (written && png)
        written = drawing_write_gray_png(pixels, size.width_px, size.height_px, path, job->settings->dpi, error);
    else if (written)
        written = write_pgm(pixels, &size, path, error);
    free(pixels);
    return written;
}

static bool write_png_piece(const picture_job *job, const tape_piece *piece, const tape_columns *drawn,
                            const char *path, error_text *error)
{
    return write_picture(job, piece, drawn, path, true, error);
}

static bool write_pgm_piece(const picture_job *job, const tape_piece *piece, const tape_columns *drawn,
                            const char *path, error_text *error)
{
    return write_picture(job, piece, drawn, path, false, error);
}

bool print_pictures(const plan *wanted, const tape_layout *layout, const print_settings *settings,
                    print_picture_format format, const char *folder, print_summary *summary, error_text *error)
{
    picture_job job = {wanted, layout, settings, folder, format == PRINT_PNG ? "png" : "pgm", {NULL, 0}};
    if (!strip_select(layout, settings, true, &job.stretches, error))
        return false;
    bool done = check_dpi(&job, error) &&
                write_all(&job, format == PRINT_PNG ? write_png_piece : write_pgm_piece, summary, error);
    free(job.stretches.items);
    return done;
}
