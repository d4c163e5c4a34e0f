/* Which pieces a tape is cut into: by the rules of the format alone, apart from how strip.c goes about it. */
#include "printing.h"
#include "strip.h"

static const print_settings all_of_it = {0};

/* A stretch of the tape with its columns; release both. */
typedef struct drawn_stretch {
    tape_stretches stretches;
    tape_columns columns;
} drawn_stretch;

static drawn_stretch draw_first_stretch(const hand_tape *tape)
{
    drawn_stretch first;
    error_text error = {""};
    if (!strip_select(&tape->layout, &all_of_it, false, &first.stretches, &error) ||
        !strip_draw(&tape->layout, &first.stretches.items[0], &first.columns, &error))
        fail_msg("%s", error.text);
    return first;
}

static void release(drawn_stretch *first)
{
    free(first->columns.columns);
    free(first->stretches.items);
}

static tape_pieces cut(const hand_tape *tape, const drawn_stretch *first, const strip_limits *limits)
{
    tape_pieces pieces = {0};
    int64_t needed_halves;
    assert_true(strip_cut(&tape->layout, &first->stretches.items[0], &first->columns, limits, &pieces,
                          &needed_halves));
    return pieces;
}

/* TMs of six and a CM that stands alone: 177 + 177 + 34 modules. */
static hand_tape two_tms_and_a_cm(void)
{
    static const int32_t ids[] = {0, -1, -2, -3, -4, -5, -6, 7, -8, -9, -10, -11, 12};
    static const hand_segment segments[] = {{0, 6, true}, {0, 6, true}, {0, 1, false}};
    return hand_tape_new(1, ids, segments, COUNT_OF(segments));
}

/* Whether a place is between segments, or within one the middle of a column without ink. */
static bool is_good_joint(const drawn_stretch *first, int64_t at_halves)
{
    int64_t module = at_halves / 2;
    if (at_halves == 2 * 177 || at_halves == 2 * 354)
        return true;
    bool quiet = module < 2 || (module >= 175 && module < 179) || (module >= 352 && module < 355) || module == 387;
    return at_halves % 2 != 0 && !quiet && first->columns.columns[module] == 0;
}

/* The fewest pieces there can be, each as long as it may be. */
static size_t fewest_pieces(const drawn_stretch *first, const strip_limits *limits)
{
    int64_t start = 0, end = first->stretches.items[0].end_halves;
    size_t count = 1;
    while (end - start > limits->longest_halves) {
        int64_t joint = start + limits->longest_joined_halves;
        while (joint > start && !is_good_joint(first, joint))
            joint--;
        assert_true(joint > start);
        start = joint;
        count++;
    }
    return count;
}

static void pieces_are_few_and_end_at_joints(void **state)
{
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    drawn_stretch first = draw_first_stretch(&tape);
    for (int64_t longest = 34; longest <= 800; longest++) {
        const strip_limits limits = {longest + 2, longest, false};
        tape_pieces pieces = cut(&tape, &first, &limits);
        assert_int_equal(pieces.count, fewest_pieces(&first, &limits));
        int64_t at_halves = 0;
        for (size_t i = 0; i < pieces.count; i++) {
            const tape_piece *piece = &pieces.items[i];
            assert_int_equal(piece->start_halves, at_halves);
            assert_int_equal(piece->number, i + 1);
            assert_int_equal(piece->joint_before, i > 0);
            assert_int_equal(piece->joint_after, i + 1 < pieces.count);
            at_halves = piece->end_halves;
            assert_true(at_halves - piece->start_halves <= (piece->joint_after ? longest : longest + 2));
            assert_true(!piece->joint_after || is_good_joint(&first, at_halves));
        }
        assert_int_equal(at_halves, 2 * (177 + 177 + 34));
        free(pieces.items);
    }
    release(&first);
    hand_tape_release(&tape);
}

/* Among cuts of as few pieces, those between segments: 180 modules would reach into the second TM. */
static void joints_lie_between_segments_where_they_can(void **state)
{
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    drawn_stretch first = draw_first_stretch(&tape);
    tape_pieces pieces = cut(&tape, &first, &(strip_limits){2 * 250, 2 * 250, false});
    assert_int_equal(pieces.count, 2);
    assert_int_equal(pieces.items[0].end_halves, 2 * 177);
    free(pieces.items);
    release(&first);
    hand_tape_release(&tape);
}

/* On a roll rather one piece more: two could do with a joint within the second TM. */
static void rolls_are_cut_between_segments(void **state)
{
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    drawn_stretch first = draw_first_stretch(&tape);
    const strip_limits sheet = {2 * 200, 2 * 200, false}, roll = {2 * 200, 2 * 200, true};
    tape_pieces few = cut(&tape, &first, &sheet), seams = cut(&tape, &first, &roll);
    assert_int_equal(few.count, 2);
    assert_int_equal(seams.count, 3);
    assert_int_equal(seams.items[0].end_halves, 2 * 177);
    assert_int_equal(seams.items[1].end_halves, 2 * 354);
    free(few.items);
    free(seams.items);
    release(&first);
    hand_tape_release(&tape);
}

