/* Code words from soft cells: what is matched, and what is left alone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "code.h"
#include "random.h"
#include "word.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

enum { ROWS = TAPEMARK_CELL_ROWS, COLUMNS = TAPEMARK_CELL_COLUMNS, CELLS = TAPEMARK_CELLS };

/* What the decoder needs to believe a reading by itself; rarer words need better odds. */
static const float odds_believed = 1.6f, score_believed = 0.8f;

static float odds_needed(int32_t id)
{
    const int32_t rank = id < 0 ? -id : id;
    return odds_believed * (rank <= 3081 ? 1 : rank <= 79157 ? 1.25f : 1.55f);
}

static const tmi_words all_words = {.id_max = TAPEMARK_MAX_ID};

/* The first and last id of each number of ones, and others of each. */
static const int32_t sample_ids[] = {0, 1, 2, 57, 78, 79, 80, 1500, 3081, 3082, 3083, 40000, 79157, 79158, 79159,
                                     424242, 1000000, 1505581, TAPEMARK_MAX_ID};

/* ---- Cells as they are seen ------------------------------------------------------------------------------- */

static float module_at(const uint16_t rows[ROWS], int row, int column)
{
    if (row < 0 || row >= ROWS || column < 0 || column >= COLUMNS)
        return 0; /* light all around */
    return (float)(rows[row] >> (COLUMNS - 1 - column) & 1);
}

static float blurred_along(const uint16_t rows[ROWS], int row, int column, float leak)
{
    return (1 - 2 * leak) * module_at(rows, row, column) +
           leak * (module_at(rows, row, column - 1) + module_at(rows, row, column + 1));
}

static tmi_cells cells_of_rows(const uint16_t rows[ROWS], float leak_along, float leak_across)
{
    tmi_cells cells = {.leak_along = leak_along, .leak_across = leak_across};
    for (int i = 0; i < CELLS; i++) {
        const int row = i / COLUMNS, column = i % COLUMNS;
        cells.value[i] = (1 - 2 * leak_across) * blurred_along(rows, row, column, leak_along) +
                         leak_across * (blurred_along(rows, row - 1, column, leak_along) +
                                        blurred_along(rows, row + 1, column, leak_along));
    }
    return cells;
}

static tmi_cells cells_of(int32_t id, float leak_along, float leak_across)
{
    uint16_t rows[ROWS];
    assert_int_equal(tapemark_cm_grid(id, rows), TAPEMARK_OK);
    return cells_of_rows(rows, leak_along, leak_across);
}

static void add_noise(tmi_cells *cells, float sigma, random_source *source)
{
    for (int i = 0; i < CELLS; i++)
        cells->value[i] += sigma * random_normal(source);
}

static tmi_reading match(tmi_cells cells, const tmi_words *words)
{
    tmi_reading reading;
    uint32_t work = 0;
    tmi_blank_score(&cells);
    tmi_word_match(&cells, words, &reading, &work);
    assert_in_range(work, 1, 20000);
    return reading;
}

static bool believed(const tmi_reading *reading)
{
    return reading->id != TMI_NO_ID && reading->score >= score_believed &&
           reading->odds >= odds_needed(reading->id) && reading->contrary == 0 && !reading->unknown;
}

static void assert_matches(const tmi_reading *reading, int32_t id)
{
    if (reading->id != id || !believed(reading))
        fail_msg("id %d was read as %d, score %.3f, odds %.2f, %u cells contrary", (int)id, (int)reading->id,
                 (double)reading->score, (double)reading->odds, reading->contrary);
}

/* ---- Right words ------------------------------------------------------------------------------------------- */

static void matches_ideal_cells(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const int32_t id = sign * sample_ids[i];
            const tmi_reading reading = match(cells_of(id, 0, 0), &all_words);
            assert_matches(&reading, id);
            assert_true(reading.score > 0.999f && reading.odds >= 4);
            assert_int_equal(reading.doubtful + reading.corrected + reading.contrary, 0);
            assert_false(reading.unknown);
        }
}

static void matches_every_id_of_up_to_one_bit(void **state)
{
    (void)state;
    for (int32_t id = -78; id <= 78; id++) {
        const tmi_reading reading = match(cells_of(id, 0.1f, 0.15f), &all_words);
        assert_matches(&reading, id);
    }
}

