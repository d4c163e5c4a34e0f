/* Several tapes in a frame, and tapes of which something is missing. */
#include "decoding.h"

#include <math.h>

static const int32_t first_ids[] = {22, 23, -24, 25, -26, 27};
static const int32_t second_ids[] = {-42, 43, 44, -45};

static void reads_every_tape_in_the_frame(void **state)
{
    (void)state;
    scene view = scene_default(800, 600);
    static const int32_t lone_id[] = {-77};
    scene_tape tapes[5] = {scene_tape_of(first_ids, 6, true), scene_tape_of(second_ids, 4, true),
                           scene_tape_of(lone_id, 1, false), scene_tape_of(first_ids, 2, false),
                           scene_tape_of(second_ids, 3, true)};
    static const scene_pose poses[5] = {{.px_per_module = 3, .dy_px = -200, .roll_deg = 5},
                                        {.px_per_module = 4, .dy_px = 60, .roll_deg = 180, .yaw_deg = 20},
                                        {.px_per_module = 5, .dx_px = 200, .dy_px = 220},
                                        {.px_per_module = 2.5, .dx_px = -200, .dy_px = 220, .roll_deg = -20},
                                        {.px_per_module = 3, .dx_px = -330, .dy_px = 20, .roll_deg = 90}};
    for (size_t i = 0; i < 5; i++)
        scene_place(&view, &tapes[i], poses[i]);
    view.tapes = tapes;
    view.tape_count = 5;
    const decoding *got = decode_scene(&view, NULL, "five tapes");
    assert_all_read(got, &view, 0.5);
    assert_int_equal(got->result.tm_count, 3);
    assert_int_equal(got->result.cm_count, 16);
}

/* As on a shelf: with the default budget all are read, for where tapes are there is more to look for. */
static void reads_a_frame_full_of_tapes(void **state)
{
    (void)state;
    enum { TAPES = 10, CMS = 6 };
    scene view = scene_default(640, 480);
    int32_t ids[TAPES][CMS];
    scene_tape tapes[TAPES];
    for (int i = 0; i < TAPES; i++) {
        for (int k = 0; k < CMS; k++)
            ids[i][k] = (k + i) % 3 == 0 ? -(10 * i + k + 1) : 10 * i + k + 1;
        tapes[i] = scene_tape_of(ids[i], CMS, true);
        scene_place(&view, &tapes[i],
                    (scene_pose){.px_per_module = 1.5 + 0.15 * i, .dy_px = 44.0 * i - 200, .roll_deg = 1});
    }
    view.tapes = tapes;
    view.tape_count = TAPES;
    const decoding *got = decode_scene(&view, NULL, "ten tapes");
    assert_nothing_wrong(got, &view);
    if (got->result.cm_count < TAPES * CMS - 2 || got->result.tm_count < TAPES)
        fail_msg("%u CMs and %u TMs were read, limits %x", (unsigned)got->result.cm_count,
                 (unsigned)got->result.tm_count, (unsigned)got->result.stats.limits);
}

/* The second tape follows the first one on the same line, this many modules on. */
static void place_behind(const scene_tape *first, scene_tape *second, double gap_modules)
{
    const double along_m = first->module_m *
        ((double)tapemark_segment_width_modules(first->cm_count, first->bars) + gap_modules);
    *second = (scene_tape){.ids = second->ids, .cm_count = second->cm_count, .bars = second->bars,
                           .light = first->light, .dark = first->dark, .module_m = first->module_m,
                           .along = first->along, .down = first->down,
                           .origin_m = {first->origin_m.x + along_m * first->along.x,
                                        first->origin_m.y + along_m * first->along.y,
                                        first->origin_m.z + along_m * first->along.z}};
}

/* From a gap of five modules on, so that between the outermost finders there is about the length of a CM. */
static void reads_pieces_side_by_side(void **state)
{
    (void)state;
    for (int gap = 5; gap <= 13; gap++)
        for (int roll_deg = 0; roll_deg < 360; roll_deg += 180) {
            scene view = scene_default(840, 200);
            scene_tape tapes[2] = {scene_tape_of(second_ids, 4, true), scene_tape_of(first_ids, 4, true)};
            scene_place(&view, &tapes[0],
                        (scene_pose){.px_per_module = 3, .dx_px = roll_deg ? 215 : -215, .roll_deg = roll_deg});
            place_behind(&tapes[0], &tapes[1], gap);
            view.tapes = tapes;
            view.tape_count = 2;
            const decoding *got = decode_scene(&view, NULL, "pieces %d modules apart, roll %d", gap, roll_deg);
            assert_all_read(got, &view, 0.5);
            assert_int_equal(got->result.tm_count, 2);
        }
}

