/* Code words, ids and checksums: without files, exhaustively where that is quick. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "code.h"
#include "tapemark.h"

static const tapemark_word all_zeros = {{0}};
static const tapemark_word all_ones = {{0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xfc}};

static tapemark_word word_of(int32_t id)
{
    tapemark_word word;
    assert_int_equal(tapemark_word_from_id(id, &word), TAPEMARK_OK);
    return word;
}

static tapemark_word word_with_ones(const uint8_t *positions, unsigned count)
{
    tapemark_word word = all_zeros;
    for (unsigned i = 0; i < count; i++)
        word.bytes[positions[i] / 8] = (uint8_t)(word.bytes[positions[i] / 8] | 0x80u >> positions[i] % 8);
    return word;
}

static void assert_no_id(const tapemark_word *word)
{
    int32_t id = 4711;
    assert_int_equal(tapemark_id_from_word(word, &id), TAPEMARK_NOTHING_FOUND);
    assert_int_equal(id, 4711);
}

/* ---- Cells --------------------------------------------------------------------------------------------- */

static bool cell_of_rows(const uint16_t rows[TAPEMARK_CELL_ROWS], unsigned cell)
{
    return (rows[cell / 16] >> (15 - cell % 16) & 1) != 0;
}

static void alignment_cells_are_the_l_the_corner_and_the_notch(void **state)
{
    (void)state;
    for (unsigned cell = 0; cell < TAPEMARK_CELLS; cell++) {
        bool dark = cell % 16 == 0 || cell / 16 == 6 || cell == 15;
        bool light = cell == 14 || cell == 30 || cell == 31;
        assert_int_equal(cell_of_rows(tmi_dark_rows, cell), dark);
        assert_int_equal(cell_of_rows(tmi_light_rows, cell), light);
    }
}

static void data_cells_are_all_others_in_order(void **state)
{
    (void)state;
    unsigned data = 0, checksum = 0;
    for (unsigned cell = 0; cell < TAPEMARK_CELLS; cell++) {
        if (cell_of_rows(tmi_dark_rows, cell) || cell_of_rows(tmi_light_rows, cell))
            continue;
        if (checksum < TMI_CHECKSUM_BITS && tmi_checksum_cell[checksum] == cell) {
            checksum++;
            continue;
        }
        assert_true(data < TAPEMARK_DATA_BITS);
        assert_int_equal(tmi_data_cell[data++], cell);
    }
    assert_int_equal(data, TAPEMARK_DATA_BITS);
    assert_int_equal(checksum, TMI_CHECKSUM_BITS);
}

/* ---- Ids ----------------------------------------------------------------------------------------------- */

/* Whether the id's word has its ones where `from_right` says, in ascending distance from the right end. */
static void check_place_in_order(int32_t id, const unsigned *from_right, unsigned count)
{
    uint8_t positions[TAPEMARK_MAX_ONES];
    if (tmi_positions_of_id(id, positions) != count)
        fail_msg("id %d has not %u ones", (int)id, count);
    for (unsigned i = 0; i < count; i++) {
        if (positions[count - 1 - i] != 77 - from_right[i])
            fail_msg("id %d has no one at %u from the right", (int)id, from_right[i]);
    }
}

/* Counts through all words as the format orders them: by the number of ones, then by their positions from the
 * right in lexicographic order. */
static void ids_follow_the_order_of_words(void **state)
{
    (void)state;
    int32_t id = 0;
    for (unsigned count = 0; count <= TAPEMARK_MAX_ONES; count++) {
        unsigned p[TAPEMARK_MAX_ONES] = {0, 1, 2, 3};
        for (bool more = true; more; id++) {
            check_place_in_order(id, p, count);
            unsigned last = count;
            while (last > 0 && p[last - 1] == 78 - count + last - 1)
                last--;
            more = last > 0;
            if (more)
                p[last - 1]++;
            for (unsigned i = last; more && i < count; i++)
                p[i] = p[i - 1] + 1;
        }
    }
    assert_int_equal(id, TAPEMARK_MAX_ID + 1);
}

