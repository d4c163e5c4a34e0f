/* Things beside, on and over tapes that look like tapes: mirrors, other codes, tapes that cross, tapes pieced
 * together, tapes of other plans, tapes on screens. What is read is there, and where it is there. */
#include "printed.h"

#include <math.h>

static const int32_t ids[] = {22, 23, -24, 25, -26, 27};
enum { IDS = 6, BARED = 25 * IDS + 23, HEIGHT = TAPEMARK_HEIGHT_MODULES };

static bool is_among(int32_t id, const int32_t *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (list[i] == id)
            return true;
    return false;
}

/* Only these; returns how many. */
static size_t assert_only(const decoding *got, const int32_t *list, size_t count)
{
    for (size_t i = 0; i < got->result.cm_count; i++)
        if (!is_among(got->cms[i].id, list, count))
            fail_msg("%s: id %d was read, confidence %.2f, %u cells corrected", got->name, (int)got->cms[i].id,
                     (double)got->cms[i].confidence, got->cms[i].corrected_cells);
    return got->result.cm_count;
}

static double middle_y(const tapemark_point corners[4])
{
    return 0.25 * (double)(corners[0].y_px + corners[1].y_px + corners[2].y_px + corners[3].y_px);
}

/* ---- Mirrors ----------------------------------------------------------------------------------------------- */

static const double sizes_px[] = {0.8, 1.2, 1.7, 3, 5};

/* In a window, or from behind a glass door: left is right. */
static void a_mirrored_tape_has_no_ids(void **state)
{
    (void)state;
    static printed print;
    print_nothing(&print, BARED + 4, HEIGHT + 2);
    print_segment(&print, 2, 1, ids, IDS, true);
    print_mirror_columns(&print);
    for (size_t s = 0; s < COUNT_OF(sizes_px); s++)
        for (int roll_deg = 0; roll_deg < 360; roll_deg += 60) {
            const scene_pose pose = {.px_per_module = sizes_px[s], .roll_deg = roll_deg};
            const decoding *got = decode_print(&print, pose, NULL, "mirrored");
            assert_only(got, NULL, 0);
            if (got->result.tm_count > 0)
                fail_msg("%s: the mirrored tape was read as a TM %s%s", got->name, got->tms[0].code,
                         got->tms[0].directed ? "" : ", without direction");
        }
}

/* A glossy floor: the tape on the baseboard, and below it the same upside down, paler. */
static void print_floor(printed *print, int gap, int pale)
{
    static printed mirrored;
    print_nothing(&mirrored, BARED + 4, HEIGHT + 2);
    print_segment(&mirrored, 2, 1, ids, IDS, true);
    print_mirror_rows(&mirrored);
    print_nothing(print, BARED + 4, 2 * HEIGHT + 4 + gap);
    print_segment(print, 2, 1, ids, IDS, true);
    print_copy(print, 0, HEIGHT + 2 + gap, &mirrored, 0, 0, BARED + 4, HEIGHT + 2);
    for (int i = (HEIGHT + 2 + gap) * print->columns; i < print->rows * print->columns; i++)
        print->shades[i] = (uint8_t)(print->shades[i] == INK ? INK + pale : PAPER - pale / 4);
}

static void assert_all_above(const decoding *got, double y_px)
{
    for (size_t i = 0; i < got->result.cm_count; i++)
        assert_true(middle_y(got->cms[i].corners) < y_px);
    for (size_t i = 0; i < got->result.tm_count; i++)
        if (middle_y(got->tms[i].corners) >= y_px)
            fail_msg("%s: the reflection was read as a TM %s", got->name, got->tms[i].code);
}