/* A coding region cannot be cut: it and half of the light columns beside it take 17 modules. */
static void what_is_too_short_for_a_coding_region_is_refused(void **state)
{
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    drawn_stretch first = draw_first_stretch(&tape);
    tape_pieces pieces = {0};
    int64_t needed_halves = 0;
    assert_false(strip_cut(&tape.layout, &first.stretches.items[0], &first.columns, &(strip_limits){33, 33, false},
                           &pieces, &needed_halves));
    assert_int_equal(needed_halves, 34);
    assert_int_equal(pieces.count, 0);
    release(&first);
    hand_tape_release(&tape);
}

static void pieces_know_their_segments(void **state)
{
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    drawn_stretch first = draw_first_stretch(&tape);
    tape_pieces pieces = cut(&tape, &first, &(strip_limits){2 * 60, 2 * 60, false});
    for (size_t i = 0; i < pieces.count; i++) {
        for (size_t k = 0; k < tape.layout.segment_count; k++) {
            const layout_segment *segment = &tape.layout.segments[k];
            bool overlaps = 2 * (int64_t)segment->start_modules < pieces.items[i].end_halves &&
                            2 * strip_ink_end_modules(segment) > pieces.items[i].start_halves;
            bool listed = k >= pieces.items[i].segment_begin && k < pieces.items[i].segment_end;
            /* A piece without ink, between quiet zones, may list a neighbour. */
            assert_true(listed || !overlaps);
        }
        assert_in_range(pieces.items[i].segment_end - pieces.items[i].segment_begin, 1, 2);
    }
    free(pieces.items);
    release(&first);
    hand_tape_release(&tape);
}

/* ---- Selecting ----------------------------------------------------------------------------------------- */

static void assert_stretch(const tape_stretch *seen, int64_t start_halves, int64_t end_halves, bool cut_before,
                           bool cut_after)
{
    assert_int_equal(seen->start_halves, start_halves);
    assert_int_equal(seen->end_halves, end_halves);
    assert_int_equal(seen->cut_before, cut_before);
    assert_int_equal(seen->cut_after, cut_after);
}

/* Ids count without their signs; neighbours are one stretch, also from one segment into the next. */
static void ranges_select_code_markers(void **state)
{
    static const print_id_range only[] = {{1, 1}, {3, 4}, {11, 12}};
    static const print_settings settings = {.only = only, .only_count = COUNT_OF(only)};
    tape_stretches all;
    error_text error;
    (void)state;
    hand_tape tape = two_tms_and_a_cm();
    assert_true(strip_select(&tape.layout, &settings, false, &all, &error));
    assert_int_equal(all.count, 3);
    /* The first finder pattern of CM 1 begins 2 + 8 + 25 modules from the line's beginning. */
    assert_stretch(&all.items[0], 2 * 35 - 1, 2 * 67 + 1, true, true);
    assert_stretch(&all.items[1], 2 * 85 - 1, 2 * (110 + 32) + 1, true, true);
    assert_stretch(&all.items[2], 2 * (177 + 135) - 1, 2 * (354 + 34), true, false);
    assert_int_equal(all.items[2].segment_end - all.items[2].segment_begin, 2);
    free(all.items);
    assert_true(strip_select(&tape.layout, &settings, true, &all, &error));
    assert_int_equal(all.count, 4);
    free(all.items);
    hand_tape_release(&tape);
}

static void a_tape_is_one_stretch_a_line(void **state)
{
    static const int32_t ids[] = {1, 2, 3};
    static const hand_segment segments[] = {{0, 1, false}, {0, 1, false}, {1, 1, false}};
    tape_stretches all;
    error_text error;
    (void)state;
    hand_tape tape = hand_tape_new(1, ids, segments, COUNT_OF(segments));
    assert_true(strip_select(&tape.layout, &all_of_it, false, &all, &error));
    assert_int_equal(all.count, 2);
    assert_stretch(&all.items[0], 0, 2 * 68, false, false);
    assert_stretch(&all.items[1], 0, 2 * 34, false, false);
    free(all.items);
    /* With a gap between them, they are not printed as one. */
    tape.layout.segments[1].start_modules += 10;
    assert_true(strip_select(&tape.layout, &all_of_it, false, &all, &error));
    assert_int_equal(all.count, 3);
    free(all.items);
    hand_tape_release(&tape);
}

static void ids_that_do_not_exist_cannot_be_drawn(void **state)
{
    static const int32_t ids[] = {TAPEMARK_MAX_ID + 1};
    static const hand_segment segments[] = {{0, 1, false}};
    tape_stretches all;
    tape_columns drawn;
    error_text error = {""};
    (void)state;
    hand_tape tape = hand_tape_new(1, ids, segments, 1);
    assert_true(strip_select(&tape.layout, &all_of_it, false, &all, &error));
    assert_false(strip_draw(&tape.layout, &all.items[0], &drawn, &error));
    assert_non_null(strstr(error.text, "1505583"));
    free(all.items);
    hand_tape_release(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_are_few_and_end_at_joints),
        cmocka_unit_test(joints_lie_between_segments_where_they_can),
        cmocka_unit_test(rolls_are_cut_between_segments),
        cmocka_unit_test(what_is_too_short_for_a_coding_region_is_refused),
        cmocka_unit_test(pieces_know_their_segments),
        cmocka_unit_test(ranges_select_code_markers),
        cmocka_unit_test(a_tape_is_one_stretch_a_line),
        cmocka_unit_test(ids_that_do_not_exist_cannot_be_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
