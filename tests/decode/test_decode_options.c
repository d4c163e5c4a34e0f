/* What each field of the configuration changes, and what the result arrays hold. */
#include "decoding.h"

#include <math.h>

static const int32_t five_ids[] = {28, -29, 30, 31, -32};

static one_tape usual_view(void)
{
    return place_tape(scene_default(640, 240), five_ids, 5, true, (scene_pose){.px_per_module = 4, .roll_deg = 4});
}

/* ---- Polarity -------------------------------------------------------------------------------------------- */

static void reads_light_on_dark_only_when_asked(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.tape.light = 32;
    all.tape.dark = 190;
    all.view.background.light = 70;
    const tapemark_config config = {.polarity = TAPEMARK_LIGHT_ON_DARK};
    assert_all_read(decode_tape(&all, &config, "light on dark"), &all.view, 0.5);
    assert_no_marker(decode_tape(&all, NULL, "light on dark, not asked for"));
}

/* ---- Roll ------------------------------------------------------------------------------------------------ */

/* A tape of which cells cannot be told apart, only blocks: each coding region is evenly as gray as it is on the
 * whole. Drawn in one of the four directions along rows and columns, quarter turns clockwise from the right. */
enum { SIDE_PX = 360, MODULE_PX = 2 };

static void draw_plain_blocks(int quarter_turns, uint8_t *pixels)
{
    static const int32_t ids[] = {0, -1, -2, 3, -4, -5};
    uint8_t modules[TAPEMARK_HEIGHT_MODULES * 200];
    const int width = (int)tapemark_segment_width_modules(COUNT_OF(ids), true);
    assert_int_equal(tapemark_segment_draw(ids, COUNT_OF(ids), true, modules, sizeof modules), TAPEMARK_OK);
    memset(pixels, 200, SIDE_PX * SIDE_PX);
    for (int y = 0; y < TAPEMARK_HEIGHT_MODULES * MODULE_PX; y++)
        for (int x = 0; x < width * MODULE_PX; x++) {
            const int column = x / MODULE_PX - TAPEMARK_BAR_MODULES - 8, cm = column / TAPEMARK_CM_PITCH_MODULES;
            const bool cell = column >= 0 && cm < (int)COUNT_OF(ids) &&
                              column % TAPEMARK_CM_PITCH_MODULES < TAPEMARK_CELL_COLUMNS;
            const bool dark = modules[y / MODULE_PX * width + x / MODULE_PX] != 0;
            const uint8_t gray = cell ? (ids[cm] < 0 ? 60 : 160) : dark ? 40 : 200;
            const int u = x + (SIDE_PX - width * MODULE_PX) / 2, v = y + 160;
            const int row[4] = {v, u, SIDE_PX - 1 - v, SIDE_PX - 1 - u};
            const int at[4] = {u, SIDE_PX - 1 - v, SIDE_PX - 1 - u, v};
            pixels[row[quarter_turns] * SIDE_PX + at[quarter_turns]] = gray;
        }
}

static const decoding *decode_plain_blocks(int quarter_turns, const tapemark_config *config)
{
    static uint8_t pixels[SIDE_PX * SIDE_PX];
    draw_plain_blocks(quarter_turns, pixels);
    return decode_pixels(pixels, SIDE_PX, SIDE_PX, config);
}

static void tells_no_direction_of_plain_blocks_without_a_hint(void **state)
{
    (void)state;
    for (int turns = 0; turns < 4; turns++) {
        const decoding *got = decode_plain_blocks(turns, NULL);
        assert_int_equal(got->result.cm_count, 0);
        assert_int_equal(got->result.tm_count, 1);
        assert_false(got->tms[0].directed);
        if (strcmp(got->tms[0].code, "100100") != 0)
            assert_string_equal(got->tms[0].code, "001001");
    }
}

