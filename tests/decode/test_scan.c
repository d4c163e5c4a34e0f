/* Scan lines on gray values typed in by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "random.h"
#include "scan.h"
#include "tapemark.h"

enum { LINE_MAX_PX = 2048, TILES_MAX = LINE_MAX_PX / TAPEMARK_TILE_PX, HITS_MAX = 256 };

/* A line under test: its pixels are appended run by run. */
typedef struct test_line {
    uint8_t pixels[LINE_MAX_PX];
    int32_t length;
    uint8_t swing[TILES_MAX];
    uint32_t active[TILES_MAX / 32];
    uint8_t invert;
    tmi_hit hits[HITS_MAX];
    int hit_count;
    int32_t number;
} test_line;

static test_line line;

static void collect(void *context, int32_t number, const tmi_hit *hit)
{
    test_line *to = context;
    assert_int_equal(number, to->number);
    assert_true(to->hit_count < HITS_MAX);
    to->hits[to->hit_count++] = *hit;
}

static void begin(void)
{
    memset(&line, 0, sizeof line);
    line.number = 123;
    memset(line.swing, 20, sizeof line.swing);
    memset(line.active, 0xff, sizeof line.active);
}

static void run_of(int32_t px, int gray)
{
    assert_true(line.length + px <= LINE_MAX_PX);
    memset(line.pixels + line.length, gray, (size_t)px);
    line.length += px;
}

/* dark, light, dark, light, dark. */
static void five_runs(const int px[5], int light, int dark)
{
    for (int i = 0; i < 5; i++)
        run_of(px[i], i % 2 ? light : dark);
}

static void finder_of(int module_px, int light, int dark)
{
    five_runs((const int[5]){module_px, module_px, 3 * module_px, module_px, module_px}, light, dark);
}

static int32_t scan_with_step(ptrdiff_t step)
{
    const int32_t tiles = (line.length + TAPEMARK_TILE_PX - 1) / TAPEMARK_TILE_PX;
    uint32_t active[TILES_MAX / 32] = {0};
    for (int32_t tile = 0; tile < tiles; tile++)
        active[tile / 32] |= line.active[tile / 32] & 1u << tile % 32;
    uint8_t *spread = calloc((size_t)line.length, (size_t)step); /* exactly as long as the line */
    assert_non_null(spread);
    for (int32_t i = 0; i < line.length; i++)
        spread[i * step] = line.pixels[i];
    const tmi_scan scan = {.pixels = spread, .step = step, .length = line.length, .number = line.number,
                           .invert = line.invert, .swing = line.swing, .swing_step = 1, .active = active,
                           .words = (tiles + 31) / 32};
    line.hit_count = 0;
    const int32_t read = tmi_scan_line(&scan, collect, &line);
    free(spread);
    return read;
}

static int32_t scan(void)
{
    return scan_with_step(1);
}

/* One hit: pixel i reaches from i - 0.5 to i + 0.5. */
static void assert_hit(float centre, float chord, float slack)
{
    assert_int_equal(line.hit_count, 1);
    assert_true(line.hits[0].centre > centre - slack && line.hits[0].centre < centre + slack);
    assert_true(line.hits[0].chord > chord - 2 * slack && line.hits[0].chord < chord + 2 * slack);
}

/* ---- Patterns that are there ------------------------------------------------------------------------------ */

static void finds_a_pattern_of_any_size(void **state)
{
    (void)state;
    for (int module = 1; module <= 60; module++) {
        begin();
        run_of(40, 200);
        finder_of(module, 200, 30);
        run_of(40, 200);
        scan();
        assert_hit(39.5f + 3.5f * (float)module, 7.0f * (float)module, 0.01f);
        assert_true(line.hits[0].contrast > 169.9f && line.hits[0].contrast < 170.1f);
    }
}

static void finds_a_pattern_at_any_place_among_the_tiles(void **state)
{
    (void)state;
    for (int start = 1; start <= 40; start++)
        for (int behind = 1; behind <= 20; behind++) {
            begin();
            run_of(start, 190);
            finder_of(2, 190, 60);
            run_of(behind, 190); /* the line need not end with a tile */
            scan();
            assert_hit((float)start + 6.5f, 14, 0.01f);
        }
}

static void finds_patterns_at_both_ends_of_a_line(void **state)
{
    (void)state;
    begin();
    run_of(1, 200);
    finder_of(3, 200, 30);
    run_of(70, 200);
    finder_of(3, 200, 30);
    run_of(1, 200);
    scan();
    assert_int_equal(line.hit_count, 2);
    assert_true(line.hits[0].centre > 10.9f && line.hits[0].centre < 11.1f);
    assert_true(line.hits[1].centre > 101.9f && line.hits[1].centre < 102.1f);
}