/* Up to a fifth of each module's light goes to each of its neighbours. */
static void matches_under_blur(void **state)
{
    (void)state;
    static const float leaks[][2] = {{0.05f, 0.05f}, {0.12f, 0.12f}, {0.18f, 0.18f}, {0.2f, 0}, {0, 0.2f},
                                     {0.05f, 0.22f}};
    for (size_t k = 0; k < COUNT_OF(leaks); k++)
        for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                const int32_t id = sign * sample_ids[i];
                const tmi_reading reading = match(cells_of(id, leaks[k][0], leaks[k][1]), &all_words);
                assert_matches(&reading, id);
                assert_true(reading.score > 0.99f);
            }
}

/* Cells too narrow to be resolved are not enough for an id, however well they fit; with another CM's word they
 * are. */
static void narrow_cells_need_support(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sample_ids); i++) {
        tmi_cells cells = cells_of(sample_ids[i], 0.1f, 0.1f);
        cells.narrow = true;
        const tmi_reading reading = match(cells, &all_words);
        assert_int_equal(reading.id, sample_ids[i]);
        assert_false(believed(&reading));
        assert_true(reading.odds > 1.15f);
    }
}

/* Under more blur than that a word may be lost, but not taken for another one. */
static void no_blur_makes_a_wrong_id(void **state)
{
    (void)state;
    random_source source = {17};
    for (int along = 0; along <= 30; along += 5)
        for (int across = 0; across <= 30; across += 5)
            for (int i = 0; i < 100; i++) {
                const uint64_t among = i % 3 == 0 ? 3082 : i % 3 == 1 ? 79158 : TAPEMARK_MAX_ID + 1;
                const int32_t rank = (int32_t)(random_bits(&source) % among), id = i % 2 ? rank : -rank;
                const float leak_along = 0.01f * (float)along, leak_across = 0.01f * (float)across;
                const tmi_reading reading = match(cells_of(id, leak_along, leak_across), &all_words);
                if (believed(&reading) && reading.id != id)
                    fail_msg("with leaks of %.2f and %.2f id %d was read as %d, score %.3f, odds %.2f",
                             (double)leak_along, (double)leak_across, (int)id, (int)reading.id, (double)reading.score,
                             (double)reading.odds);
            }
}

/* Light and dark as wrongly scaled as finder patterns seen through blur may make them. */
static void matches_whatever_the_scale(void **state)
{
    (void)state;
    static const float scales[][2] = {{0.75f, 0}, {1.3f, 0}, {1, 0.15f}, {1, -0.15f}, {0.8f, 0.15f}, {1.2f, -0.2f}};
    for (size_t k = 0; k < COUNT_OF(scales); k++)
        for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                tmi_cells cells = cells_of(sign * sample_ids[i], 0.1f, 0.1f);
                for (int c = 0; c < CELLS; c++)
                    cells.value[c] = scales[k][0] * cells.value[c] + scales[k][1];
                const tmi_reading reading = match(cells, &all_words);
                assert_matches(&reading, sign * sample_ids[i]);
            }
}

/* ---- Noise -------------------------------------------------------------------------------------------------- */

/* Every sample id in noise; counts those that are believed, and fails on a wrong one among them. */
static int count_believed_in_noise(float sigma, float leak, int *tried)
{
    random_source source = {(uint64_t)(1000 * sigma)};
    int right = 0;
    *tried = 0;
    for (int round = 0; round < 20; round++)
        for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                const int32_t id = sign * sample_ids[i];
                tmi_cells cells = cells_of(id, leak, leak);
                add_noise(&cells, sigma, &source);
                const tmi_reading reading = match(cells, &all_words);
                if (believed(&reading))
                    assert_int_equal(reading.id, id);
                right += believed(&reading);
                ++*tried;
            }
    return right;
}

static void little_noise_costs_nothing(void **state)
{
    (void)state;
    int tried;
    const int right = count_believed_in_noise(0.06f, 0.05f, &tried);
    assert_int_equal(right, tried);
}

static void more_noise_costs_little(void **state)
{
    (void)state;
    int tried;
    const int right = count_believed_in_noise(0.09f, 0.05f, &tried);
    if (10 * right < 8 * tried)
        fail_msg("%d of %d CMs were read", right, tried);
}

static void no_noise_makes_a_wrong_id(void **state)
{
    (void)state;
    static const float sigmas[] = {0.2f, 0.25f, 0.3f, 0.4f, 0.6f};
    for (size_t i = 0; i < COUNT_OF(sigmas); i++)
        for (int leak = 0; leak <= 20; leak += 10) {
            int tried;
            count_believed_in_noise(sigmas[i], 0.01f * (float)leak, &tried);
            assert_int_equal(tried, 20 * 2 * COUNT_OF(sample_ids));
        }
}

