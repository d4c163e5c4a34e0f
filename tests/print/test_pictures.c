/* Segments as files of their own: every module where it belongs, true to size, named by their ids. */
#include "printing.h"

#include <math.h>

enum { NAMES_MAX = 16 };

static const int32_t every_kind[] = {0, 1, -1, 77, -78, 79, -80, 3081, -3082, 79157, -79158, 1505581, -1505582};

static hand_tape tape_of_every_kind(double module_mm)
{
    static const hand_segment segments[] = {{0, 3, true}, {0, 1, false}, {1, 6, true}, {1, 3, true}};
    return hand_tape_new(module_mm, every_kind, segments, COUNT_OF(segments));
}

typedef bool (*printer)(const hand_tape *tape, const print_settings *settings, const char *folder,
                        print_summary *summary, error_text *error);

static bool print_png(const hand_tape *tape, const print_settings *settings, const char *folder,
                      print_summary *summary, error_text *error)
{
    return print_pictures(&tape->wanted, &tape->layout, settings, PRINT_PNG, folder, summary, error);
}

static bool print_pgm(const hand_tape *tape, const print_settings *settings, const char *folder,
                      print_summary *summary, error_text *error)
{
    return print_pictures(&tape->wanted, &tape->layout, settings, PRINT_PGM, folder, summary, error);
}

static bool print_svg(const hand_tape *tape, const print_settings *settings, const char *folder,
                      print_summary *summary, error_text *error)
{
    return print_svgs(&tape->wanted, &tape->layout, settings, folder, summary, error);
}

static const char *print_into_folder(printer print, const hand_tape *tape, const print_settings *settings)
{
    error_text error = {""};
    print_summary summary = {0};
    const char *folder = new_folder();
    if (!print(tape, settings, folder, &summary, &error))
        fail_msg("%s", error.text);
    assert_int_equal(summary.pages, list_folder(folder, NULL, 0));
    return folder;
}

/* ---- Pixels -------------------------------------------------------------------------------------------- */

/* With quiet zone around it, from the left edge and `top_px` on. */
static void assert_exact_modules(const raster *picture, const hand_tape *tape, size_t index, int32_t module_px,
                                 int32_t top_px)
{
    static uint8_t modules[7 * 1024];
    const layout_segment *segment = &tape->layout.segments[index];
    int32_t quiet = segment->bars ? 2 : 1;
    int32_t width = (int32_t)tapemark_segment_width_modules(segment->cm_count, segment->bars);
    assert_int_equal(tapemark_segment_draw(tape->layout.ids + segment->first_cm, segment->cm_count, segment->bars,
                                           modules, sizeof modules), TAPEMARK_OK);
    assert_int_equal(picture->width_px, (width + 2 * quiet) * module_px);
    assert_int_equal(picture->height_px, 9 * module_px + 2 * top_px);
    for (int32_t y = 0; y < 9 * module_px; y++) {
        for (int32_t x = 0; x < picture->width_px; x++) {
            int32_t row = y / module_px - 1, column = x / module_px - quiet;
            bool inside = row >= 0 && row < 7 && column >= 0 && column < width;
            uint8_t wanted = inside && modules[row * width + column] != 0 ? 0 : 255;
            assert_int_equal(picture->pixels[(size_t)(y + top_px) * (size_t)picture->width_px + (size_t)x], wanted);
        }
    }
}

