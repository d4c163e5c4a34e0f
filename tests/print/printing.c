#include "printing.h"

#include "frame_source.h"
#include "gray.h"

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

/* ---- Tapes --------------------------------------------------------------------------------------------- */

hand_tape hand_tape_new(double module_mm, const int32_t *ids, const hand_segment *segments, size_t segment_count)
{
    hand_tape tape = {.wanted = {.width_m = 100, .height_m = 100, .module_mm = module_mm}};
    tape_layout *layout = &tape.layout;
    layout->segments = calloc(segment_count, sizeof *layout->segments);
    layout->segment_count = segment_count;
    uint32_t cursor_modules = 0;
    for (size_t i = 0; i < segment_count; i++) {
        layout_segment *segment = &layout->segments[i];
        *segment = (layout_segment){.line = segments[i].line, .first_cm = layout->cm_count,
                                    .cm_count = segments[i].cm_count, .bars = segments[i].bars};
        cursor_modules = i > 0 && segments[i - 1].line == segments[i].line ? cursor_modules : 0;
        uint32_t quiet = layout_quiet_modules(segment);
        segment->start_modules = cursor_modules + quiet;
        cursor_modules = segment->start_modules + quiet +
                         (uint32_t)tapemark_segment_width_modules(segment->cm_count, segment->bars);
        layout->cm_count += segment->cm_count;
    }
    layout->ids = malloc(layout->cm_count * sizeof *layout->ids);
    memcpy(layout->ids, ids, layout->cm_count * sizeof *ids);
    tape.wanted.line_count = segments[segment_count - 1].line + 1;
    tape.wanted.lines = calloc(tape.wanted.line_count, sizeof *tape.wanted.lines);
    for (size_t i = 0; i < tape.wanted.line_count; i++)
        tape.wanted.lines[i] = (plan_line){{0, (double)i}, {100, (double)i}, PLAN_ON_WALL, 0};
    return tape;
}

hand_tape hand_tape_of_tms(double module_mm, int32_t first_id, const unsigned *codes, size_t tm_count, bool apart)
{
    enum { CMS = 6, TMS = 64 };
    int32_t ids[CMS * TMS];
    hand_segment segments[TMS];
    assert_true(tm_count <= TMS);
    for (size_t i = 0; i < tm_count; i++) {
        segments[i] = (hand_segment){apart ? i : 0, CMS, true};
        for (size_t slot = 0; slot < CMS; slot++) {
            int32_t id = first_id + (int32_t)(CMS * i + slot);
            ids[CMS * i + slot] = (codes[i] >> (CMS - 1 - slot) & 1) != 0 ? id : -id;
        }
    }
    return hand_tape_new(module_mm, ids, segments, tm_count);
}

void hand_tape_release(hand_tape *tape)
{
    free(tape->layout.ids);
    free(tape->layout.segments);
    free(tape->wanted.lines);
}

/* ---- Files --------------------------------------------------------------------------------------------- */

enum { PATHS = 8, PATH_BYTES = 512 };

static char *next_path(void)
{
    static char paths[PATHS][PATH_BYTES];
    static size_t next;
    return paths[next++ % PATHS];
}

const char *new_folder(void)
{
    const char *parent = getenv("TMPDIR");
    char *path = next_path();
    snprintf(path, PATH_BYTES, "%s/tapemark-print-XXXXXX", parent != NULL ? parent : "/tmp");
    assert_non_null(mkdtemp(path));
    return path;
}