static void noise_alone_is_no_word(void **state)
{
    (void)state;
    random_source source = {3};
    for (int round = 0; round < 500; round++) {
        tmi_cells cells = {.leak_along = 0.1f, .leak_across = 0.1f};
        for (int i = 0; i < CELLS; i++)
            cells.value[i] = round % 2 ? (float)random_unit(&source) : (float)(random_bits(&source) >> 63);
        const tmi_reading reading = match(cells, &all_words);
        assert_false(believed(&reading));
    }
}

static void flat_cells_are_no_word(void **state)
{
    (void)state;
    for (int level = -1; level <= 2; level++) {
        tmi_cells cells = {.leak_along = 0.1f, .leak_across = 0.1f};
        for (int i = 0; i < CELLS; i++)
            cells.value[i] = 0.5f * (float)level;
        const tmi_reading reading = match(cells, &all_words);
        assert_false(believed(&reading));
    }
}

/* ---- Words that are none ------------------------------------------------------------------------------------ */

static void flip(tmi_cells *cells, int cell)
{
    cells->value[cell] = 1 - cells->value[cell];
}

static bool is_print_of(const uint16_t rows[ROWS], int32_t id)
{
    uint16_t own[ROWS];
    return tapemark_cm_grid(id, own) == TAPEMARK_OK && memcmp(own, rows, sizeof own) == 0;
}

/* One cell of the wrong shade, under blur too, is seen, and the reading not believed by itself; unless it makes the
 * print of another id. */
static void a_wrong_cell_is_contrary(void **state)
{
    (void)state;
    static const float leaks[][2] = {{0, 0}, {0.1f, 0.1f}, {0.18f, 0.18f}, {0.05f, 0.22f}};
    for (size_t k = 0; k < COUNT_OF(leaks); k++)
        for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
            for (int cell = 0; cell < CELLS; cell++) {
                uint16_t rows[ROWS];
                const int32_t id = cell % 2 ? -sample_ids[i] : sample_ids[i];
                assert_int_equal(tapemark_cm_grid(id, rows), TAPEMARK_OK);
                rows[cell / COLUMNS] = (uint16_t)(rows[cell / COLUMNS] ^ 1u << cell % COLUMNS);
                const tmi_reading reading = match(cells_of_rows(rows, leaks[k][0], leaks[k][1]), &all_words);
                if (believed(&reading) && !is_print_of(rows, reading.id))
                    fail_msg("id %d with cell %d flipped, leaks of %.2f and %.2f, was read as %d", (int)id, cell,
                             (double)leaks[k][0], (double)leaks[k][1], (int)reading.id);
                if (reading.id == id)
                    assert_in_range(reading.contrary, 1, 2);
            }
}

/* However many cells are off, those that are clearly the other shade contradict the word. */
static void a_block_of_wrong_cells_is_contrary(void **state)
{
    (void)state;
    int read = 0;
    for (int columns = 6; columns <= 12; columns++)
        for (int first = 1; first < ROWS - 3; first++) {
            uint16_t rows[ROWS];
            assert_int_equal(tapemark_cm_grid(0, rows), TAPEMARK_OK);
            for (int row = first; row < first + 3; row++)
                rows[row] = (uint16_t)(rows[row] | ((1u << columns) - 1));
            const tmi_cells cells = cells_of_rows(rows, 0.1f, 0.1f);
            tmi_reading reading;
            tmi_word_read_as(&cells, &all_words, 0, &reading);
            if (reading.id == 0)
                assert_in_range(reading.contrary, 6, CELLS);
            read += reading.id == 0;
        }
    assert_true(read > 10);
}

/* Another word's checksum: where it differs in more than a cell, nothing is believed. */
static void a_wrong_checksum_is_not_believed(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sample_ids); i++) {
        tmi_cells cells = cells_of(sample_ids[i], 0, 0);
        for (int bit = 0; bit < 4; bit++)
            flip(&cells, tmi_checksum_cell[(2 * bit + (int)i) % TMI_CHECKSUM_BITS]);
        const tmi_reading reading = match(cells, &all_words);
        assert_false(believed(&reading));
    }
}