static void assert_pictures_are_exact(printer print, bool without_labels, const char *ending)
{
    static char names[NAMES_MAX][64];
    /* 254 dpi are ten pixels a millimetre. */
    const print_settings settings = {.dpi = 254, .without_labels = without_labels};
    hand_tape tape = tape_of_every_kind(0.5);
    const char *folder = print_into_folder(print, &tape, &settings);
    static const char *const wanted[] = {"tape-001-cm0000000-0000001", "tape-002-cm0000077",
                                         "tape-003-cm0000078-0079157", "tape-004-cm0079158-1505582"};
    assert_int_equal(list_folder(folder, names, NAMES_MAX), COUNT_OF(wanted));
    for (size_t i = 0; i < COUNT_OF(wanted); i++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%s", wanted[i], ending);
        assert_string_equal(names[i], name);
        raster picture = raster_read(path_in(folder, name), settings.dpi);
        assert_exact_modules(&picture, &tape, i, 5, without_labels ? 0 : 45);
        raster_release(&picture);
    }
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void whole_pixels_a_module_are_exact(void **state)
{
    (void)state;
    assert_pictures_are_exact(print_png, true, "png");
    assert_pictures_are_exact(print_pgm, true, "pgm");
    assert_pictures_are_exact(print_png, false, "png");
}

/* Each pixel against its share of ink, added up from a hundred points. */
static void parts_of_pixels_are_gray(void **state)
{
    static const int32_t ids[] = {-12345};
    static const hand_segment segments[] = {{0, 1, false}};
    static uint8_t modules[7 * 32];
    enum { FINE = 10 };
    (void)state;
    const double module_px = 2.37;
    hand_tape tape = hand_tape_new(module_px / 10, ids, segments, 1);
    const char *folder = print_into_folder(print_pgm, &tape, &(print_settings){.dpi = 254, .without_labels = true});
    raster picture = raster_read(path_in(folder, "tape-001-cm12345.pgm"), 254);
    assert_int_equal(picture.width_px, ceil(34 * module_px));
    assert_int_equal(picture.height_px, ceil(9 * module_px));
    assert_int_equal(tapemark_segment_draw(ids, 1, false, modules, sizeof modules), TAPEMARK_OK);
    for (int32_t i = 0; i < picture.width_px * picture.height_px; i++) {
        int dark = 0;
        for (int point = 0; point < FINE * FINE; point++) {
            double x = (i % picture.width_px + (point % FINE + 0.5) / FINE) / module_px - 1;
            double y = (i / picture.width_px + (point / FINE + 0.5) / FINE) / module_px - 1;
            bool inside = x >= 0 && x < 32 && y >= 0 && y < 7;
            dark += inside ? modules[(int)y * 32 + (int)x] : 0;
        }
        /* Points a tenth apart miss an edge by a twentieth; two edges of each kind may cross a pixel. */
        assert_near(picture.pixels[i] / 255.0, 1 - dark / (double)(FINE * FINE), 0.16);
    }
    raster_release(&picture);
    remove_folder(folder);
    hand_tape_release(&tape);
}

/* Ink of labels is there, and all of it outside of the quiet zone, where whole_pixels_a_module_are_exact() looks. */
static void labels_stand_above_and_below(void **state)
{
    (void)state;
    hand_tape tape = tape_of_every_kind(2);
    const char *folder = print_into_folder(print_png, &tape, &(print_settings){.dpi = 254});
    raster picture = raster_read(path_in(folder, "tape-001-cm0000000-0000001.png"), 254);
    int dark_above = 0, dark_below = 0;
    for (int32_t y = 0; y < 45; y++) {
        for (int32_t x = 0; x < picture.width_px; x++) {
            dark_above += picture.pixels[y * picture.width_px + x] < 100 ? 1 : 0;
            dark_below += picture.pixels[(picture.height_px - 1 - y) * picture.width_px + x] < 100 ? 1 : 0;
        }
    }
    /* An arrow and a figure of some 2 mm each are hundreds of pixels. */
    assert_in_range(dark_above, 300, 5000);
    assert_in_range(dark_below, 300, 5000);
    raster_release(&picture);
    remove_folder(folder);
    hand_tape_release(&tape);
}

/* The pHYs chunk: pixels a metre, both ways. */
static void png_knows_its_size_on_paper(void **state)
{
    (void)state;
    hand_tape tape = tape_of_every_kind(2);
    const char *folder = print_into_folder(print_png, &tape, &(print_settings){.dpi = 300, .without_labels = true});
    size_t size;
    char *bytes = read_text(path_in(folder, "tape-002-cm0000077.png"), &size);
    static const uint8_t wanted[] = {0, 0, 0, 9, 'p', 'H', 'Y', 's', 0, 0, 0x2e, 0x23, 0, 0, 0x2e, 0x23, 1};
    assert_true(size > 33 + sizeof wanted);
    assert_memory_equal(bytes + 33, wanted, sizeof wanted);
    free(bytes);
    remove_folder(folder);
    hand_tape_release(&tape);
}

/* What the limits say is possible is possible, and what lies beyond is not. */
static void resolutions_out_of_range_name_the_limit(void **state)
{
    (void)state;
    hand_tape tape = tape_of_every_kind(60.0 / 7);
    const char *folder = new_folder();
    error_text error = {""};
    print_summary summary;
    const double too_many = 700, too_few = 2;
    char number[32];
    assert_false(print_png(&tape, &(print_settings){.dpi = too_many, .without_labels = true}, folder, &summary,
                           &error));
    assert_int_equal(sscanf(strstr(error.text, "use "), "use %31[0-9.] dpi or less", number), 1);
    double highest = atof(number);
    assert_false(print_png(&tape, &(print_settings){.dpi = highest + 0.2, .without_labels = true}, folder, &summary,
                           &error));
    assert_false(print_png(&tape, &(print_settings){.dpi = too_few}, folder, &summary, &error));
    assert_int_equal(sscanf(strstr(error.text, "use "), "use %31[0-9.] dpi or more", number), 1);
    double lowest = atof(number);
    assert_false(print_png(&tape, &(print_settings){.dpi = NAN}, folder, &summary, &error));
    assert_int_equal(list_folder(folder, NULL, 0), 0);
    assert_true(print_png(&tape, &(print_settings){.dpi = lowest}, folder, &summary, &error));
    static const print_id_range longest = {78, 79157};
    const print_settings high = {.dpi = highest, .without_labels = true, .only = &longest, .only_count = 1};
    assert_true(print_png(&tape, &high, folder, &summary, &error));
    raster picture = raster_read(path_in(folder, "tape-003-cm0000078-0079157.png"), highest);
    assert_in_range(picture.width_px, 32700, 32767);
    raster_release(&picture);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void folders_that_are_not_there_are_told(void **state)
{
    static const printer printers[] = {print_png, print_pgm, print_svg};
    (void)state;
    hand_tape tape = tape_of_every_kind(1);
    for (size_t i = 0; i < COUNT_OF(printers); i++) {
        error_text error = {""};
        print_summary summary;
        assert_false(printers[i](&tape, &(print_settings){.dpi = 100}, "/nowhere/at/all", &summary, &error));
        assert_text_has(error.text, "/nowhere/at/all/tape-001");
        assert_text_has(error.text, "No such file or directory");
    }
    hand_tape_release(&tape);
}

/* ---- SVG ----------------------------------------------------------------------------------------------- */

typedef struct svg_box {
    double left, top, right, bottom;
} svg_box;

/* The next rectangle of a path: four corners. NULL at its end. */
static const char *next_box(const char *path, svg_box *box)
{
    double x[4], y[4];
    int used = 0;
    if (sscanf(path, " M %lf %lf L %lf %lf L %lf %lf L %lf %lf Z%n", &x[0], &y[0], &x[1], &y[1], &x[2], &y[2], &x[3],
               &y[3], &used) != 8 || used == 0)
        return NULL;
    *box = (svg_box){fmin(x[0], x[2]), fmin(y[0], y[2]), fmax(x[0], x[2]), fmax(y[0], y[2])};
    return path + used;
}

/* Each corner lies on the grid of modules, to four micrometres. */
static int on_grid(double length_mm, double module_mm)
{
    double modules = length_mm / module_mm;
    assert_near(length_mm, round(modules) * module_mm, 0.004);
    return (int)lround(modules);
}

static void paint(uint8_t *modules, int width, const svg_box *box, double module_mm, double top_mm)
{
    int left = on_grid(box->left, module_mm), right = on_grid(box->right, module_mm);
    int top = on_grid(box->top - top_mm, module_mm), bottom = on_grid(box->bottom - top_mm, module_mm);
    assert_true(left >= 0 && left < right && right <= width && top >= 0 && top < bottom && bottom <= 9);
    for (int y = top; y < bottom; y++) {
        for (int x = left; x < right; x++)
            modules[y * width + x]++;
    }
}

static void assert_svg(const char *text, const hand_tape *tape, size_t index, double top_mm)
{
    static uint8_t seen[9 * 1024], drawn[7 * 1024];
    const layout_segment *segment = &tape->layout.segments[index];
    double module_mm = tape->wanted.module_mm, width_mm, height_mm;
    int quiet = segment->bars ? 2 : 1;
    int ink_width = (int)tapemark_segment_width_modules(segment->cm_count, segment->bars);
    int width = ink_width + 2 * quiet;
    const char *size = strstr(text, "width=\"");
    assert_non_null(size);
    assert_int_equal(sscanf(size, "width=\"%lfmm\" height=\"%lfmm\"", &width_mm, &height_mm), 2);
    assert_near(width_mm, width * module_mm, 0.001);
    assert_near(height_mm, 9 * module_mm + 2 * top_mm, 0.001);
    /* Glyphs are defined before; ink is the first black filled path. */
    const char *path = strstr(text, "<path style=\" stroke:none;fill-rule:nonzero;fill:rgb(0%,0%,0%);");
    assert_non_null(path);
    path = strstr(path, " d=\"") + 4;
    memset(seen, 0, sizeof seen);
    svg_box box;
    while ((path = next_box(path, &box)) != NULL)
        paint(seen, width, &box, module_mm, top_mm);
    assert_int_equal(tapemark_segment_draw(tape->layout.ids + segment->first_cm, segment->cm_count, segment->bars,
                                           drawn, sizeof drawn), TAPEMARK_OK);
    for (int y = 0; y < 9; y++) {
        for (int x = 0; x < width; x++) {
            bool inside = y >= 1 && y < 8 && x >= quiet && x < quiet + ink_width;
            assert_int_equal(seen[y * width + x], inside ? drawn[(y - 1) * ink_width + x - quiet] : 0);
        }
    }
}

static void svgs_are_true_to_size(void **state)
{
    static char names[NAMES_MAX][64];
    (void)state;
    for (int labels = 0; labels < 2; labels++) {
        const print_settings settings = {.without_labels = labels == 0};
        hand_tape tape = tape_of_every_kind(60.0 / 7);
        const char *folder = print_into_folder(print_svg, &tape, &settings);
        assert_int_equal(list_folder(folder, names, NAMES_MAX), 4);
        assert_string_equal(names[1], "tape-002-cm0000077.svg");
        for (size_t i = 0; i < 4; i++) {
            size_t size;
            char *text = read_text(path_in(folder, names[i]), &size);
            assert_svg(text, &tape, i, labels == 0 ? 0 : 4.5);
            assert_int_equal(strstr(text, "<use ") != NULL, labels);
            free(text);
        }
        remove_folder(folder);
        hand_tape_release(&tape);
    }
}

/* A piece to mend a TM with has half of the light columns at its sides. */
static void repair_pieces_are_whole(void **state)
{
    static const print_id_range only = {78, 79};
    static readings read;
    (void)state;
    hand_tape tape = tape_of_every_kind(1);
    const print_settings settings = {.dpi = 254, .only = &only, .only_count = 1};
    const char *folder = print_into_folder(print_pgm, &tape, &settings);
    raster picture = raster_read(path_in(folder, "tape-003-cm0000078-0000079.pgm"), 254);
    /* Quiet zone, bars, two CMs, half a module. */
    assert_int_equal(picture.width_px, 10 * (2 + 8 + 57) + 5);
    read_markers(&picture, &read);
    assert_int_equal(read.cm_count, 2);
    assert_int_equal(read.cms[0].id, -78);
    assert_int_equal(read.cms[1].id, 79);
    raster_release(&picture);
    remove_folder(folder);
    hand_tape_release(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_pixels_a_module_are_exact),
        cmocka_unit_test(parts_of_pixels_are_gray),
        cmocka_unit_test(labels_stand_above_and_below),
        cmocka_unit_test(png_knows_its_size_on_paper),
        cmocka_unit_test(resolutions_out_of_range_name_the_limit),
        cmocka_unit_test(folders_that_are_not_there_are_told),
        cmocka_unit_test(svgs_are_true_to_size),
        cmocka_unit_test(repair_pieces_are_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
