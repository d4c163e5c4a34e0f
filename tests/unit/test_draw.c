/* Drawing: segments against rows of the format's reference model, and the layout rule by rule. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tapemark.h"

enum { WIDTH_MAX = 25 * 32 + 23 };

static uint8_t drawing[WIDTH_MAX * TAPEMARK_HEIGHT_MODULES];

static void assert_drawn(const int32_t *ids, size_t count, bool with_bars,
                         const char *const expected[TAPEMARK_HEIGHT_MODULES])
{
    size_t width = tapemark_segment_width_modules(count, with_bars);
    assert_int_equal(width, strlen(expected[0]));
    assert_int_equal(tapemark_segment_draw(ids, count, with_bars, drawing, sizeof drawing), TAPEMARK_OK);
    for (size_t y = 0; y < TAPEMARK_HEIGHT_MODULES; y++) {
        for (size_t x = 0; x < width; x++)
            assert_int_equal(drawing[y * width + x], expected[y][x] == '#');
    }
}

static void one_positive_cm_as_the_model_draws_it(void **state)
{
    (void)state;
    static const int32_t ids[] = {1234567};
    static const char *const expected[] = {
        "#######.#.#.#..........#.#######",
        "#.....#.###.....#....#...#.....#",
        "#.###.#.#................#.###.#",
        "#.###.#.#................#.###.#",
        "#.###.#.###..#..#........#.###.#",
        "#.....#.#................#.....#",
        "#######.################.#######",
    };
    assert_drawn(ids, 1, false, expected);
}

static void a_tm_of_six_as_the_model_draws_it(void **state)
{
    (void)state;
    static const int32_t ids[] = {0, -1, -2, -3, -4, -5};
    static const char *const expected[] = {
        "#.#.#.#.#######.#..............#.#######.##############.#.#######.##############.#.#######.#########"
        "#####.#.#######.##############.#.#######.##############.#.#######.#.#.#.#",
        "#.#.#.#.#.....#.#....#...........#.....#.#####.##.####....#.....#.#############....#.....#.#########"
        "#####...#.....#.#####.##.#####...#.....#.#############....#.....#.#.#.#.#",
        "#.#.#.#.#.###.#.#................#.###.#.################.#.###.#.################.#.###.#.#########"
        "#######.#.###.#.################.#.###.#.################.#.###.#.#.#.#.#",
        "#.#.#.#.#.###.#.#................#.###.#.################.#.###.#.################.#.###.#.#########"
        "#######.#.###.#.################.#.###.#.################.#.###.#.#.#.#.#",
        "#.#.#.#.#.###.#.#....#..#........#.###.#.##.##########.##.#.###.#.########.#######.#.###.#.##.##.###"
        "#######.#.###.#.##.##.##########.#.###.#.##.#####.####.##.#.###.#.#.#.#.#",
        "#.#.#.#.#.....#.#................#.....#.###############..#.....#.##############.#.#.....#.#########"
        "####.##.#.....#.############.###.#.....#.###########.####.#.....#.#.#.#.#",
        "#.#.#.#.#######.################.#######.################.#######.################.#######.#########"
        "#######.#######.################.#######.################.#######.#.#.#.#",
    };
    assert_drawn(ids, 6, true, expected);
}

static void cells_of_a_cm_are_those_of_its_grid(void **state)
{
    (void)state;
    static const int32_t ids[] = {500000, -1505582, 78, -3082};
    for (int bars = 0; bars < 2; bars++) {
        size_t width = tapemark_segment_width_modules(4, bars);
        assert_int_equal(tapemark_segment_draw(ids, 4, bars, drawing, sizeof drawing), TAPEMARK_OK);
        for (size_t cm = 0; cm < 4; cm++) {
            uint16_t rows[TAPEMARK_CELL_ROWS];
            size_t left = (bars ? 8 : 0) + cm * 25 + 8;
            assert_int_equal(tapemark_cm_grid(ids[cm], rows), TAPEMARK_OK);
            for (size_t cell = 0; cell < TAPEMARK_CELLS; cell++)
                assert_int_equal(drawing[cell / 16 * width + left + cell % 16],
                                 rows[cell / 16] >> (15 - cell % 16) & 1);
        }
    }
}

/* Lengths of the runs of dark and light along a row, dark first; how many there are. */
static size_t runs_of(const uint8_t *row, size_t width, size_t runs[WIDTH_MAX])
{
    size_t count = 0;
    assert_int_equal(row[0], 1);
    for (size_t x = 0; x < width; x++) {
        if (x == 0 || row[x] != row[x - 1])
            runs[count++] = 0;
        runs[count - 1]++;
    }
    return count;
}