static void a_reflection_on_the_floor_is_no_second_tape(void **state)
{
    (void)state;
    static printed print;
    for (int gap = 0; gap <= 6; gap += 3)
        for (int pale = 0; pale <= 120; pale += 60)
            for (size_t s = 0; s < COUNT_OF(sizes_px); s++) {
                print_floor(&print, gap, pale);
                const decoding *got = decode_print(&print, (scene_pose){.px_per_module = sizes_px[s]}, NULL, "floor");
                if (assert_only(got, ids, IDS) < IDS && sizes_px[s] > 1.5)
                    fail_msg("%s: %u CMs of the tape were read", got->name, (unsigned)got->result.cm_count);
                assert_all_above(got, (0.5 * print.rows + 4) * sizes_px[s]);
            }
}

/* ---- Without rings ------------------------------------------------------------------------------------------- */

/* As much ink as a finder pattern has, spread evenly. */
static void print_gray_square(printed *print, int column, int row)
{
    enum { DARK = 24 + 9, ALL = HEIGHT * HEIGHT };
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < HEIGHT; x++)
            print->shades[(row + y) * print->columns + column + x] = (uint8_t)(PAPER - (PAPER - INK) * DARK / ALL);
}

/* From afar such a row is as light and dark as a tape; but where rings could be seen, there are none. */
static void gray_squares_in_a_row_are_no_tape(void **state)
{
    (void)state;
    static const double far_px[] = {0.75, 0.85, 0.95, 1.1, 1.3};
    static printed print;
    print_nothing(&print, BARED + 4, HEIGHT + 2);
    print_segment(&print, 2, 1, ids, IDS, true);
    for (int i = 0; i <= IDS; i++)
        print_gray_square(&print, 2 + TAPEMARK_BAR_MODULES + TAPEMARK_CM_PITCH_MODULES * i, 1);
    for (size_t s = 0; s < COUNT_OF(far_px); s++)
        for (int roll_deg = 0; roll_deg < 360; roll_deg += 45)
            assert_no_marker(decode_print(
                &print, (scene_pose){.px_per_module = far_px[s], .roll_deg = roll_deg}, NULL, "gray squares"));
}

/* ---- Other things beside a tape ---------------------------------------------------------------------------- */

/* A square code of 25 modules with three finder patterns. */
static void print_square_code(printed *print, int column, int row, random_source *source)
{
    enum { SIDE = 25, FAR = SIDE - 7 };
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int fx = x > SIDE / 2 ? x - FAR : x, fy = y > SIDE / 2 ? y - FAR : y;
            const bool corner = !(x > SIDE / 2 && y > SIDE / 2);
            const int dx = abs(fx - 3), dy = abs(fy - 3), ring = dx > dy ? dx : dy;
            const bool dark = corner && ring <= 4 ? ring <= 1 || ring == 3 : random_below(source, 2);
            print_module(print, column + x, row + y, dark);
        }
}

/* So near and so far that its finder patterns come to lie a CM's length from the tape's, too. */
static void square_codes_beside_a_tape_add_nothing(void **state)
{
    (void)state;
    static printed print;
    random_source source = {41};
    for (int gap = 1; gap <= 26; gap += 1)
        for (int bars = 0; bars < 2; bars++) {
            const int width = (int)tapemark_segment_width_modules(3, bars);
            print_nothing(&print, width + gap + 27, 60);
            print_segment(&print, 1, 20, ids, 3, bars);
            print_square_code(&print, 1 + width + gap, gap % 3 * 9 + 2, &source);
            print_square_code(&print, gap, 30, &source);
            const decoding *got = decode_print(
                &print, (scene_pose){.px_per_module = 2.5, .roll_deg = gap % 2 ? 180 : 0}, NULL, "square codes");
            assert_int_equal(assert_only(got, ids, 3), 3);
            for (size_t i = 0; i < got->result.tm_count; i++)
                assert_string_equal(got->tms[i].code, "110");
        }
}

/* ---- Tapes and tapes ---------------------------------------------------------------------------------------- */

