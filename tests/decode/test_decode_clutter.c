/* Pictures without a marker: nothing is read, nothing breaks, and the work stays within its bounds. */
#include "decoding.h"

#include "random.h"

/* What was begun within the budget may be brought to its end; each CM that was read adds to it, and so may some
 * finder patterns. */
enum { SLACK_READS = 40000, READS_PER_CM = 2500, READS_OF_FINDERS = 20 * 1500 };

static void assert_work_bounded(const decoding *got, uint32_t budget)
{
    const tapemark_result *result = &got->result;
    if (result->stats.work > budget + SLACK_READS + READS_PER_CM * result->cm_count + READS_OF_FINDERS)
        fail_msg("%s: %u reads with a budget of %u and %u CMs read", got->name, (unsigned)result->stats.work,
                 (unsigned)budget, (unsigned)result->cm_count);
}

static void assert_nothing_and_bounded(const decoding *got, uint32_t budget)
{
    assert_no_marker(got);
    assert_work_bounded(got, budget);
}

/* ---- Rendered clutter -------------------------------------------------------------------------------------- */

/* Each kind in sizes from a pixel up, as a good camera sees it; `seen` counts pictures in which there was something
 * for the decoder to look at. */
static void find_nothing_in(scene_clutter kind, int32_t width_px, int32_t height_px, unsigned *limited)
{
    static const double scales_px[] = {1, 1.7, 3, 5, 9, 20};
    for (size_t i = 0; i < COUNT_OF(scales_px); i++)
        for (int angle_deg = 0; angle_deg <= 30; angle_deg += 15) {
            scene view = scene_default(width_px, height_px);
            view.background = (scene_background){.kind = kind, .light = 230, .dark = 40, .scale_px = scales_px[i],
                                                 .angle_deg = angle_deg, .room = {3, 1}};
            view.seed = i + 1;
            const decoding *got = decode_scene(&view, NULL, "clutter %d of %g px, %d degrees", (int)kind,
                                               scales_px[i], angle_deg);
            assert_nothing_and_bounded(got, tapemark_default_work_budget(width_px, height_px));
            *limited += got->result.stats.limits != 0;
        }
}

static void finds_nothing_in_clutter(void **state)
{
    (void)state;
    unsigned limited = 0;
    for (int kind = SCENE_PLAIN; kind < SCENE_CLUTTER_COUNT; kind++)
        find_nothing_in((scene_clutter)kind, 256, 192, &limited);
    assert_true(limited > 0); /* some of it was too much to look at all of it */
}

static void a_small_budget_bounds_the_work_on_clutter(void **state)
{
    (void)state;
    static const uint32_t budgets[] = {1, 1000, 20000};
    for (int kind = SCENE_NOISE; kind < SCENE_ROOM; kind++)
        for (size_t i = 0; i < COUNT_OF(budgets); i++) {
            scene view = scene_default(640, 480);
            view.background = (scene_background){.kind = (scene_clutter)kind, .light = 230, .dark = 40,
                                                 .scale_px = 3, .angle_deg = 5};
            const tapemark_config config = {.work_budget = budgets[i]};
            assert_nothing_and_bounded(decode_scene(&view, &config, "clutter %d", kind), budgets[i]);
        }
}

/* Sheets full of tapes, more than can be looked at: part of them is read, and what is read is right. */
static void a_sheet_of_tapes_stays_within_bounds(void **state)
{
    (void)state;
    enum { ROWS_MAX = 40, CMS = 5 };
    static const struct {
        double px_per_module, pitch_px;
    } sheets[] = {{1.7, 17}, {2.5, 33}, {3, 27.6}, {3, 50}};
    static int32_t ids[ROWS_MAX][CMS];
    static scene_tape tapes[ROWS_MAX];
    for (size_t i = 0; i < COUNT_OF(sheets); i++) {
        const int rows = (int)(610 / sheets[i].pitch_px);
        scene view = scene_default(640, 640);
        for (int row = 0; row < rows; row++) {
            ids_for_code("10110", CMS * row + 1, ids[row]);
            tapes[row] = scene_tape_of(ids[row], CMS, true);
            scene_place(&view, &tapes[row], (scene_pose){.px_per_module = sheets[i].px_per_module,
                                                         .dy_px = sheets[i].pitch_px * (row - 0.5 * (rows - 1))});
        }
        view.tapes = tapes;
        view.tape_count = (size_t)rows;
        const decoding *got = decode_scene(&view, NULL, "sheet of %d tapes", rows);
        assert_nothing_wrong(got, &view);
        assert_work_bounded(got, tapemark_default_work_budget(640, 640));
        if (count_read(got) < 2 * CMS)
            fail_msg("%s: %u of %u CMs were read", got->name, (unsigned)count_read(got),
                     (unsigned)got->truth.cm_count);
    }
}

/* ---- Plain gray values -------------------------------------------------------------------------------------- */

static void find_nothing_in_pixels(const uint8_t *pixels, int32_t width_px, int32_t height_px)
{
    for (int polarity = 0; polarity < 2; polarity++) {
        const tapemark_config config = {.polarity = (tapemark_polarity)polarity, .contrast_min = 1};
        assert_nothing_and_bounded(decode_pixels(pixels, width_px, height_px, &config),
                                   tapemark_default_work_budget(width_px, height_px));
    }
}

