/* Code markers with cells that are wrong, alone: the id that was meant, or none; never another one, but where the
 * cells are exactly those that the other one prints. */
#include "printed.h"

static const double sizes_px[] = {1.6, 2.5, 4};

/* From no ones to four, and their negatives. */
static const int32_t true_ids[] = {0, 37, -37, 2000, -2000, 50000, -1000000};

static const decoding *decode_cells(const forged_cells cells, double px_per_module, double roll_deg, const char *name)
{
    printed print;
    print_nothing(&print, TAPEMARK_CM_WIDTH_MODULES, TAPEMARK_HEIGHT_MODULES);
    print_cells(&print, 0, 0, cells);
    return decode_print(&print, (scene_pose){.px_per_module = px_per_module, .roll_deg = roll_deg}, NULL, name);
}

/* Returns whether it was read. */
static bool assert_this_id_or_none(const decoding *got, int32_t id, const forged_cells cells)
{
    const int32_t printed_id = id_of_cells(cells);
    for (size_t i = 0; i < got->result.cm_count; i++)
        if (got->cms[i].id != id && got->cms[i].id != printed_id)
            fail_msg("%s: id %d was read in a forged %d, confidence %.2f", got->name, (int)got->cms[i].id, (int)id,
                     (double)got->cms[i].confidence);
    return got->result.cm_count > 0;
}

static void true_markers_are_read_either_way_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(true_ids); i++)
        for (size_t s = 0; s < COUNT_OF(sizes_px); s++)
            for (int roll_deg = 0; roll_deg < 360; roll_deg += 180) {
                forged_cells cells;
                cells_of_id(true_ids[i], cells);
                const decoding *got = decode_cells(cells, sizes_px[s], roll_deg, "true marker");
                assert_true(assert_this_id_or_none(got, true_ids[i], cells));
                const bool left_to_right = got->cms[0].corners[1].x_px > got->cms[0].corners[0].x_px;
                assert_int_equal(left_to_right, roll_deg == 0);
            }
}

static bool is_alignment(int cell)
{
    const uint32_t both = tmi_dark_rows[cell / TAPEMARK_CELL_COLUMNS] | tmi_light_rows[cell / TAPEMARK_CELL_COLUMNS];
    return both >> (TAPEMARK_CELL_COLUMNS - 1 - cell % TAPEMARK_CELL_COLUMNS) & 1;
}

/* The checksum is right; a marker it is not. Where a cell is hardly larger than a pixel, the id may be read all the
 * same: it is the one that was meant. */
static void a_wrong_alignment_cell_is_seen(void **state)
{
    (void)state;
    int cells_tried = 0, believed = 0;
    for (int cell = 0; cell < TAPEMARK_CELLS; cell++) {
        if (!is_alignment(cell))
            continue;
        cells_tried++;
        for (size_t i = 0; i < COUNT_OF(true_ids); i++) {
            forged_cells cells;
            cells_of_id(true_ids[i], cells);
            cells[cell] = !cells[cell];
            for (size_t s = 0; s < COUNT_OF(sizes_px); s++) {
                const decoding *got = decode_cells(cells, sizes_px[s], 180 * (cell % 2), "alignment");
                const bool is_read = assert_this_id_or_none(got, true_ids[i], cells);
                believed += is_read;
                if (is_read && s > 0)
                    fail_msg("%s: id %d with alignment cell %d wrong was believed", got->name, (int)true_ids[i],
                             cell);
            }
        }
    }
    assert_int_equal(cells_tried, 26);
    assert_in_range(believed, 0, 5); /* of 182 at the smallest size */
}

static void a_checksum_wrong_by_a_bit_is_not_believed(void **state)
{
    (void)state;
    for (int bit = 0; bit < TMI_CHECKSUM_BITS; bit++)
        for (size_t i = 0; i < COUNT_OF(true_ids); i++)
            for (size_t s = 0; s < COUNT_OF(sizes_px); s++) {
                forged_cells cells;
                cells_of_id(true_ids[i], cells);
                cells[tmi_checksum_cell[bit]] = !cells[tmi_checksum_cell[bit]];
                const decoding *got = decode_cells(cells, sizes_px[s], 0, "checksum");
                if (assert_this_id_or_none(got, true_ids[i], cells))
                    fail_msg("%s: id %d was believed", got->name, (int)true_ids[i]);
            }
}

static void one_two_or_three_flipped_cells_make_no_other_id(void **state)
{
    (void)state;
    random_source source = {29};
    for (int count = 1; count <= 3; count++)
        for (int i = 0; i < 400; i++) {
            const int32_t id = random_id(&source);
            forged_cells cells;
            cells_of_id(id, cells);
            flip_cells(cells, count, &source);
            assert_this_id_or_none(decode_cells(cells, sizes_px[i % 3], 180 * (i % 2), "flipped"), id, cells);
        }
}

/* Two markers cut anywhere, half of the one beside half of the other. */
static void halves_of_two_markers_are_none(void **state)
{
    (void)state;
    random_source source = {31};
    for (int i = 0; i < 400; i++) {
        const int32_t left_id = random_id(&source), right_id = random_id(&source);
        forged_cells cells, right;
        cells_of_id(left_id, cells);
        cells_of_id(right_id, right);
        const int cut = 2 + i % (TAPEMARK_CELL_COLUMNS - 3);
        for (int cell = 0; cell < TAPEMARK_CELLS; cell++)
            if (cell % TAPEMARK_CELL_COLUMNS >= cut)
                cells[cell] = right[cell];
        const decoding *got = decode_cells(cells, sizes_px[i % 3], 0, "halves");
        assert_this_id_or_none(got, id_of_cells(cells), cells);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(true_markers_are_read_either_way_up),
        cmocka_unit_test(a_wrong_alignment_cell_is_seen),
        cmocka_unit_test(a_checksum_wrong_by_a_bit_is_not_believed),
        cmocka_unit_test(one_two_or_three_flipped_cells_make_no_other_id),
        cmocka_unit_test(halves_of_two_markers_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