static void tells_the_direction_of_plain_blocks_by_the_hint(void **state)
{
    (void)state;
    static const float hints_deg[][3] = {{0, 30, -360}, {90, 60, -270}, {180, -180, 150}, {270, -90, -60}};
    for (int turns = 0; turns < 4; turns++)
        for (int i = 0; i < 3; i++) {
            const tapemark_config config = {.roll_known = true, .roll_deg = hints_deg[turns][i]};
            const decoding *got = decode_plain_blocks(turns, &config);
            assert_int_equal(got->result.tm_count, 1);
            assert_true(got->tms[0].directed);
            assert_string_equal(got->tms[0].code, "100100");
            const tapemark_point *c = got->tms[0].corners;
            const float along[4] = {c[1].x_px - c[0].x_px, c[1].y_px - c[0].y_px, c[0].x_px - c[1].x_px,
                                    c[0].y_px - c[1].y_px};
            assert_true(along[turns] > 300); /* from left to right, as the tape reads */
        }
}

static void a_hint_across_the_tape_tells_nothing(void **state)
{
    (void)state;
    const tapemark_config config = {.roll_known = true, .roll_deg = 90};
    const decoding *got = decode_plain_blocks(0, &config);
    assert_int_equal(got->result.tm_count, 1);
    assert_false(got->tms[0].directed);
}

/* Where the marker can be seen to lie the other way round, it is right and the hint is not. */
static void a_near_tape_overrules_the_hint(void **state)
{
    (void)state;
    one_tape all = usual_view();
    const tapemark_config config = {.roll_known = true, .roll_deg = 184};
    assert_all_read(decode_tape(&all, &config, "against the hint"), &all.view, 0.5);
}

/* ---- Ids ------------------------------------------------------------------------------------------------- */

static void reports_known_ids_only(void **state)
{
    (void)state;
    static const int32_t known[] = {-32, -29, 5, 28};
    one_tape all = usual_view();
    const tapemark_config config = {.known_ids = known, .known_id_count = COUNT_OF(known)};
    const decoding *got = decode_tape(&all, &config, "known ids");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(got->result.cm_count, 3);
    assert_true(has_read(got, 28) && has_read(got, -29) && has_read(got, -32));
    assert_int_equal(got->result.stats.rejects[TAPEMARK_REJECT_UNKNOWN_ID], 2);
    assert_int_equal(got->result.tm_count, 1); /* its code is no id */
    assert_string_equal(got->tms[0].code, "10110");
}

static void an_empty_list_knows_no_id(void **state)
{
    (void)state;
    static const int32_t any = 28;
    one_tape all = usual_view();
    const tapemark_config config = {.known_ids = &any, .known_id_count = 0};
    assert_int_equal(decode_tape(&all, &config, "no id known")->result.cm_count, 0);
}

static void reports_no_id_beyond_id_max(void **state)
{
    (void)state;
    one_tape all = usual_view();
    const tapemark_config config = {.id_max = 30};
    const decoding *got = decode_tape(&all, &config, "id_max 30");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(got->result.cm_count, 3);
    assert_true(has_read(got, 28) && has_read(got, -29) && has_read(got, 30));
}

/* ---- Thresholds ------------------------------------------------------------------------------------------ */

static void confidence_min_sorts_out(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.view.optics.defocus_px = 1;
    const decoding *got = decode_tape(&all, NULL, "all");
    assert_int_equal(got->result.cm_count, 5);
    float least = 1, most = 0;
    for (size_t i = 0; i < 5; i++) {
        least = fminf(least, got->cms[i].confidence);
        most = fmaxf(most, got->cms[i].confidence);
    }
    assert_true(least < most);
    const tapemark_config between = {.confidence_min = 0.5f * (least + most)};
    got = decode_tape(&all, &between, "some");
    assert_in_range(got->result.cm_count, 1, 4);
    for (size_t i = 0; i < got->result.cm_count; i++)
        assert_true(got->cms[i].confidence >= between.confidence_min);
    const tapemark_config certain = {.confidence_min = 1};
    assert_int_equal(decode_tape(&all, &certain, "none")->result.cm_count, 0);
}