static void too_many_ones_are_not_believed(void **state)
{
    (void)state;
    random_source source = {5};
    for (int round = 0; round < 100; round++) {
        tmi_cells cells = cells_of(0, 0, 0);
        for (int ones = 0; ones < 8; ones++)
            cells.value[tmi_data_cell[random_bits(&source) % TAPEMARK_DATA_BITS]] = 1;
        const tmi_reading reading = match(cells, &all_words);
        assert_false(believed(&reading));
    }
}

/* ---- Which way up -------------------------------------------------------------------------------------------- */

static void cells_turned_twice_are_as_before(void **state)
{
    (void)state;
    const tmi_cells cells = cells_of(424242, 0, 0);
    tmi_cells turned = cells;
    tmi_cells_turn(&turned);
    for (int i = 0; i < CELLS; i++)
        assert_true(turned.value[i] == cells.value[CELLS - 1 - i]);
    tmi_cells_turn(&turned);
    assert_memory_equal(&turned, &cells, sizeof cells);
}

/* By a clear margin, noise and blur included: this decides about the direction of single CMs. */
static void the_right_way_up_fits_better(void **state)
{
    (void)state;
    random_source source = {11};
    for (int noise = 0; noise <= 2; noise++)
        for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                tmi_cells upright = cells_of(sign * sample_ids[i], 0.1f, 0.1f);
                add_noise(&upright, 0.08f * (float)noise, &source);
                tmi_cells turned = upright;
                tmi_cells_turn(&turned);
                const float right = tmi_blank_score(&upright), wrong = tmi_blank_score(&turned);
                assert_true(right > 0.35f && right > wrong + 0.25f);
            }
}

static void upside_down_cells_are_no_word(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            tmi_cells cells = cells_of(sign * sample_ids[i], 0.05f, 0.05f);
            tmi_cells_turn(&cells);
            const tmi_reading reading = match(cells, &all_words);
            assert_false(believed(&reading));
        }
}

/* ---- Restrictions -------------------------------------------------------------------------------------------- */

static void ids_beyond_id_max_are_not_believed(void **state)
{
    (void)state;
    const tmi_words few = {.id_max = 100};
    tmi_reading reading = match(cells_of(100, 0, 0), &few);
    assert_matches(&reading, 100);
    reading = match(cells_of(-100, 0, 0), &few);
    assert_matches(&reading, -100);
    for (size_t i = 0; i < COUNT_OF(sample_ids); i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            reading = match(cells_of(sign * sample_ids[i], 0, 0), &few);
            assert_int_equal(believed(&reading), sample_ids[i] <= 100);
            assert_int_equal(reading.id == sign * sample_ids[i] && !reading.unknown, sample_ids[i] <= 100);
        }
}

static void a_foreign_word_is_flagged(void **state)
{
    (void)state;
    static const int32_t known[] = {-80, 3, 57, 3081};
    const tmi_words words = {TAPEMARK_MAX_ID, known, COUNT_OF(known)};
    for (size_t i = 0; i < COUNT_OF(known); i++) {
        const tmi_reading reading = match(cells_of(known[i], 0, 0), &words);
        assert_matches(&reading, known[i]);
        assert_false(reading.unknown);
    }
    static const int32_t foreign[] = {0, -3, 58, -57, 79, 1500, 424242};
    for (size_t i = 0; i < COUNT_OF(foreign); i++) {
        const tmi_reading reading = match(cells_of(foreign[i], 0, 0), &words);
        assert_int_equal(reading.id, foreign[i]);
        assert_true(reading.unknown);
    }
}

static tmi_cells halfway(int32_t one, int32_t other, float share_of_other)
{
    tmi_cells cells = cells_of(one, 0, 0);
    const tmi_cells to = cells_of(other, 0, 0);
    for (int i = 0; i < CELLS; i++)
        cells.value[i] += share_of_other * (to.value[i] - cells.value[i]);
    return cells;
}

static void a_near_tie_goes_to_the_better_word(void **state)
{
    (void)state;
    static const int32_t known[] = {57};
    const tmi_words words = {TAPEMARK_MAX_ID, known, COUNT_OF(known)};
    const tmi_reading foreign = match(halfway(57, 58, 0.52f), &words), own = match(halfway(57, 58, 0.48f), &words);
    assert_int_equal(foreign.id, 58);
    assert_true(foreign.unknown);
    assert_int_equal(own.id, 57);
    assert_false(own.unknown);
    assert_true(own.odds >= odds_believed); /* 58 is none that it could be */
}

