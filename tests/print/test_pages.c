/* Pages of a PDF, as pdftoppm shows them: all of the tape can be read, is as long as it should be, and nothing is
 * where it should not be. */
#include "printing.h"

#include <math.h>

static const unsigned codes[] = {32, 16, 8, 48, 40, 36, 34, 56, 52, 50};

static print_summary print_to(const hand_tape *tape, const print_settings *settings, const char *path)
{
    error_text error = {""};
    print_summary summary = {0};
    if (!print_pdf(&tape->wanted, &tape->layout, settings, path, &summary, &error))
        fail_msg("%s", error.text);
    return summary;
}

static raster_pages print_and_rasterise(const hand_tape *tape, const print_settings *settings, int dpi,
                                        print_summary *summary)
{
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    *summary = print_to(tape, settings, path);
    raster_pages pages = rasterise(path, dpi);
    remove_folder(folder);
    assert_int_equal(pages.count, summary->pages);
    return pages;
}

/* ---- Measuring ----------------------------------------------------------------------------------------- */

/* Where a row of pixels turns from light to dark, or back, next to x: to a part of a pixel. */
static double edge_near(const raster *page, double x_px, double y_px, double direction)
{
    double x = x_px - 3 * direction, light = 0;
    for (int i = 0; i < 7; i++)
        light += raster_at(page, round(x) + i * direction, y_px) / 255;
    return round(x) + direction * (light - 0.5);
}

/* Length of a TM's ink along its middle. */
static double measured_length_mm(const raster *page, const tapemark_point corners[4])
{
    double y_px = round((double)(corners[0].y_px + corners[1].y_px + corners[2].y_px + corners[3].y_px) / 4);
    double left = edge_near(page, ((double)corners[0].x_px + (double)corners[3].x_px) / 2, y_px, 1);
    double right = edge_near(page, ((double)corners[1].x_px + (double)corners[2].x_px) / 2, y_px, -1);
    return (right - left) / page->px_per_mm;
}

/* The longest dark run in the lowest 20 mm of a page. */
static double ruler_length_mm(const raster *page)
{
    int32_t longest = 0;
    for (int32_t y = page->height_px - (int32_t)(20 * page->px_per_mm); y < page->height_px; y++) {
        for (int32_t x = 0, run = 0; x < page->width_px; x++) {
            run = page->pixels[(size_t)y * (size_t)page->width_px + (size_t)x] < 200 ? run + 1 : 0;
            longest = run > longest ? run : longest;
        }
    }
    return longest / page->px_per_mm;
}

static void assert_white_margins(const raster *page, double margin_mm)
{
    /* Pixels on the edge of the margin show a part of what begins there. */
    int32_t margin = (int32_t)(margin_mm * page->px_per_mm) - 1;
    for (int32_t y = 0; y < page->height_px; y++) {
        for (int32_t x = 0; x < page->width_px; x++) {
            bool inside = x >= margin && y >= margin && x < page->width_px - margin && y < page->height_px - margin;
            if (!inside)
                assert_int_equal(page->pixels[(size_t)y * (size_t)page->width_px + (size_t)x], 255);
        }
    }
}

/* ---- Sheets -------------------------------------------------------------------------------------------- */

typedef struct sheet {
    print_paper paper;
    double width_mm, height_mm;
} sheet;

/* Whole TMs fit on each kind of sheet: each is read there, in order, with its grid and quiet zone. */
static void sheets_are_read_completely(void **state)
{
    static const sheet sheets[] = {{PRINT_A4, 297, 210}, {PRINT_A3, 420, 297}, {PRINT_LETTER, 279.4, 215.9}};
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_of_tms(1.25, 100, codes, COUNT_OF(codes), true);
    for (size_t i = 0; i < COUNT_OF(sheets); i++) {
        const print_settings settings = {.paper = sheets[i].paper};
        print_summary summary;
        raster_pages pages = print_and_rasterise(&tape, &settings, 300, &summary);
        size_t segment = 0;
        for (size_t page = 0; page < pages.count; page++) {
            raster *seen = &pages.items[page];
            assert_near(seen->width_px / seen->px_per_mm, sheets[i].width_mm, 0.1);
            assert_near(seen->height_px / seen->px_per_mm, sheets[i].height_mm, 0.1);
            assert_white_margins(seen, 10);
            assert_near(ruler_length_mm(seen), 100.1, 0.1);
            read_markers(seen, &read);
            size_t next_cm = 0, next_tm = 0;
            while (next_tm < read.tm_count) {
                assert_reads_segment(&tape, segment, &read, &next_cm, &next_tm);
                const tapemark_point *corners = read.tms[next_tm - 1].corners;
                assert_modules(seen, tape.layout.ids + 6 * segment, 6, true, corners);
                assert_near(measured_length_mm(seen, corners), 173 * 1.25, 0.1);
                segment++;
            }
            assert_int_equal(next_cm, read.cm_count);
        }
        assert_int_equal(segment, COUNT_OF(codes));
        raster_pages_release(&pages);
    }
    hand_tape_release(&tape);
}