/* The border takes one module after the other: CMs that are left are read, and no TM that is not whole. */
static void tapes_cut_by_the_border_are_no_wrong_tms(void **state)
{
    (void)state;
    for (int shift = 0; shift <= 75; shift += 5) {
        one_tape all = place_tape(scene_default(520, 200), first_ids, 6, true,
                                  (scene_pose){.px_per_module = 3, .dx_px = 3.0 * shift, .roll_deg = 2});
        const decoding *got = decode_tape(&all, NULL, "cut by the border");
        assert_nothing_wrong(got, &all.view);
        if (!got->truth.tapes[0].whole)
            assert_int_equal(got->result.tm_count, 0);
        assert_all_read(got, &all.view, 0.5);
    }
}

static void a_covered_cm_is_a_gap_and_no_wrong_id(void **state)
{
    (void)state;
    for (int place = 0; place < 12; place++) {
        one_tape all = place_tape(scene_default(640, 200), first_ids, 6, true, (scene_pose){.px_per_module = 3.5});
        const scene_cover cover = {.x_px = 60 + 45.0 * place, .y_px = 100, .width_px = 35, .height_px = 60,
                                   .angle_deg = 15, .shade = place % 2 ? 40 : 150, .texture = 8};
        all.view.covers = &cover;
        all.view.cover_count = 1;
        const decoding *got = decode_tape(&all, NULL, "covered");
        assert_nothing_wrong(got, &all.view);
        size_t whole = 0;
        for (size_t i = 0; i < got->truth.cm_count; i++)
            whole += got->truth.cms[i].whole;
        if (count_read(got) + 1 < whole) /* one whose neighbour's finder is gone may go with it */
            fail_msg("cover at %d: %u of %u CMs were read", place, (unsigned)count_read(got), (unsigned)whole);
    }
}

/* How far off the CM of the result is that lies worst. */
static double worst_corner_px(const decoding *got)
{
    double worst = 0;
    for (size_t i = 0; i < got->result.cm_count; i++)
        for (size_t k = 0; k < got->truth.cm_count; k++)
            for (size_t c = 0; c < 4 && got->truth.cms[k].id == got->cms[i].id; c++)
                worst = fmax(worst, hypot((double)(got->truth.cms[k].corners[c].x_px - got->cms[i].corners[c].x_px),
                                          (double)(got->truth.cms[k].corners[c].y_px - got->cms[i].corners[c].y_px)));
    return worst;
}

/* The last finder of the one is a little more than a CM's length from the first of the other, and their bars are too
 * small to tell: no row is laid through both. */
static void small_pieces_side_by_side_are_where_they_are(void **state)
{
    (void)state;
    static const double sizes_px[] = {1.05, 1.15}, yaws_deg[] = {-20, 0, 10};
    size_t read = 0;
    for (size_t i = 0; i < COUNT_OF(sizes_px) * COUNT_OF(yaws_deg); i++)
        for (int gap = 3; gap <= 6; gap++) {
            scene view = scene_default(640, 160);
            scene_tape tapes[2] = {scene_tape_of(first_ids, 6, true), scene_tape_of(second_ids, 4, true)};
            scene_place(&view, &tapes[0], (scene_pose){.px_per_module = sizes_px[i / 3], .dx_px = -120, .roll_deg = 3,
                                                       .yaw_deg = yaws_deg[i % 3]});
            place_behind(&tapes[0], &tapes[1], gap);
            view.tapes = tapes;
            view.tape_count = 2;
            const decoding *got = decode_scene(&view, NULL, "%.2f px a module, yaw %.0f, %d modules apart",
                                               sizes_px[i / 3], yaws_deg[i % 3], gap);
            assert_nothing_wrong(got, &view);
            if (worst_corner_px(got) > 1.6)
                fail_msg("%s: a CM is off by %.2f px", got->name, worst_corner_px(got));
            read += got->result.cm_count;
        }
    assert_true(read > 150);
}

/* The upper half of the tape: bars and finders can be guessed, ids cannot. */
static void half_a_tape_is_no_wrong_id(void **state)
{
    (void)state;
    for (int lower_px = -14; lower_px <= 14; lower_px += 4) {
        one_tape all = place_tape(scene_default(640, 200), first_ids, 6, true, (scene_pose){.px_per_module = 3.5});
        const scene_cover cover = {.x_px = 320, .y_px = 100 + 30 + lower_px, .width_px = 700, .height_px = 60,
                                   .shade = 120};
        all.view.covers = &cover;
        all.view.cover_count = 1;
        const decoding *got = decode_tape(&all, NULL, "half covered");
        for (size_t i = 0; i < got->result.cm_count; i++)
            assert_int_equal(got->cms[i].id, first_ids[got->cms[i].slot < 0 ? i : (size_t)got->cms[i].slot]);
    }
}