const char *path_in(const char *folder, const char *name)
{
    char *path = next_path();
    snprintf(path, PATH_BYTES, "%s/%s", folder, name);
    return path;
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

size_t list_folder(const char *folder, char names[][64], size_t capacity)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, is_visible, alphasort);
    assert_true(count >= 0);
    for (int i = 0; i < count; i++) {
        if ((size_t)i < capacity)
            snprintf(names[i], 64, "%.63s", entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
    return (size_t)count;
}

void remove_folder(const char *folder)
{
    static char names[4096][64];
    char path[PATH_BYTES];
    size_t count = list_folder(folder, names, COUNT_OF(names));
    for (size_t i = 0; i < count && i < COUNT_OF(names); i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
    assert_int_equal(rmdir(folder), 0);
}

char *read_text(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    char *text = calloc(*size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *size, file), *size);
    fclose(file);
    return text;
}

/* ---- Pixels -------------------------------------------------------------------------------------------- */

raster raster_read(const char *path, double dpi)
{
    error_text error = {""};
    frame current;
    gray_view view;
    gray_converter converter = {0};
    frame_source *source = frame_source_open_file(path, NULL, &error);
    if (source == NULL || frame_source_next(source, &current, &error) != FRAME_READY ||
        !gray_from_frame(&converter, &current, &view, &error))
        fail_msg("%s: %s", path, error.text);
    raster picture = {malloc((size_t)view.width_px * (size_t)view.height_px), view.width_px, view.height_px,
                      dpi / 25.4};
    assert_non_null(picture.pixels);
    for (int32_t y = 0; y < view.height_px; y++)
        memcpy(picture.pixels + (size_t)y * (size_t)view.width_px, view.pixels + y * view.stride_bytes,
               (size_t)view.width_px);
    gray_converter_release(&converter);
    frame_source_close(source);
    return picture;
}

void raster_release(raster *picture)
{
    free(picture->pixels);
    *picture = (raster){0};
}

static double pixel(const raster *picture, int32_t x, int32_t y)
{
    if (x < 0 || y < 0 || x >= picture->width_px || y >= picture->height_px)
        return 255;
    return picture->pixels[(size_t)y * (size_t)picture->width_px + (size_t)x];
}

double raster_at(const raster *picture, double x_px, double y_px)
{
    int32_t x = (int32_t)floor(x_px), y = (int32_t)floor(y_px);
    double right = x_px - x, below = y_px - y;
    double above = pixel(picture, x, y) * (1 - right) + pixel(picture, x + 1, y) * right;
    double under = pixel(picture, x, y + 1) * (1 - right) + pixel(picture, x + 1, y + 1) * right;
    return above * (1 - below) + under * below;
}

raster_pages rasterise(const char *pdf_path, int dpi)
{
    static char names[1024][64];
    char command[2 * PATH_BYTES], path[PATH_BYTES];
    const char *folder = new_folder();
    snprintf(command, sizeof command, "'%s' -r %d -gray '%s' '%s/page'", TEST_PDFTOPPM, dpi, pdf_path, folder);
    assert_int_equal(system(command), 0);
    raster_pages pages = {NULL, list_folder(folder, names, COUNT_OF(names))};
    assert_true(pages.count > 0 && pages.count <= COUNT_OF(names));
    pages.items = calloc(pages.count, sizeof *pages.items);
    for (size_t i = 0; i < pages.count; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        pages.items[i] = raster_read(path, dpi);
    }
    remove_folder(folder);
    return pages;
}

void raster_pages_release(raster_pages *pages)
{
    for (size_t i = 0; i < pages->count; i++)
        raster_release(&pages->items[i]);
    free(pages->items);
}

void assert_text_has(const char *text, const char *wanted)
{
    if (strstr(text, wanted) == NULL)
        fail_msg("\"%s\" is not in: %s", wanted, text);
}

void assert_near(double seen, double wanted, double tolerance)
{
    if (!(fabs(seen - wanted) <= tolerance))
        fail_msg("%.4f is not %.4f +- %.4f", seen, wanted, tolerance);
}

/* ---- Reading ------------------------------------------------------------------------------------------- */

static double middle_y(const tapemark_point corners[4])
{
    return (corners[0].y_px + corners[1].y_px + corners[2].y_px + corners[3].y_px) / 4;
}

/* Markers of a row overlap in height. */
static int compare_places(const tapemark_point a[4], const tapemark_point b[4])
{
    double height = fabs((double)(a[3].y_px - a[0].y_px)) / 2, dy = middle_y(a) - middle_y(b);
    if (fabs(dy) > height)
        return dy < 0 ? -1 : 1;
    return a[0].x_px < b[0].x_px ? -1 : 1;
}

static int compare_cms(const void *a, const void *b)
{
    return compare_places(((const tapemark_cm *)a)->corners, ((const tapemark_cm *)b)->corners);
}

static int compare_tms(const void *a, const void *b)
{
    return compare_places(((const tapemark_tm *)a)->corners, ((const tapemark_tm *)b)->corners);
}

void read_markers(const raster *picture, readings *read)
{
    tapemark_image image = {picture->pixels, picture->width_px, picture->height_px, picture->width_px};
    size_t workspace_size = tapemark_workspace_bytes(image.width_px, image.height_px);
    void *workspace = malloc(workspace_size);
    assert_non_null(workspace);
    tapemark_result result = {.cms = read->cms, .cm_capacity = CMS_MAX, .tms = read->tms, .tm_capacity = TMS_MAX};
    tapemark_status status = tapemark_decode(&image, NULL, workspace, workspace_size, &result);
    assert_true(status == TAPEMARK_OK || status == TAPEMARK_NOTHING_FOUND);
    free(workspace);
    read->cm_count = result.cm_count;
    read->tm_count = result.tm_count;
    qsort(read->cms, read->cm_count, sizeof *read->cms, compare_cms);
    qsort(read->tms, read->tm_count, sizeof *read->tms, compare_tms);
}

static void assert_upright(const tapemark_point corners[4])
{
    assert_true(corners[1].x_px > corners[0].x_px && corners[2].x_px > corners[3].x_px);
    assert_true(corners[3].y_px > corners[0].y_px && corners[2].y_px > corners[1].y_px);
}

void assert_reads_segment(const hand_tape *tape, size_t index, const readings *read, size_t *next_cm,
                          size_t *next_tm)
{
    const layout_segment *segment = &tape->layout.segments[index];
    const int32_t *ids = tape->layout.ids + segment->first_cm;
    char code[TAPEMARK_TM_MAX_CMS + 1] = "";
    assert_true(*next_cm + segment->cm_count <= read->cm_count);
    for (size_t slot = 0; slot < segment->cm_count; slot++) {
        const tapemark_cm *cm = &read->cms[(*next_cm)++];
        assert_int_equal(cm->id, ids[slot]);
        assert_upright(cm->corners);
        code[slot] = ids[slot] >= 0 ? '1' : '0';
    }
    if (!segment->bars)
        return;
    assert_true(*next_tm < read->tm_count);
    const tapemark_tm *tm = &read->tms[(*next_tm)++];
    assert_string_equal(tm->code, code);
    assert_true(tm->directed);
    assert_upright(tm->corners);
}

void assert_reads_all(const hand_tape *tape, const readings *read)
{
    size_t next_cm = 0, next_tm = 0;
    for (size_t i = 0; i < tape->layout.segment_count; i++)
        assert_reads_segment(tape, i, read, &next_cm, &next_tm);
    assert_int_equal(next_cm, read->cm_count);
    assert_int_equal(next_tm, read->tm_count);
}

/* Of the segment's own frame, 0 to 1 along and across. */
static double at_share(const raster *picture, const tapemark_point corners[4], double u, double v)
{
    double x_px = (corners[0].x_px * (1 - u) + corners[1].x_px * u) * (1 - v) +
                  (corners[3].x_px * (1 - u) + corners[2].x_px * u) * v;
    double y_px = (corners[0].y_px * (1 - u) + corners[1].y_px * u) * (1 - v) +
                  (corners[3].y_px * (1 - u) + corners[2].y_px * u) * v;
    return raster_at(picture, x_px, y_px);
}

/* The quiet zone is looked at thrice a module, up to a tenth of a module from its ends. */
static void assert_quiet(const raster *picture, const tapemark_point corners[4], double width, double quiet)
{
    const double step = 1.0 / 3, across[] = {-0.9, -0.6, -0.3, 7.3, 7.6, 7.9};
    for (double x = 0.1 - quiet; x <= width + quiet - 0.1; x += step) {
        for (size_t i = 0; i < COUNT_OF(across); i++)
            assert_true(at_share(picture, corners, x / width, across[i] / TAPEMARK_HEIGHT_MODULES) > 240);
    }
    for (double away = 0.3; away < quiet - 0.1; away += step) {
        for (double y = 0; y < TAPEMARK_HEIGHT_MODULES; y += step) {
            assert_true(at_share(picture, corners, -away / width, y / TAPEMARK_HEIGHT_MODULES) > 240);
            assert_true(at_share(picture, corners, 1 + away / width, y / TAPEMARK_HEIGHT_MODULES) > 240);
        }
    }
}

void assert_modules(const raster *picture, const int32_t *ids, size_t cm_count, bool bars,
                    const tapemark_point corners[4])
{
    static uint8_t modules[TAPEMARK_HEIGHT_MODULES * (25 * TAPEMARK_TM_MAX_CMS + 23)];
    size_t width = tapemark_segment_width_modules(cm_count, bars);
    assert_int_equal(tapemark_segment_draw(ids, cm_count, bars, modules, sizeof modules), TAPEMARK_OK);
    for (size_t y = 0; y < TAPEMARK_HEIGHT_MODULES; y++) {
        for (size_t x = 0; x < width; x++) {
            double seen = at_share(picture, corners, ((double)x + 0.5) / (double)width,
                                   ((double)y + 0.5) / TAPEMARK_HEIGHT_MODULES);
            assert_int_equal(seen < 128, modules[y * width + x]);
        }
    }
    assert_quiet(picture, corners, (double)width, bars ? 2 : 1);
}