static void a_clear_foreign_word_is_not_bent_to_a_known_one(void **state)
{
    (void)state;
    static const int32_t known[] = {57};
    const tmi_words words = {TAPEMARK_MAX_ID, known, COUNT_OF(known)};
    const tmi_reading reading = match(halfway(57, 58, 0.9f), &words);
    assert_int_equal(reading.id, 58);
    assert_true(reading.unknown);
}

static void confidence_grows_with_score_and_odds(void **state)
{
    (void)state;
    const tmi_reading sure = {.score = 1, .odds = 4}, less = {.score = 0.9f, .odds = 4};
    const tmi_reading tie = {.score = 1, .odds = 1}, against = {.score = -0.5f, .odds = 4};
    assert_true(tmi_reading_confidence(&sure) > 0.9f && tmi_reading_confidence(&sure) <= 1);
    assert_true(tmi_reading_confidence(&less) < tmi_reading_confidence(&sure));
    assert_true(tmi_reading_confidence(&tie) <= 0);
    assert_true(tmi_reading_confidence(&against) <= 0);
    const tmi_reading clear = match(cells_of(57, 0, 0), &all_words);
    const tmi_reading doubtful = match(halfway(57, 58, 0.3f), &all_words);
    assert_int_equal(doubtful.id, 57);
    assert_true(doubtful.doubtful > 0);
    assert_true(tmi_reading_confidence(&clear) > tmi_reading_confidence(&doubtful));
}

static void no_word_is_read_as_an_id_that_none_has(void **state)
{
    (void)state;
    static const int32_t beyond[] = {INT32_MIN, -1, TAPEMARK_MAX_ID + 1, INT32_MAX};
    uint16_t rows[ROWS];
    tmi_reading reading;
    assert_int_equal(tapemark_cm_grid(424242, rows), TAPEMARK_OK);
    const tmi_cells cells = cells_of_rows(rows, 0, 0);
    for (size_t i = 0; i < COUNT_OF(beyond); i++) {
        tmi_word_read_as(&cells, &all_words, beyond[i], &reading);
        assert_int_equal(reading.id, TMI_NO_ID);
        assert_true(reading.score < 0);
    }
    tmi_word_read_as(&cells, &all_words, 424242, &reading);
    assert_int_equal(reading.id, 424242);
    assert_true(reading.score > 0.99f);
}

/* The word of no ones, inverted, is that of no id: there is no -0. */
static void dark_cells_are_not_read_as_minus_zero(void **state)
{
    (void)state;
    uint16_t rows[ROWS];
    tmi_reading reading;
    assert_int_equal(tapemark_cm_grid(-5, rows), TAPEMARK_OK);
    const tmi_cells cells = cells_of_rows(rows, 0, 0);
    tmi_word_read_as(&cells, &all_words, 0, &reading);
    assert_int_equal(reading.id, TMI_NO_ID);
    tmi_word_read_as(&cells, &all_words, 5, &reading);
    assert_int_equal(reading.id, -5);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(matches_ideal_cells),
        cmocka_unit_test(matches_every_id_of_up_to_one_bit),
        cmocka_unit_test(matches_under_blur),
        cmocka_unit_test(narrow_cells_need_support),
        cmocka_unit_test(no_blur_makes_a_wrong_id),
        cmocka_unit_test(matches_whatever_the_scale),
        cmocka_unit_test(little_noise_costs_nothing),
        cmocka_unit_test(more_noise_costs_little),
        cmocka_unit_test(no_noise_makes_a_wrong_id),
        cmocka_unit_test(noise_alone_is_no_word),
        cmocka_unit_test(flat_cells_are_no_word),
        cmocka_unit_test(a_wrong_cell_is_contrary),
        cmocka_unit_test(a_block_of_wrong_cells_is_contrary),
        cmocka_unit_test(a_wrong_checksum_is_not_believed),
        cmocka_unit_test(too_many_ones_are_not_believed),
        cmocka_unit_test(cells_turned_twice_are_as_before),
        cmocka_unit_test(the_right_way_up_fits_better),
        cmocka_unit_test(upside_down_cells_are_no_word),
        cmocka_unit_test(ids_beyond_id_max_are_not_believed),
        cmocka_unit_test(a_foreign_word_is_flagged),
        cmocka_unit_test(a_near_tie_goes_to_the_better_word),
        cmocka_unit_test(a_clear_foreign_word_is_not_bent_to_a_known_one),
        cmocka_unit_test(confidence_grows_with_score_and_odds),
        cmocka_unit_test(no_word_is_read_as_an_id_that_none_has),
        cmocka_unit_test(dark_cells_are_not_read_as_minus_zero),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