/* Of the nine lines that vote, those that miss the bars of one end say nothing; the others are enough. */
static void bars_covered_in_part_are_bars(void **state)
{
    (void)state;
    for (int covered_px = 2; covered_px <= 26; covered_px += 2) {
        one_tape all = place_tape(scene_default(640, 160), first_ids, 5, true, (scene_pose){.px_per_module = 4});
        /* The tape is 28 px high and 592 px long with its bars; the last of them are covered from below. */
        const scene_cover cover = {
            .x_px = 604, .y_px = 94, .width_px = 64, .height_px = 2 * covered_px, .shade = 235};
        all.view.covers = &cover;
        all.view.cover_count = 1;
        const decoding *got = decode_tape(&all, NULL, "bars covered in part");
        assert_nothing_wrong(got, &all.view);
        if (covered_px <= 6) {
            assert_int_equal(got->result.tm_count, 1);
            assert_string_equal(got->tms[0].code, "11010");
        } else if (covered_px >= 16) {
            assert_int_equal(got->result.tm_count, 0);
        }
    }
}

/* Something dark on a light CM and the gaps at its ends makes no dark CM of it. */
static void a_covered_block_is_not_taken_for_a_dark_one(void **state)
{
    (void)state;
    static const double sizes_px[] = {1.4, 1.8, 2.2};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++)
        for (int cm = 0; cm < 2; cm++) {
            const double px = sizes_px[i];
            one_tape all = place_tape(scene_default(420, 100), first_ids, 5, true, (scene_pose){.px_per_module = px});
            const scene_cover cover = {.x_px = 210 + (cm - 2) * 25 * px, .y_px = 50, .width_px = 20 * px,
                                       .height_px = 6.5 * px, .shade = 70};
            all.view.covers = &cover;
            all.view.cover_count = 1;
            assert_nothing_wrong(decode_tape(&all, NULL, "a covered block"), &all.view);
        }
}

static void ids_need_not_ascend(void **state)
{
    (void)state;
    static const int32_t paper_tape[] = {17, -18, -19, -19, -20}, any[] = {900, -4, 120000, 5, -3};
    static const int32_t *const tapes[] = {paper_tape, any};
    for (size_t i = 0; i < COUNT_OF(tapes); i++) {
        one_tape all = place_tape(scene_default(640, 120), tapes[i], 5, true, (scene_pose){.px_per_module = 4});
        assert_all_read(decode_tape(&all, NULL, "ids in disorder"), &all.view, 0.5);
    }
}

static void segments_without_bars_are_no_tms(void **state)
{
    (void)state;
    one_tape all = place_tape(scene_default(640, 120), first_ids, 6, false, (scene_pose){.px_per_module = 3});
    const decoding *got = decode_tape(&all, NULL, "no bars");
    assert_all_read(got, &all.view, 0.5);
    assert_int_equal(got->result.tm_count, 0);
    for (size_t i = 0; i < got->result.cm_count; i++)
        assert_int_equal(got->cms[i].tm, -1);
}

/* As a printed tape hangs: pieces with their quiet zones, four modules between the bars. There are more finders in
 * the row than one look at it holds. */
static void reads_a_wall_full_of_tape(void **state)
{
    (void)state;
    enum { PIECES = 7, CMS = 6 };
    static int32_t ids[PIECES][CMS];
    static const char codes[PIECES][CMS + 1] = {"100000", "010000", "001000", "110000", "101000", "100100", "100010"};
    for (int roll_deg = 0; roll_deg < 360; roll_deg += 180) {
        scene view = scene_default(1960, 240);
        scene_tape tapes[PIECES];
        for (int i = 0; i < PIECES; i++)
            tapes[i] = scene_tape_of(ids[i], ids_for_code(codes[i], 1 + CMS * i, ids[i]), true);
        scene_place(&view, &tapes[0],
                    (scene_pose){.px_per_module = 1.5, .dx_px = roll_deg ? 800 : -800, .roll_deg = roll_deg});
        for (int i = 1; i < PIECES; i++)
            place_behind(&tapes[i - 1], &tapes[i], 4);
        view.tapes = tapes;
        view.tape_count = PIECES;
        const decoding *got = decode_scene(&view, NULL, "a wall full of tape, roll %d", roll_deg);
        assert_all_read(got, &view, 0.5);
        assert_int_equal(got->result.tm_count, PIECES);
        assert_int_equal(got->result.stats.limits & TAPEMARK_LIMIT_LENGTH, 0);
    }
}