static void a_pattern_cut_by_the_end_is_none(void **state)
{
    (void)state;
    begin();
    run_of(30, 200);
    finder_of(3, 200, 30); /* its last ring goes on beyond the image, for all that is known */
    scan();
    assert_int_equal(line.hit_count, 0);
    begin();
    finder_of(3, 200, 30);
    run_of(30, 200);
    scan();
    assert_int_equal(line.hit_count, 0);
}

/* Rings of one pixel, blurred by [1 6 1] / 8: half of their contrast is left. */
static void finds_blurred_rings_of_one_pixel(void **state)
{
    (void)state;
    begin();
    run_of(20, 200);
    finder_of(1, 200, 40);
    run_of(20, 200);
    uint8_t sharp[LINE_MAX_PX];
    memcpy(sharp, line.pixels, sizeof sharp);
    for (int32_t i = 1; i + 1 < line.length; i++)
        line.pixels[i] = (uint8_t)((sharp[i - 1] + 6 * sharp[i] + sharp[i + 1]) / 8);
    scan();
    assert_hit(23, 7, 0.5f);
}

static void finds_a_pattern_over_a_gradient(void **state)
{
    (void)state;
    for (int falling = 0; falling < 2; falling++) {
        begin();
        run_of(60, 110);
        finder_of(5, 110, 60);
        run_of(60, 110);
        for (int32_t i = 0; i < line.length; i++) /* from end to end by more than light and dark differ by */
            line.pixels[i] = (uint8_t)(line.pixels[i] + 120 * (falling ? line.length - i : i) / line.length);
        scan();
        assert_hit(59.5f + 17.5f, 35, 1);
    }
}

static void finds_a_pattern_where_light_grows_gradually(void **state)
{
    (void)state;
    begin();
    run_of(40, 200);
    five_runs((const int[5]){4, 4, 12, 4, 4}, 150, 30); /* rings less light than the margin: haze, small print */
    run_of(40, 200);
    scan();
    assert_hit(39.5f + 14, 28, 0.6f);
}

static void finds_inverted_patterns_only_when_asked(void **state)
{
    (void)state;
    begin();
    run_of(40, 30);
    finder_of(4, 30, 200);
    run_of(40, 30);
    scan();
    assert_int_equal(line.hit_count, 0);
    line.invert = 255;
    scan();
    assert_hit(53.5f, 28, 0.01f);
    assert_true(line.hits[0].contrast > 169.9f && line.hits[0].contrast < 170.1f);
}

static void columns_are_read_with_a_step(void **state)
{
    (void)state;
    begin();
    run_of(25, 200);
    finder_of(2, 200, 30);
    run_of(9, 200);
    for (ptrdiff_t step = 1; step <= 700; step = 3 * step + 1) {
        assert_int_equal(scan_with_step(step), line.length);
        assert_hit(31.5f, 14, 0.01f);
    }
}

/* ---- Tiles ------------------------------------------------------------------------------------------------- */

static void set_active(int32_t tile, bool active)
{
    const uint32_t bit = 1u << tile % 32;
    line.active[tile / 32] = active ? line.active[tile / 32] | bit : line.active[tile / 32] & ~bit;
}

/* Core and rings are longer than tiles, whose middles are flat: only those with an edge are read. */
static void runs_go_on_across_flat_tiles(void **state)
{
    (void)state;
    begin();
    run_of(200, 200);
    finder_of(90, 200, 30);
    run_of(200, 200);
    int32_t read = 0;
    for (int32_t tile = 0; tile * TAPEMARK_TILE_PX < line.length; tile++) {
        const int32_t first = tile * TAPEMARK_TILE_PX, left = line.length - first;
        const int32_t count = left < TAPEMARK_TILE_PX ? left : TAPEMARK_TILE_PX;
        bool edge = tile == 0;
        for (int32_t i = first; i < first + count; i++)
            edge = edge || (i > 0 && line.pixels[i] != line.pixels[i - 1]);
        set_active(tile, edge);
        read += edge ? count : 0;
    }
    assert_true(read < line.length / 4);
    assert_int_equal(scan(), read);
    assert_hit(199.5f + 315, 630, 0.01f);
}

static void inactive_tiles_are_not_read(void **state)
{
    (void)state;
    begin();
    run_of(100, 200);
    finder_of(2, 200, 30);
    run_of(101, 200);
    assert_int_equal(scan(), 215);
    assert_int_equal(line.hit_count, 1);
    memset(line.active, 0, sizeof line.active);
    assert_int_equal(scan(), 0);
    assert_int_equal(line.hit_count, 0);
    set_active(13, true); /* the last one, of 7 px */
    assert_int_equal(scan(), 7);
    set_active(0, true);
    assert_int_equal(scan(), 7 + TAPEMARK_TILE_PX);
    assert_int_equal(line.hit_count, 0);
}