/* One over the other, at each angle and place. */
static void crossing_tapes_are_not_mixed(void **state)
{
    (void)state;
    static const int32_t over_ids[] = {-142, 143, 144, -145};
    size_t read = 0;
    for (int angle_deg = 20; angle_deg <= 160; angle_deg += 20)
        for (int shift = -60; shift <= 60; shift += 15) {
            scene view = scene_default(620, 620);
            scene_tape tapes[2] = {scene_tape_of(ids, IDS, true), scene_tape_of(over_ids, 4, true)};
            scene_place(&view, &tapes[0], (scene_pose){.px_per_module = 3, .roll_deg = 5});
            scene_place(&view, &tapes[1], (scene_pose){.px_per_module = 3, .roll_deg = angle_deg, .dx_px = shift});
            view.tapes = tapes;
            view.tape_count = 2;
            const decoding *got =
                decode_scene(&view, NULL, "crossing at %d degrees, shifted by %d", angle_deg, shift);
            assert_nothing_wrong(got, &view);
            read += count_read(got);
        }
    assert_true(read > 8 * 9 * 6);
}

/* A tape cut at `cut` modules and joined with the rest of another, some modules missing in between. */
static void joined_tapes_read_what_is_whole(void **state)
{
    (void)state;
    static const int32_t other_ids[] = {322, -323, -324, 325, 326, 327};
    static printed print, first, second;
    print_nothing(&first, BARED, HEIGHT);
    print_segment(&first, 0, 0, ids, IDS, true);
    print_nothing(&second, BARED, HEIGHT);
    print_segment(&second, 0, 0, other_ids, IDS, true);
    for (int cut = 40; cut <= 130; cut += 3)
        for (int missing = -4; missing <= 4; missing += 2) {
            print_nothing(&print, BARED - missing, HEIGHT);
            print_copy(&print, 0, 0, &first, 0, 0, cut, HEIGHT);
            print_copy(&print, cut, 0, &second, cut + missing, 0, BARED, HEIGHT);
            const double px = cut % 2 ? 2 : 3.5;
            const decoding *got = decode_print(&print, (scene_pose){.px_per_module = px}, NULL, "joined");
            for (size_t i = 0; i < got->result.cm_count; i++) {
                const tapemark_cm *cm = &got->cms[i];
                const double centre_px = 0.5 * (double)(cm->corners[0].x_px + cm->corners[1].x_px);
                const double at = (centre_px + 0.5) / px - 4; /* modules from the print's left edge */
                const bool is_first = at < cut;
                const int slot = (int)floor((is_first ? at : at + missing) - 8) / TAPEMARK_CM_PITCH_MODULES;
                const int32_t there = slot < 0 || slot >= IDS ? 0 : is_first ? ids[slot] : other_ids[slot];
                if (cm->id != there)
                    fail_msg("%s at %d, %d missing: id %d was read where %d is, confidence %.2f, %u cells corrected",
                             got->name, cut, missing, (int)cm->id, (int)there, (double)cm->confidence,
                             cm->corrected_cells);
            }
        }
}

/* Codes are few, so that tapes of another plan have those of ours: they hang nowhere on our map. */
static void expect_no_place(const decoding *got)
{
    static const tapemark_map_cm stands_alone = {.tm = -1, .slot = -1};
    static const int32_t own_id = 400;
    for (size_t i = 0; i < got->result.tm_count; i++) {
        const tapemark_tm *tm = &got->tms[i];
        tapemark_map_tm own = {.length = tm->length};
        for (const char *bit = tm->code; *bit; bit++)
            own.code = own.code << 1 | (*bit == '1');
        const tapemark_map map = {.ids = &own_id, .cms = &stands_alone, .cm_count = 1, .tms = &own, .tm_count = 1};
        tapemark_tm_place place;
        assert_int_equal(tapemark_map_check(&map, NULL), TAPEMARK_OK);
        assert_int_equal(tapemark_map_locate_tm(&map, &got->result, i, &place), TAPEMARK_NOTHING_FOUND);
        assert_int_equal(place.agreement, TAPEMARK_CM_UNKNOWN);
    }
}