/* A dark strip over a light block: the lines through it see a dark one. */
static void vote_min_decides_about_a_tm(void **state)
{
    (void)state;
    one_tape all = place_tape(scene_default(640, 240), five_ids, 5, true, (scene_pose){.px_per_module = 4});
    const scene_cover strip = {.x_px = 320, .y_px = 109.5, .width_px = 60, .height_px = 8, .shade = 36};
    assert_true(decode_tape(&all, NULL, "no strip")->tms[0].vote >= 1.0f);
    all.view.covers = &strip;
    all.view.cover_count = 1;
    const decoding *got = decode_tape(&all, NULL, "strip");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(got->result.tm_count, 1);
    const float vote = got->tms[0].vote;
    assert_true(vote >= 0.7f && vote < 0.9f);
    const tapemark_config just_met = {.vote_min = vote}, just_missed = {.vote_min = vote + 0.01f};
    assert_int_equal(decode_tape(&all, &just_met, "vote_min met")->result.tm_count, 1);
    got = decode_tape(&all, &just_missed, "vote_min missed");
    assert_int_equal(got->result.tm_count, 0);
    assert_int_equal(got->result.stats.rejects[TAPEMARK_REJECT_VOTE], 1);
}

static void contrast_min_leaves_faint_tapes_out(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.tape.light = 140;
    all.tape.dark = 110;
    all.view.background.light = 140;
    all.view.sensor.read_noise = 0;
    all.view.sensor.shot_noise = 0;
    assert_all_read(decode_tape(&all, NULL, "30 gray levels"), &all.view, 0.5);
    const tapemark_config config = {.contrast_min = 60};
    assert_no_marker(decode_tape(&all, &config, "30 gray levels, 60 asked for"));
}

/* ---- Finder patterns ------------------------------------------------------------------------------------- */

static void reports_finder_patterns(void **state)
{
    (void)state;
    one_tape all = usual_view();
    const decoding *got = decode_tape(&all, NULL, "finder patterns");
    assert_in_range(got->result.finder_count, 6, got->result.stats.finders);
    for (size_t cm = 0; cm < got->truth.cm_count; cm++) {
        const tapemark_point *c = got->truth.cms[cm].corners;
        const double x = 0.5 * (double)(c[0].x_px + c[3].x_px) + (double)(c[1].x_px - c[0].x_px) * 3.5 / 32;
        const double y = 0.5 * (double)(c[0].y_px + c[3].y_px) + (double)(c[1].y_px - c[0].y_px) * 3.5 / 32;
        double least = INFINITY;
        for (size_t i = 0; i < got->result.finder_count; i++) {
            const tapemark_finder *f = &got->finders[i];
            least = fmin(least, hypot((double)f->centre.x_px - x, (double)f->centre.y_px - y));
            assert_true(f->score >= -1 && f->score <= 1);
        }
        assert_true(least < 0.3);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_light_on_dark_only_when_asked),
        cmocka_unit_test(tells_no_direction_of_plain_blocks_without_a_hint),
        cmocka_unit_test(tells_the_direction_of_plain_blocks_by_the_hint),
        cmocka_unit_test(a_hint_across_the_tape_tells_nothing),
        cmocka_unit_test(a_near_tape_overrules_the_hint),
        cmocka_unit_test(reports_known_ids_only),
        cmocka_unit_test(an_empty_list_knows_no_id),
        cmocka_unit_test(reports_no_id_beyond_id_max),
        cmocka_unit_test(confidence_min_sorts_out),
        cmocka_unit_test(vote_min_decides_about_a_tm),
        cmocka_unit_test(contrast_min_leaves_faint_tapes_out),
        cmocka_unit_test(reports_finder_patterns),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