static void bars_are_four_at_each_end_in_every_row(void **state)
{
    (void)state;
    static const int32_t ids[] = {7, -8, 9};
    size_t width = tapemark_segment_width_modules(3, true);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, sizeof drawing), TAPEMARK_OK);
    for (size_t y = 0; y < TAPEMARK_HEIGHT_MODULES; y++) {
        size_t runs[WIDTH_MAX];
        size_t count = runs_of(drawing + y * width, width, runs);
        assert_int_equal(count % 2, 1);
        for (size_t i = 0; i < 8; i++) {
            assert_int_equal(runs[i], 1);
            assert_int_equal(runs[count - 1 - i], 1);
        }
    }
}

static void a_line_through_the_middle_sees_finder_patterns_as_1_1_3_1_1(void **state)
{
    (void)state;
    static const int32_t ids[] = {7, -8, 9};
    static const size_t shape[] = {1, 1, 3, 1, 1};
    size_t width = tapemark_segment_width_modules(3, true);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, sizeof drawing), TAPEMARK_OK);
    for (size_t left = 8; left < width; left += 25) {
        size_t runs[WIDTH_MAX];
        assert_int_equal(runs_of(drawing + 3 * width + left, 7, runs), 5);
        assert_memory_equal(runs, shape, sizeof shape);
        assert_int_equal(drawing[3 * width + left - 1], 0);
        assert_int_equal(drawing[3 * width + left + 7], 0);
        for (size_t y = 0; y < 7; y++) {
            for (size_t x = 0; x < 7; x++)
                assert_int_equal(drawing[y * width + left + x], drawing[x * width + left + y]);
        }
    }
}

static void widths(void **state)
{
    (void)state;
    assert_int_equal(tapemark_segment_width_modules(0, false), 0);
    assert_int_equal(tapemark_segment_width_modules(0, true), 0);
    assert_int_equal(tapemark_segment_width_modules(1, false), TAPEMARK_CM_WIDTH_MODULES);
    assert_int_equal(tapemark_segment_width_modules(6, true), 173);
    assert_int_equal(tapemark_segment_width_modules(65535, true), 65535u * 25 + 23);
    assert_int_equal(tapemark_segment_width_modules(65536, true), 0);
    assert_int_equal(tapemark_segment_width_modules(SIZE_MAX, false), 0);
}

static void assert_untouched(size_t from)
{
    for (size_t i = from; i < sizeof drawing; i++)
        assert_int_equal(drawing[i], 0x55);
}

static void a_drawing_needs_its_room_and_no_more(void **state)
{
    (void)state;
    static const int32_t ids[] = {1, 2, 3};
    size_t size = (25 * 3 + 23) * 7;
    memset(drawing, 0x55, sizeof drawing);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, size - 1), TAPEMARK_NO_ROOM);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, 0), TAPEMARK_NO_ROOM);
    assert_untouched(0);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, size), TAPEMARK_OK);
    assert_untouched(size);
}

static void bad_segments_are_refused(void **state)
{
    (void)state;
    int32_t ids[] = {1, 2, TAPEMARK_MAX_ID + 1};
    memset(drawing, 0x55, sizeof drawing);
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, sizeof drawing), TAPEMARK_BAD_CALL);
    ids[2] = INT32_MIN;
    assert_int_equal(tapemark_segment_draw(ids, 3, true, drawing, sizeof drawing), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_segment_draw(ids, 0, true, drawing, sizeof drawing), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_segment_draw(ids, 65536, true, drawing, sizeof drawing), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_segment_draw(NULL, 2, true, drawing, sizeof drawing), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_segment_draw(ids, 2, true, NULL, sizeof drawing), TAPEMARK_BAD_CALL);
    assert_untouched(0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_positive_cm_as_the_model_draws_it),
        cmocka_unit_test(a_tm_of_six_as_the_model_draws_it),
        cmocka_unit_test(cells_of_a_cm_are_those_of_its_grid),
        cmocka_unit_test(bars_are_four_at_each_end_in_every_row),
        cmocka_unit_test(a_line_through_the_middle_sees_finder_patterns_as_1_1_3_1_1),
        cmocka_unit_test(widths),
        cmocka_unit_test(a_drawing_needs_its_room_and_no_more),
        cmocka_unit_test(bad_segments_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
