/* What is printed against the format's own test vectors, and against the pictures that the marker's inventors
 * published. Both lie outside of this repository: see tests/app/CMakeLists.txt for what their absence means. */
#include "printing.h"

#include <math.h>
#include <sys/stat.h>

enum { VECTORS = 211, EXIT_SKIPPED = 77, CELLS_TEXT = TAPEMARK_CELLS + TAPEMARK_CELL_ROWS - 1 };

static const char *data_folder(void)
{
    const char *named = getenv("TAPEMARK_PAPER_DATA");
    return named != NULL ? named : TAPEMARK_PAPER_DATA_DEFAULT;
}

/* ---- Vectors ------------------------------------------------------------------------------------------- */

typedef struct vector {
    int32_t id;
    char cells[CELLS_TEXT + 1];  /* rows are set apart by a slash */
} vector;

static void read_vectors(vector *vectors)
{
    char path[600], line[512];
    snprintf(path, sizeof path, "%s/../format/vectors.csv", data_folder());
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (size_t i = 0; i < VECTORS; i++) {
        assert_non_null(fgets(line, sizeof line, file));
        int id;
        assert_int_equal(sscanf(line, "%d,%*[01],%*[01],%118[01/]", &id, vectors[i].cells), 2);
        vectors[i].id = id;
    }
    assert_null(fgets(line, sizeof line, file));
    fclose(file);
}

/* The cells of a CM's coding region as the page shows them between its corners. */
static void assert_cells(const raster *page, const tapemark_cm *cm, const char *cells)
{
    const tapemark_point *corners = cm->corners;
    for (int i = 0; i < TAPEMARK_CELLS; i++) {
        int row = i / TAPEMARK_CELL_COLUMNS, column = i % TAPEMARK_CELL_COLUMNS;
        double u = (8 + column + 0.5) / 32, v = (row + 0.5) / 7;
        double x = (corners[0].x_px * (1 - u) + corners[1].x_px * u) * (1 - v) +
                   (corners[3].x_px * (1 - u) + corners[2].x_px * u) * v;
        double y = (corners[0].y_px * (1 - u) + corners[1].y_px * u) * (1 - v) +
                   (corners[3].y_px * (1 - u) + corners[2].y_px * u) * v;
        assert_int_equal(raster_at(page, x, y) < 128 ? '1' : '0', cells[row * (TAPEMARK_CELL_COLUMNS + 1) + column]);
    }
}

static void pages_show_the_vectors(void **state)
{
    static vector vectors[VECTORS];
    static int32_t ids[VECTORS];
    static hand_segment segments[VECTORS];
    static readings read;
    error_text error = {""};
    print_summary summary;
    (void)state;
    read_vectors(vectors);
    for (size_t i = 0; i < VECTORS; i++) {
        ids[i] = vectors[i].id;
        segments[i] = (hand_segment){i, 1, false};
    }
    hand_tape tape = hand_tape_new(1.5, ids, segments, VECTORS);
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    if (!print_pdf(&tape.wanted, &tape.layout, &(print_settings){.paper = PRINT_A4}, path, &summary, &error))
        fail_msg("%s", error.text);
    raster_pages pages = rasterise(path, 200);
    size_t seen = 0;
    for (size_t page = 0; page < pages.count; page++) {
        read_markers(&pages.items[page], &read);
        for (size_t i = 0; i < read.cm_count; i++, seen++) {
            assert_true(seen < VECTORS);
            assert_int_equal(read.cms[i].id, vectors[seen].id);
            assert_cells(&pages.items[page], &read.cms[i], vectors[seen].cells);
        }
    }
    assert_int_equal(seen, VECTORS);
    raster_pages_release(&pages);
    remove_folder(folder);
    hand_tape_release(&tape);
}

/* ---- The inventors' pictures --------------------------------------------------------------------------- */

typedef struct published {
    const char *file;
    int32_t ids[6];
    hand_segment segment;
} published;

static const published pictures[] = {
    {"CM15.jpg", {15}, {0, 1, false}},
    {"CM16.jpg", {16}, {0, 1, false}},
    {"CM21.jpg", {21}, {0, 1, false}},
    {"TM12_14.jpg", {12, -13, -14}, {0, 3, true}},
    {"TM22_27.jpg", {-22, -23, -24, -25, 26, -27}, {0, 6, true}},
    {"TM28_32.jpg", {28, -29, -30, -31, -32}, {0, 5, true}},
    {"TM33_38.jpg", {-33, -34, -35, -36, 37, 38}, {0, 6, true}},
    {"TM42_47.jpg", {-42, -43, -44, 45, -46, -47}, {0, 6, true}},
    {"TM48_53.jpg", {-48, -49, -50, 51, -52, 53}, {0, 6, true}},
    {"TM54_56.jpg", {-54, 55, -56}, {0, 3, true}},
    {"tape_0_5.jpg", {0, -1, -2, -3, -4, -5}, {0, 6, true}},
    {"tape_0_5.png", {0, -1, -2, -3, -4, -5}, {0, 6, true}},
    {"tape_17_20.jpg", {17, -18, -19, -19, -20}, {0, 5, true}},
    {"tape_6_11.jpg", {-6, -7, -8, -9, -10, 11}, {0, 6, true}},
    {"tape_6_11.png", {-6, -7, -8, -9, -10, 11}, {0, 6, true}},
};

/* Ours is printed at ten pixels a module. */
static raster print_alike(const published *picture)
{
    error_text error = {""};
    print_summary summary;
    static char names[4][64];
    const print_settings settings = {.dpi = 254, .without_labels = true};
    hand_tape tape = hand_tape_new(1, picture->ids, &picture->segment, 1);
    const char *folder = new_folder();
    if (!print_pictures(&tape.wanted, &tape.layout, &settings, PRINT_PNG, folder, &summary, &error))
        fail_msg("%s", error.text);
    assert_int_equal(list_folder(folder, names, COUNT_OF(names)), 1);
    raster printed = raster_read(path_in(folder, names[0]), settings.dpi);
    remove_folder(folder);
    hand_tape_release(&tape);
    return printed;
}

/* At the middle of each module, quiet zone included: theirs has modules of about 26 px. */
static void pictures_are_as_published(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(pictures); i++) {
        char path[600];
        snprintf(path, sizeof path, "%s/markers/%s", data_folder(), pictures[i].file);
        raster theirs = raster_read(path, 0), ours = print_alike(&pictures[i]);
        int32_t width = ours.width_px / 10;
        assert_int_equal(ours.height_px, 90);
        for (int32_t module = 0; module < 9 * width; module++) {
            double u = (module % width + 0.5) / width, v = (module / width + 0.5) / 9;
            bool dark_theirs = raster_at(&theirs, u * theirs.width_px, v * theirs.height_px) < 128;
            bool dark_ours = raster_at(&ours, u * ours.width_px - 0.5, v * ours.height_px - 0.5) < 128;
            if (dark_theirs != dark_ours)
                fail_msg("%s: module %d in row %d", pictures[i].file, (int)(module % width), (int)(module / width));
        }
        raster_release(&theirs);
        raster_release(&ours);
    }
}

int main(void)
{
    struct stat status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pages_show_the_vectors),
        cmocka_unit_test(pictures_are_as_published),
    };
    if (stat(data_folder(), &status) != 0) {
        const char *required = getenv("TAPEMARK_REQUIRE_PAPER_DATA");
        printf("there is no %s (set TAPEMARK_PAPER_DATA to the folder of the paper's data)\n", data_folder());
        return required != NULL && strcmp(required, "1") == 0 ? EXIT_FAILURE : EXIT_SKIPPED;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
