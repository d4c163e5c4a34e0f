/* Segments whose finder patterns are known: blocks of TMs, and CMs of far rows that were read before. */
#include "decoding.h"

#include "bars.h"

enum { WIDTH = 420, HEIGHT = 80, CMS = 3 };

static const int32_t ids[CMS] = {28, -29, -30};

/* A rendered TM, and its segment as it is found. */
typedef struct setting {
    uint8_t pixels[WIDTH * HEIGHT];
    scene_truth truth;
    tmi_view view;
    tmi_segment segment;
    tapemark_result result;
    tapemark_cm cms[2 * CMS];
    tapemark_tm tms[1];
    tapemark_config config;
    tmi_reader reader;
} setting;

static setting set;

static const scene_pose near_pose = {.px_per_module = 4};

/* A cover may lie on it. */
static void render(const scene_cover *cover)
{
    scene view = scene_default(WIDTH, HEIGHT);
    scene_tape tape = scene_tape_of(ids, CMS, true);
    scene_place(&view, &tape, near_pose);
    view.tapes = &tape;
    view.tape_count = 1;
    view.covers = cover;
    view.cover_count = cover ? 1 : 0;
    assert_true(scene_render(&view, set.pixels, &set.truth));
    assert_int_equal(set.truth.cm_count, CMS);
    set.view = (tmi_view){.pixels = set.pixels, .width = WIDTH, .height = HEIGHT, .stride = WIDTH, .sign = 1};
    for (int i = 0; i <= CMS; i++)
        set.segment.finders[i] = finder_near_end(&set.view, set.truth.cms[i < CMS ? i : CMS - 1].corners, i == CMS);
    for (int i = 0; i < CMS; i++)
        tmi_marker_map(&set.segment.finders[i], &set.segment.finders[i + 1], &set.segment.maps[i]);
    set.config = (tapemark_config){.vote_min = 0.7f, .contrast_min = 6, .id_max = TAPEMARK_MAX_ID};
    set.result = (tapemark_result){.cms = set.cms, .cm_capacity = 2 * CMS, .tms = set.tms, .tm_capacity = 1};
    set.reader = (tmi_reader){.view = &set.view, .config = &set.config, .result = &set.result,
                              .work_max = UINT32_MAX, .words = {.id_max = TAPEMARK_MAX_ID}};
}

/* ---- Blocks ---------------------------------------------------------------------------------------------------- */

/* Covers the middle CM between its finder patterns, gaps included, over its whole height. */
static tmi_tm_reading read_covered(double shade)
{
    const scene_cover cover = {.x_px = 0.5 * (WIDTH - 1), .y_px = 0.5 * (HEIGHT - 1), .shade = shade,
                               .width_px = 18 * near_pose.px_per_module, .height_px = 9 * near_pose.px_per_module};
    render(&cover);
    tmi_tm_reading reading;
    assert_true(tmi_tm_read(&set.reader, &set.segment, 0, CMS, 0.5f, &reading));
    return reading;
}

static void blocks_are_read(void **state)
{
    (void)state;
    render(NULL);
    tmi_tm_reading reading;
    assert_true(tmi_tm_read(&set.reader, &set.segment, 0, CMS, 0.5f, &reading));
    assert_int_equal(reading.code, 4); /* 100 */
    assert_true(reading.vote > 0.99f);
}

/* What is as dark as the gaps beside it may be a shadow, or something that hides a light block as well as a dark
 * one. */
static void what_is_no_darker_than_its_gaps_is_no_dark_block(void **state)
{
    (void)state;
    for (double shade = 40; shade <= 100; shade += 10)
        assert_true(read_covered(shade).vote <= 0);
}

static void what_is_lighter_than_the_middle_is_a_light_block(void **state)
{
    (void)state;
    const tmi_tm_reading reading = read_covered(160);
    assert_int_equal(reading.code, 6);
    assert_true(reading.vote > 0.99f);
}

/* ---- Far rows -------------------------------------------------------------------------------------------------- */

/* The last CM and the first one were read before. */
static void read_before(void)
{
    for (int i = 0; i < 2; i++) {
        const scene_cm_truth *cm = &set.truth.cms[2 - 2 * i];
        set.cms[i] = (tapemark_cm){.id = cm->id, .confidence = 0.9f, .tm = -1, .slot = -1};
        memcpy(set.cms[i].corners, cm->corners, sizeof cm->corners);
    }
    set.result.cm_count = 2;
}

/* The same row seen from its other end. */
static void reverse_segment(void)
{
    tmi_finder reversed[CMS + 1];
    for (int i = 0; i <= CMS; i++) {
        reversed[i] = set.segment.finders[CMS - i];
        reversed[i].right = (tmi_point){-reversed[i].right.x, -reversed[i].right.y};
        reversed[i].down = (tmi_point){-reversed[i].down.x, -reversed[i].down.y};
    }
    memcpy(set.segment.finders, reversed, sizeof reversed);
    for (int i = 0; i < CMS; i++)
        tmi_marker_map(&set.segment.finders[i], &set.segment.finders[i + 1], &set.segment.maps[i]);
}

/* CMs that were read one by one come with their slots, once a far row shows the TM that they belong to; the one that
 * was not read is added. */
static void cms_read_before_are_told_their_tm(void **state)
{
    (void)state;
    for (int reversed = 0; reversed < 2; reversed++)
        for (int resolved = 0; resolved < 2; resolved++) {
            render(NULL);
            read_before();
            if (reversed)
                reverse_segment();
            const tmi_tm_reading sure = {.code = reversed ? 1 : 4, .vote = 1, .bars = 1};
            tmi_segment_read_far(&set.reader, &set.segment, CMS, &sure, 0, resolved);
            assert_int_equal(set.result.tm_count, 1);
            assert_string_equal(set.tms[0].code, "100");
            assert_true(set.tms[0].directed);
            assert_int_equal(set.result.cm_count, resolved ? CMS : 2);
            for (size_t i = 0; i < set.result.cm_count; i++) {
                assert_int_equal(set.cms[i].tm, 0);
                assert_in_range(set.cms[i].slot, 0, CMS - 1);
                assert_int_equal(set.cms[i].id, ids[set.cms[i].slot]);
            }
        }
}

static void cms_of_a_row_that_is_no_tm_have_no_slot(void **state)
{
    (void)state;
    render(NULL);
    read_before();
    tmi_segment_read_far(&set.reader, &set.segment, CMS, NULL, 0, true);
    assert_int_equal(set.result.tm_count, 0);
    assert_int_equal(set.result.cm_count, CMS);
    for (int i = 0; i < CMS; i++) {
        assert_int_equal(set.cms[i].tm, -1);
        assert_int_equal(set.cms[i].slot, -1);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_read),
        cmocka_unit_test(what_is_no_darker_than_its_gaps_is_no_dark_block),
        cmocka_unit_test(what_is_lighter_than_the_middle_is_a_light_block),
        cmocka_unit_test(cms_read_before_are_told_their_tm),
        cmocka_unit_test(cms_of_a_row_that_is_no_tm_have_no_slot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