/* With the map of our plan, the tapes of another one say nothing, and it is told that there are some. */
static void tapes_of_another_plan_are_flagged(void **state)
{
    (void)state;
    static int32_t known[200];
    for (int i = 0; i < 200; i++)
        known[i] = i + 400;
    for (size_t s = 0; s < COUNT_OF(sizes_px); s++)
        for (int32_t first = 12; first < 4000; first += first < 398 ? 17 : 371) {
            int32_t other[IDS];
            const tapemark_config config = {.known_ids = known, .known_id_count = COUNT_OF(known)};
            for (int32_t i = 0; i < IDS; i++)
                other[i] = (first + i) % 2 ? -(first + i) : (first >= 394 ? 600 : 0) + first + i;
            one_tape all = place_tape(scene_default((int32_t)(190 * sizes_px[s]), 120), other, IDS, true,
                                      (scene_pose){.px_per_module = sizes_px[s], .roll_deg = 3});
            const decoding *got = decode_tape(&all, &config, "another plan");
            if (got->result.cm_count > 0)
                fail_msg("%s from %d on: id %d was read", got->name, (int)first, (int)got->cms[0].id);
            if (sizes_px[s] > 1.5) {
                assert_true(got->result.stats.rejects[TAPEMARK_REJECT_UNKNOWN_ID] > 0);
                expect_no_place(got);
            }
        }
}

/* ---- On a screen --------------------------------------------------------------------------------------------- */

/* A tape shown by a screen whose pixels are dark at their edges, of which a module takes this many: what the camera's
 * pixels make of that is a moire that changes with the size. */
static void a_tape_on_a_screen_reads_right(void **state)
{
    (void)state;
    enum { CELL = 4, CMS = 3, PX_PER_MODULE = 4, COLUMNS = (25 * CMS + 27) * CELL * PX_PER_MODULE,
           ROWS = (HEIGHT + 2) * CELL * PX_PER_MODULE };
    static printed print;
    static uint8_t texels[COLUMNS * ROWS];
    print_nothing(&print, 25 * CMS + 27, HEIGHT + 2);
    print_segment(&print, 2, 1, ids, CMS, true);
    for (int y = 0; y < ROWS; y++)
        for (int x = 0; x < COLUMNS; x++) {
            const int row = y / (CELL * PX_PER_MODULE), column = x / (CELL * PX_PER_MODULE);
            const uint8_t shade = print.shades[row * print.columns + column];
            texels[y * COLUMNS + x] = x % CELL == 0 || y % CELL == 0 ? 10 : shade;
        }
    size_t read = 0, possible = 0;
    for (double px = 1.5; px < 7; px *= 1.13)
        for (int roll_deg = 0; roll_deg <= 9; roll_deg += 3) {
            scene view = scene_default((int32_t)(108 * px) + 20, (int32_t)(40 * px));
            scene_picture picture = scene_picture_of(texels, COLUMNS, ROWS, 0.09);
            picture.module_m = 0.01;
            picture.border_m = 0.05;
            picture.border_shade = 30;
            scene_place_picture(&view, &picture, (scene_pose){.px_per_module = px, .roll_deg = roll_deg});
            view.pictures = &picture;
            view.picture_count = 1;
            const decoding *got = decode_scene(&view, NULL, "screen at %.2f px a module, roll %d", px, roll_deg);
            read += assert_only(got, ids, CMS);
            possible += CMS;
            for (size_t i = 0; i < got->result.tm_count; i++)
                assert_string_equal(got->tms[i].code, "110");
        }
    if (2 * read < possible)
        fail_msg("%u of %u CMs on screens were read", (unsigned)read, (unsigned)possible);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirrored_tape_has_no_ids),
        cmocka_unit_test(a_reflection_on_the_floor_is_no_second_tape),
        cmocka_unit_test(gray_squares_in_a_row_are_no_tape),
        cmocka_unit_test(square_codes_beside_a_tape_add_nothing),
        cmocka_unit_test(crossing_tapes_are_not_mixed),
        cmocka_unit_test(joined_tapes_read_what_is_whole),
        cmocka_unit_test(tapes_of_another_plan_are_flagged),
        cmocka_unit_test(a_tape_on_a_screen_reads_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