static void finds_nothing_in_noise(void **state)
{
    (void)state;
    enum { SIDE = 200 };
    static uint8_t pixels[SIDE * SIDE];
    for (uint64_t seed = 1; seed <= 40; seed++) {
        random_source source = {seed};
        const bool binary = seed % 2;
        for (size_t i = 0; i < sizeof pixels; i++) {
            const uint8_t value = (uint8_t)(random_bits(&source) >> 32);
            pixels[i] = binary ? (uint8_t)(value < 128 ? 20 : 230) : value;
        }
        find_nothing_in_pixels(pixels, SIDE, SIDE);
    }
}

/* What a camera sends of a blank wall: that nothing is there, and not that it was too much to look at. */
static void sensor_noise_on_a_blank_wall_is_nothing(void **state)
{
    (void)state;
    enum { WIDTH = 640, HEIGHT = 480 };
    static uint8_t pixels[WIDTH * HEIGHT];
    static const double deviations[] = {0.5, 0.7, 0.85, 1, 1.5, 2, 3};
    for (size_t s = 0; s < COUNT_OF(deviations); s++) {
        random_source source = {s + 1};
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = (uint8_t)(130.5 + deviations[s] * (double)random_normal(&source));
        const decoding *got = decode_pixels(pixels, WIDTH, HEIGHT, NULL);
        if (got->status != TAPEMARK_NOTHING_FOUND || got->result.stats.limits != 0)
            fail_msg("noise of %g: %s, limits %x", deviations[s], tapemark_status_text(got->status),
                     (unsigned)got->result.stats.limits);
    }
}

/* Noise that the blank wall's bound does not tell, for there is too much of it, is known beside a print. */
static void noise_beside_something_of_contrast_is_left_alone(void **state)
{
    (void)state;
    enum { SIDE = 400 };
    static uint8_t pixels[SIDE * SIDE];
    uint32_t tried[2];
    for (int with_square = 0; with_square < 2; with_square++) {
        random_source source = {7};
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = (uint8_t)(105.5f + (with_square ? 3.6f : 6) * random_normal(&source));
        for (int y = 0; with_square && y < 40; y++)
            memset(pixels + y * SIDE, y < 20 ? 0 : 255, 40);
        const decoding *got = decode_pixels(pixels, SIDE, SIDE, NULL);
        assert_no_marker(got);
        tried[with_square] = got->result.stats.finders_tried;
    }
    if (!(tried[0] > 20 && 4 * tried[1] < tried[0]))
        fail_msg("%u places were tried in noise, %u with a square beside it", (unsigned)tried[0], (unsigned)tried[1]);
}

static void finds_nothing_in_checkerboards(void **state)
{
    (void)state;
    enum { WIDTH = 230, HEIGHT = 170 };
    static uint8_t pixels[WIDTH * HEIGHT];
    for (int square = 1; square <= 32; square++) {
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH; x++)
                pixels[y * WIDTH + x] = (x / square + y / square) % 2 ? 255 : 0;
        find_nothing_in_pixels(pixels, WIDTH, HEIGHT);
    }
}

static void finds_nothing_in_odd_sizes(void **state)
{
    (void)state;
    static const int32_t sizes[][2] = {{1, 1}, {1, 65535}, {65535, 1}, {2, 65535}, {65535, 2}, {7, 7}, {8, 8},
                                       {9, 8}, {8, 9}, {15, 17}, {16, 16}, {33, 17}, {65535, 8}, {8, 65535}};
    static uint8_t pixels[9 * 65535];
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        const size_t count = (size_t)sizes[i][0] * (size_t)sizes[i][1];
        assert_true(count <= sizeof pixels);
        for (int fill = 0; fill < 3; fill++) {
            random_source source = {i};
            for (size_t p = 0; p < count; p++)
                pixels[p] = fill == 2 ? (uint8_t)(random_bits(&source) >> 40) : fill ? 255 : 0;
            find_nothing_in_pixels(pixels, sizes[i][0], sizes[i][1]);
        }
    }
}

static void says_that_nothing_was_found_where_there_is_nothing(void **state)
{
    (void)state;
    static uint8_t pixels[640 * 480];
    for (int gray = 0; gray < 256; gray += 51) {
        memset(pixels, gray, sizeof pixels);
        const decoding *got = decode_pixels(pixels, 640, 480, NULL);
        assert_int_equal(got->status, TAPEMARK_NOTHING_FOUND);
        assert_int_equal(got->result.stats.tiles_active, 0);
        assert_int_equal(got->result.stats.work, 0);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_nothing_in_clutter),
        cmocka_unit_test(a_small_budget_bounds_the_work_on_clutter),
        cmocka_unit_test(a_sheet_of_tapes_stays_within_bounds),
        cmocka_unit_test(finds_nothing_in_noise),
        cmocka_unit_test(sensor_noise_on_a_blank_wall_is_nothing),
        cmocka_unit_test(noise_beside_something_of_contrast_is_left_alone),
        cmocka_unit_test(finds_nothing_in_checkerboards),
        cmocka_unit_test(finds_nothing_in_odd_sizes),
        cmocka_unit_test(says_that_nothing_was_found_where_there_is_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