static void less_than_the_swing_is_no_edge(void **state)
{
    (void)state;
    begin();
    run_of(40, 120);
    finder_of(4, 120, 101);
    run_of(40, 120);
    scan();
    assert_int_equal(line.hit_count, 0);
    memset(line.swing, 19, sizeof line.swing);
    scan();
    assert_hit(53.5f, 28, 0.01f);
}

/* ---- Patterns that are not there --------------------------------------------------------------------------- */

static void wrong_proportions_are_no_hits(void **state)
{
    (void)state;
    static const int wrong[][5] = {{1, 1, 1, 1, 1}, {1, 1, 7, 1, 1}, {3, 1, 1, 1, 3}, {1, 3, 1, 3, 1},
                                   {1, 1, 3, 1, 5}, {5, 1, 3, 1, 1}, {1, 1, 3, 4, 1}, {2, 2, 3, 1, 1},
                                   {1, 1, 3, 3, 3}, {3, 3, 3, 3, 3}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        for (int module = 2; module <= 12; module++) {
            begin();
            run_of(80, 200);
            int px[5];
            for (int k = 0; k < 5; k++)
                px[k] = module * wrong[i][k];
            five_runs(px, 200, 30);
            run_of(80, 200);
            scan();
            if (line.hit_count > 0)
                fail_msg("%d:%d:%d:%d:%d of %d px was taken for a finder pattern", wrong[i][0], wrong[i][1],
                         wrong[i][2], wrong[i][3], wrong[i][4], module);
        }
}

/* Half a module more or less in one run is what blur and small print do. */
static void slightly_wrong_proportions_are_hits(void **state)
{
    (void)state;
    static const int px[][5] = {
        {5, 4, 12, 4, 3}, {3, 5, 12, 5, 3}, {4, 4, 14, 4, 4}, {5, 3, 13, 3, 5}, {4, 4, 10, 4, 4}};
    for (size_t i = 0; i < sizeof px / sizeof *px; i++) {
        begin();
        run_of(80, 200);
        five_runs(px[i], 200, 30);
        run_of(80, 200);
        scan();
        assert_int_equal(line.hit_count, 1);
    }
}

static void stripes_and_flat_lines_are_no_hits(void **state)
{
    (void)state;
    for (int width = 0; width <= 20; width++) {
        begin();
        for (int i = 0; i < 60; i++)
            run_of(width > 0 ? width : 16, width > 0 && i % 2 ? 30 : 200);
        assert_int_equal(scan(), line.length);
        assert_int_equal(line.hit_count, 0);
    }
}

/* Dark and light runs of random lengths, from `shortest_px` to four times that; hits per 1000 runs. */
static int hits_in_random_runs(int shortest_px)
{
    random_source source = {7};
    int hits = 0, runs = 0;
    while (runs < 20000) {
        begin();
        for (int i = 0; line.length + 4 * shortest_px < LINE_MAX_PX; i++, runs++)
            run_of(shortest_px + (int)(random_bits(&source) >> 40) % (3 * shortest_px + 1), i % 2 ? 30 : 200);
        scan();
        hits += line.hit_count;
    }
    return hits * 1000 / runs;
}

/* The smaller, the wider the bounds have to be. */
static void random_runs_give_few_hits(void **state)
{
    (void)state;
    assert_true(hits_in_random_runs(1) < 60);
    assert_true(hits_in_random_runs(2) < 45);
    assert_true(hits_in_random_runs(8) < 40);
}

static void a_short_line_is_read_to_its_end(void **state)
{
    (void)state;
    for (int length = 1; length <= 40; length++)
        for (int gray = 0; gray <= 255; gray += 255) {
            begin();
            run_of(length, gray);
            line.pixels[length / 2] = 128;
            assert_int_equal(scan(), length);
            assert_int_equal(line.hit_count, 0);
        }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_a_pattern_of_any_size),
        cmocka_unit_test(finds_a_pattern_at_any_place_among_the_tiles),
        cmocka_unit_test(finds_patterns_at_both_ends_of_a_line),
        cmocka_unit_test(a_pattern_cut_by_the_end_is_none),
        cmocka_unit_test(finds_blurred_rings_of_one_pixel),
        cmocka_unit_test(finds_a_pattern_over_a_gradient),
        cmocka_unit_test(finds_a_pattern_where_light_grows_gradually),
        cmocka_unit_test(finds_inverted_patterns_only_when_asked),
        cmocka_unit_test(columns_are_read_with_a_step),
        cmocka_unit_test(runs_go_on_across_flat_tiles),
        cmocka_unit_test(inactive_tiles_are_not_read),
        cmocka_unit_test(less_than_the_swing_is_no_edge),
        cmocka_unit_test(wrong_proportions_are_no_hits),
        cmocka_unit_test(slightly_wrong_proportions_are_hits),
        cmocka_unit_test(stripes_and_flat_lines_are_no_hits),
        cmocka_unit_test(random_runs_give_few_hits),
        cmocka_unit_test(a_short_line_is_read_to_its_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