/* The widest margins, and lengths stretched: still nothing in the margins, and all is there. */
static void narrow_pages_keep_their_margins(void **state)
{
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_of_tms(0.8, 0, codes, 3, true);
    const print_settings settings = {.paper = PRINT_LETTER, .margin_mm = 25, .scale_x = 1.1, .scale_y = 1.1};
    print_summary summary;
    raster_pages pages = print_and_rasterise(&tape, &settings, 300, &summary);
    assert_int_equal(pages.count, 1);
    assert_white_margins(&pages.items[0], 25);
    read_markers(&pages.items[0], &read);
    assert_reads_all(&tape, &read);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

/* Two rows a page of the paper's tape height, and no more pieces than the longest one allows. */
static void tiles_are_as_few_as_can_be(void **state)
{
    (void)state;
    hand_tape tape = hand_tape_of_tms(60.0 / 7, 0, codes, 4, false);
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    print_summary summary = print_to(&tape, &(print_settings){.paper = PRINT_A4}, path);
    /* 708 modules, and 31 of them fit on a sheet; but joints lie 17 and 8 apart, so that it is 25 a piece and seven
     * pieces a TM. What is left at the end of one does not fit onto the others. */
    assert_int_equal(summary.pieces, 29);
    assert_int_equal(summary.joints, summary.pieces - 1);
    assert_int_equal(summary.pages, (summary.pieces + 1) / 2);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void a_module_too_large_names_the_largest(void **state)
{
    static const print_paper papers[] = {PRINT_A4, PRINT_A3, PRINT_LETTER};
    (void)state;
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    for (size_t i = 0; i < COUNT_OF(papers); i++) {
        const print_settings settings = {.paper = papers[i]};
        hand_tape tape = hand_tape_of_tms(40, 0, codes, 1, false);
        error_text error = {""};
        print_summary summary;
        double largest_mm = 0;
        char largest[32];
        assert_false(print_pdf(&tape.wanted, &tape.layout, &settings, path, &summary, &error));
        assert_int_equal(access(path, F_OK), -1);
        const char *at_most = strstr(error.text, "at most ");
        assert_non_null(at_most);
        assert_int_equal(sscanf(at_most, "at most %31[0-9.]", largest), 1);
        largest_mm = atof(largest);
        tape.wanted.module_mm = largest_mm;
        print_to(&tape, &settings, path);
        unlink(path);
        tape.wanted.module_mm = largest_mm + 0.02;
        assert_false(print_pdf(&tape.wanted, &tape.layout, &settings, path, &summary, &error));
        hand_tape_release(&tape);
    }
    remove_folder(folder);
}

/* ---- Rolls --------------------------------------------------------------------------------------------- */

static void two_metres_of_roll(void **state)
{
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_of_tms(1.85, 0, codes, 6, false);
    print_summary summary;
    raster_pages pages = print_and_rasterise(&tape, &(print_settings){.paper = PRINT_ROLL}, 300, &summary);
    assert_int_equal(pages.count, 1);
    assert_int_equal(summary.joints, 0);
    raster *roll = &pages.items[0];
    assert_white_margins(roll, 3);
    assert_near(ruler_length_mm(roll), 100.1, 0.1);
    read_markers(roll, &read);
    assert_reads_all(&tape, &read);
    for (size_t i = 0; i < read.tm_count; i++)
        assert_modules(roll, tape.layout.ids + 6 * i, 6, true, read.tms[i].corners);
    /* From the first bar of the first TM to the last bar of the last one. */
    const tapemark_point *first = read.tms[0].corners, *last = read.tms[5].corners;
    const tapemark_point whole[4] = {first[0], last[1], last[2], first[3]};
    assert_near(measured_length_mm(roll, whole), (6 * 177 - 4) * 1.85, 0.1);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

/* Longer than a page of a PDF can be: cut where TMs meet, so that each page has whole ones. */
static void long_rolls_are_cut_between_segments(void **state)
{
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_of_tms(9.352, 0, codes, 5, false);
    print_summary summary;
    raster_pages pages = print_and_rasterise(&tape, &(print_settings){.paper = PRINT_ROLL}, 60, &summary);
    assert_int_equal(pages.count, 2);
    assert_int_equal(summary.joints, 1);
    size_t segment = 0;
    for (size_t page = 0; page < pages.count; page++) {
        assert_true(pages.items[page].width_px / pages.items[page].px_per_mm <= 5080.5);
        read_markers(&pages.items[page], &read);
        size_t next_cm = 0, next_tm = 0;
        while (next_tm < read.tm_count)
            assert_reads_segment(&tape, segment++, &read, &next_cm, &next_tm);
        assert_int_equal(next_cm, read.cm_count);
    }
    assert_int_equal(segment, 5);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

/* A printer that makes 100 mm of 101: with 100 / 101, what was asked for comes out. */
static void a_scale_correction_stretches_all(void **state)
{
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_of_tms(1, 0, codes, 3, false);
    const print_settings settings = {.paper = PRINT_ROLL, .scale_x = 0.97, .scale_y = 1.05};
    print_summary summary;
    raster_pages pages = print_and_rasterise(&tape, &settings, 300, &summary);
    assert_int_equal(pages.count, 1);
    assert_white_margins(&pages.items[0], 3);
    assert_near(ruler_length_mm(&pages.items[0]), 97.1, 0.1);
    read_markers(&pages.items[0], &read);
    assert_reads_all(&tape, &read);
    const tapemark_point *corners = read.tms[1].corners;
    assert_near(measured_length_mm(&pages.items[0], corners), 173 * 0.97, 0.1);
    double height_px = (double)(corners[3].y_px - corners[0].y_px);
    assert_near(height_px / pages.items[0].px_per_mm, 7 * 1.05, 0.1);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

/* ---- Pieces to mend with ------------------------------------------------------------------------------- */

/* Of each kind: from within a TM, from its end, alone, and from two segments at once. */
static void only_prints_what_is_named(void **state)
{
    static const int32_t ids[] = {-1, 2, -3, 4, -5, 6, 7};
    static const hand_segment segments[] = {{0, 4, true}, {0, 1, false}, {1, 1, false}, {1, 1, false}};
    static const print_id_range only[] = {{2, 3}, {4, 5}, {7, 7}};
    static readings read;
    (void)state;
    hand_tape tape = hand_tape_new(1.5, ids, segments, COUNT_OF(segments));
    const print_settings settings = {.paper = PRINT_A3, .only = only, .only_count = COUNT_OF(only)};
    print_summary summary;
    raster_pages pages = print_and_rasterise(&tape, &settings, 300, &summary);
    assert_int_equal(pages.count, 1);
    assert_int_equal(summary.pieces, 2);
    assert_int_equal(summary.joints, 0);
    read_markers(&pages.items[0], &read);
    assert_int_equal(read.cm_count, 5);
    static const int32_t expected[] = {2, -3, 4, -5, 7};
    for (size_t i = 0; i < COUNT_OF(expected); i++)
        assert_int_equal(read.cms[i].id, expected[i]);
    /* The bars that end the TM are there, those that begin it are not. */
    assert_int_equal(read.tm_count, 0);
    double module_px = ((double)read.cms[2].corners[1].x_px - (double)read.cms[2].corners[0].x_px) / 32;
    double y_px = (double)read.cms[2].corners[0].y_px + 3.5 * module_px;
    for (int bar = 0; bar < 4; bar++) {
        double after_px = (double)read.cms[2].corners[1].x_px + (1.5 + 2 * bar) * module_px;
        double before_px = (double)read.cms[0].corners[0].x_px - (1.5 + 2 * bar) * module_px;
        assert_true(raster_at(&pages.items[0], after_px, y_px) < 50);
        assert_true(raster_at(&pages.items[0], before_px, y_px) > 240);
    }
    assert_modules(&pages.items[0], expected + 4, 1, false, read.cms[4].corners);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

static void only_what_is_not_there_is_an_error(void **state)
{
    static const print_id_range only = {100, 200};
    (void)state;
    hand_tape tape = hand_tape_of_tms(1, 0, codes, 3, false);
    const print_settings settings = {.only = &only, .only_count = 1};
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    error_text error = {""};
    print_summary summary;
    assert_false(print_pdf(&tape.wanted, &tape.layout, &settings, path, &summary, &error));
    assert_string_not_equal(error.text, "");
    assert_int_equal(list_folder(folder, NULL, 0), 0);
    remove_folder(folder);
    hand_tape_release(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sheets_are_read_completely),
        cmocka_unit_test(narrow_pages_keep_their_margins),
        cmocka_unit_test(tiles_are_as_few_as_can_be),
        cmocka_unit_test(a_module_too_large_names_the_largest),
        cmocka_unit_test(two_metres_of_roll),
        cmocka_unit_test(long_rolls_are_cut_between_segments),
        cmocka_unit_test(a_scale_correction_stretches_all),
        cmocka_unit_test(only_prints_what_is_named),
        cmocka_unit_test(only_what_is_not_there_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