static void words_of_small_ids_as_written_down(void **state)
{
    (void)state;
    static const struct {
        int32_t id;
        uint8_t last_bytes[2];  /* bits 64 to 77, the rest is uniform */
    } cases[] = {
        {0, {0x00, 0x00}}, {1, {0x00, 0x04}}, {2, {0x00, 0x08}}, {3, {0x00, 0x10}}, {79, {0x00, 0x0c}},
        {80, {0x00, 0x14}}, {156, {0x00, 0x18}}, {3082, {0x00, 0x1c}}, {79158, {0x00, 0x3c}},
        {-1, {0xff, 0xf8}}, {-2, {0xff, 0xf4}}, {-79, {0xff, 0xf0}}, {-79158, {0xff, 0xc0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tapemark_word expected = cases[i].id < 0 ? all_ones : all_zeros;
        memcpy(expected.bytes + 8, cases[i].last_bytes, 2);
        tapemark_word word = word_of(cases[i].id);
        assert_memory_equal(&word, &expected, sizeof word);
    }
}

static void every_id_survives_the_way_to_a_word_and_back(void **state)
{
    (void)state;
    for (int32_t id = 0; id <= TAPEMARK_MAX_ID; id++) {
        tapemark_word word;
        int32_t back = -1;
        tapemark_word_from_id(id, &word);
        if (tapemark_id_from_word(&word, &back) != TAPEMARK_OK || back != id)
            fail_msg("id %d came back as %d", (int)id, (int)back);
    }
    enum { STRIDE = 17 };
    for (int32_t id = -TAPEMARK_MAX_ID; id < 0; id += STRIDE) {
        int32_t back = 0;
        tapemark_word word = word_of(id), twin = word_of(-id);
        tapemark_word complement = tapemark_word_complement(&twin);
        assert_memory_equal(&word, &complement, sizeof word);
        if (tapemark_id_from_word(&word, &back) != TAPEMARK_OK || back != id)
            fail_msg("id %d came back as %d", (int)id, (int)back);
    }
}

static void ids_out_of_range_are_refused(void **state)
{
    (void)state;
    static const int32_t bad[] = {TAPEMARK_MAX_ID + 1, -TAPEMARK_MAX_ID - 1, INT32_MAX, -INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        tapemark_word word = {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}, before = word;
        uint16_t rows[TAPEMARK_CELL_ROWS] = {1, 2, 3, 4, 5, 6, 7}, rows_before[TAPEMARK_CELL_ROWS];
        memcpy(rows_before, rows, sizeof rows);
        assert_int_equal(tapemark_word_from_id(bad[i], &word), TAPEMARK_BAD_CALL);
        assert_memory_equal(&word, &before, sizeof word);
        assert_int_equal(tapemark_cm_grid(bad[i], rows), TAPEMARK_BAD_CALL);
        assert_memory_equal(rows, rows_before, sizeof rows);
    }
}

static void first_and_last_ids(void **state)
{
    (void)state;
    static const uint8_t leftmost_four[] = {0, 1, 2, 3};
    tapemark_word expected = word_with_ones(leftmost_four, 4);
    tapemark_word word = word_of(TAPEMARK_MAX_ID);
    assert_memory_equal(&word, &expected, sizeof word);
    expected = tapemark_word_complement(&expected);
    word = word_of(-TAPEMARK_MAX_ID);
    assert_memory_equal(&word, &expected, sizeof word);
    word = word_of(0);
    assert_memory_equal(&word, &all_zeros, sizeof word);
}

static void words_without_an_id(void **state)
{
    (void)state;
    static const uint8_t five[] = {0, 19, 38, 57, 77};
    tapemark_word word = word_with_ones(five, 5);
    assert_no_id(&word);
    word = tapemark_word_complement(&word);
    assert_no_id(&word);
    assert_no_id(&all_ones);
    tapemark_word half = {{0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xa8}};
    assert_no_id(&half);
}

/* ---- Words --------------------------------------------------------------------------------------------- */

static void bits_come_in_printed_order(void **state)
{
    (void)state;
    static const uint8_t ones[] = {0, 9, 64, 77};
    tapemark_word word = word_with_ones(ones, 4);
    assert_int_equal(word.bytes[9], 0x04);
    for (unsigned i = 0; i < TAPEMARK_DATA_BITS; i++)
        assert_int_equal(tapemark_word_bit(&word, i), i == 0 || i == 9 || i == 64 || i == 77);
}

static void bits_beyond_the_word_do_not_count(void **state)
{
    (void)state;
    tapemark_word word = word_of(12345), stained = word;
    stained.bytes[9] |= 0x03;
    int32_t id = 0;
    assert_false(tapemark_word_bit(&stained, 78));
    assert_false(tapemark_word_bit(&stained, 79));
    assert_false(tapemark_word_bit(&stained, UINT32_MAX));
    assert_int_equal(tapemark_id_from_word(&stained, &id), TAPEMARK_OK);
    assert_int_equal(id, 12345);
    assert_int_equal(tapemark_word_checksum(&stained), tapemark_word_checksum(&word));
    tapemark_word complement = tapemark_word_complement(&stained);
    assert_int_equal(complement.bytes[9] & 0x03, 0);
}

static void null_is_refused_or_reads_as_zeros(void **state)
{
    (void)state;
    tapemark_word word = word_of(5);
    int32_t id = 0;
    assert_int_equal(tapemark_word_from_id(5, NULL), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_id_from_word(NULL, &id), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_id_from_word(&word, NULL), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_cm_grid(5, NULL), TAPEMARK_BAD_CALL);
    assert_false(tapemark_word_bit(NULL, 0));
    assert_int_equal(tapemark_word_checksum(NULL), tapemark_word_checksum(&all_zeros));
    word = tapemark_word_complement(NULL);
    assert_memory_equal(&word, &all_ones, sizeof word);
}

/* ---- Positions ----------------------------------------------------------------------------------------- */

static void positions_agree_with_words(void **state)
{
    (void)state;
    enum { STRIDE = 53 };
    for (int32_t id = -TAPEMARK_MAX_ID; id <= TAPEMARK_MAX_ID; id += STRIDE) {
        uint8_t positions[TAPEMARK_MAX_ONES];
        unsigned count = tmi_positions_of_id(id, positions);
        tapemark_word word = word_of(id), from_positions = word_with_ones(positions, count);
        if (id < 0)
            from_positions = tapemark_word_complement(&from_positions);
        assert_memory_equal(&word, &from_positions, sizeof word);
        assert_int_equal(tmi_id_of_positions(positions, count, id < 0), id);
        assert_int_equal(tmi_checksum_of_positions(positions, count, id < 0), tapemark_word_checksum(&word));
    }
}

static void positions_come_in_any_order(void **state)
{
    (void)state;
    static const uint8_t orders[][4] = {{3, 30, 60, 77}, {77, 60, 30, 3}, {60, 3, 77, 30}, {30, 77, 3, 60}};
    int32_t id = tmi_id_of_positions(orders[0], 4, true);
    tapemark_word word = word_of(id);
    for (unsigned bit = 0; bit < TAPEMARK_DATA_BITS; bit++)
        assert_int_equal(tapemark_word_bit(&word, bit), memchr(orders[0], (int)bit, 4) == NULL);
    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        assert_int_equal(tmi_id_of_positions(orders[i], 4, true), id);
        assert_int_equal(tmi_checksum_of_positions(orders[i], 4, true), tapemark_word_checksum(&word));
    }
}

static void positions_without_an_id(void **state)
{
    (void)state;
    static const uint8_t five[] = {1, 2, 3, 4, 5}, twice[] = {7, 40, 7}, beyond[] = {5, 78};
    assert_int_equal(tmi_id_of_positions(five, 5, false), TMI_NO_ID);
    assert_int_equal(tmi_id_of_positions(twice, 3, false), TMI_NO_ID);
    assert_int_equal(tmi_id_of_positions(beyond, 2, true), TMI_NO_ID);
    assert_int_equal(tmi_id_of_positions(five, 0, true), TMI_NO_ID);
    assert_int_equal(tmi_id_of_positions(five, 0, false), 0);
}

/* ---- Version and texts --------------------------------------------------------------------------------- */

static void version_is_that_of_the_header(void **state)
{
    (void)state;
    int parts[3] = {-1, -1, -1};
    assert_int_equal(sscanf(tapemark_version(), "%d.%d.%d", &parts[0], &parts[1], &parts[2]), 3);
    assert_int_equal(parts[0], TAPEMARK_VERSION_MAJOR);
    assert_int_equal(parts[1], TAPEMARK_VERSION_MINOR);
    assert_int_equal(parts[2], TAPEMARK_VERSION_PATCH);
}

static void every_status_has_its_own_text(void **state)
{
    (void)state;
    const char *unlisted = tapemark_status_text((tapemark_status)99);
    assert_non_null(unlisted);
    for (int a = TAPEMARK_BAD_MAP; a <= TAPEMARK_AMBIGUOUS; a++) {
        const char *text = tapemark_status_text((tapemark_status)a);
        assert_true(strlen(text) > 0);
        assert_string_not_equal(text, unlisted);
        for (int b = TAPEMARK_BAD_MAP; b < a; b++)
            assert_string_not_equal(text, tapemark_status_text((tapemark_status)b));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(alignment_cells_are_the_l_the_corner_and_the_notch),
        cmocka_unit_test(data_cells_are_all_others_in_order),
        cmocka_unit_test(ids_follow_the_order_of_words),
        cmocka_unit_test(words_of_small_ids_as_written_down),
        cmocka_unit_test(every_id_survives_the_way_to_a_word_and_back),
        cmocka_unit_test(ids_out_of_range_are_refused),
        cmocka_unit_test(first_and_last_ids),
        cmocka_unit_test(words_without_an_id),
        cmocka_unit_test(bits_come_in_printed_order),
        cmocka_unit_test(bits_beyond_the_word_do_not_count),
        cmocka_unit_test(null_is_refused_or_reads_as_zeros),
        cmocka_unit_test(positions_agree_with_words),
        cmocka_unit_test(positions_come_in_any_order),
        cmocka_unit_test(positions_without_an_id),
        cmocka_unit_test(version_is_that_of_the_header),
        cmocka_unit_test(every_status_has_its_own_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