/* Finder patterns and blocks as on a tape, between gratings of so many bars. */
static size_t tms_between_bars(int bars)
{
    enum { CMS = 4, SIDE = 24, MODULES = 25 * CMS + 7, WIDTH = MODULES + 2 * SIDE, HEIGHT = TAPEMARK_HEIGHT_MODULES };
    uint8_t modules[HEIGHT * MODULES], texels[HEIGHT * WIDTH];
    assert_int_equal(tapemark_segment_draw(first_ids, CMS, false, modules, sizeof modules), TAPEMARK_OK);
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++) {
            const int at = column - SIDE, beyond = at < 0 ? -1 - at : at - MODULES;
            const bool dark = at >= 0 && at < MODULES ? modules[row * MODULES + at] != 0
                                                      : beyond % 2 == 1 && beyond < 2 * bars;
            texels[row * WIDTH + column] = dark ? 22 : 203;
        }
    scene view = scene_default(640, 160);
    scene_picture picture = scene_picture_of(texels, WIDTH, HEIGHT, 0.06);
    picture.border_m = 0.02;
    picture.border_shade = 203;
    scene_place_picture(&view, &picture, (scene_pose){.px_per_module = 3.5, .roll_deg = 2});
    view.pictures = &picture;
    view.picture_count = 1;
    return decode_scene(&view, NULL, "%d bars", bars)->result.tm_count;
}

static void gratings_are_no_bars(void **state)
{
    (void)state;
    assert_int_equal(tms_between_bars(4), 1);
    assert_int_equal(tms_between_bars(5), 0);
    assert_int_equal(tms_between_bars(8), 0);
}

static void tapes_are_read_before_clutter(void **state)
{
    (void)state;
    static const scene_background backgrounds[] = {
        {.kind = SCENE_NOISE, .light = 200, .dark = 60, .scale_px = 20},
        {.kind = SCENE_BLINDS, .light = 220, .dark = 70, .scale_px = 30, .angle_deg = 80},
        {.kind = SCENE_TEXT, .light = 230, .dark = 40, .scale_px = 2},
        {.kind = SCENE_GRID_CODES, .light = 230, .dark = 40, .scale_px = 4},
    };
    for (size_t i = 0; i < COUNT_OF(backgrounds); i++) {
        one_tape all = place_tape(scene_default(640, 480), first_ids, 6, true, (scene_pose){.px_per_module = 3});
        all.view.background = backgrounds[i];
        char name[32];
        snprintf(name, sizeof name, "background %u", (unsigned)i);
        assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
    }
}

/* A segment of more CMs than a TM may have is read in parts, and said to be too long; no TM is made up of a part. */
static void says_when_a_segment_is_too_long(void **state)
{
    (void)state;
    enum { CMS = 40 };
    static int32_t ids[CMS];
    for (int i = 0; i < CMS; i++)
        ids[i] = i % 3 == 1 ? -1 - i : 1 + i;
    one_tape all = place_tape(scene_default(2160, 60), ids, CMS, true, (scene_pose){.px_per_module = 2});
    const decoding *got = decode_tape(&all, NULL, "too long a tape");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(got->result.stats.limits & TAPEMARK_LIMIT_LENGTH, TAPEMARK_LIMIT_LENGTH);
    assert_int_equal(count_read(got), CMS);
    assert_int_equal(got->result.tm_count, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_every_tape_in_the_frame),
        cmocka_unit_test(reads_a_frame_full_of_tapes),
        cmocka_unit_test(reads_pieces_side_by_side),
        cmocka_unit_test(reads_a_wall_full_of_tape),
        cmocka_unit_test(tapes_cut_by_the_border_are_no_wrong_tms),
        cmocka_unit_test(a_covered_cm_is_a_gap_and_no_wrong_id),
        cmocka_unit_test(small_pieces_side_by_side_are_where_they_are),
        cmocka_unit_test(half_a_tape_is_no_wrong_id),
        cmocka_unit_test(bars_covered_in_part_are_bars),
        cmocka_unit_test(a_covered_block_is_not_taken_for_a_dark_one),
        cmocka_unit_test(ids_need_not_ascend),
        cmocka_unit_test(segments_without_bars_are_no_tms),
        cmocka_unit_test(gratings_are_no_bars),
        cmocka_unit_test(tapes_are_read_before_clutter),
        cmocka_unit_test(says_when_a_segment_is_too_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
