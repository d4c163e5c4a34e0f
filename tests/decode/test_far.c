/* Tapes far away, whose finder patterns are too small to be seen one by one: TMs by their waveform, down to 0.6 px a
 * module, and CMs as far as their words can be told from each other. */
#include "decoding.h"

#include "random.h"

enum { CMS = 6 };

typedef struct sweep {
    double px_per_module;
    double yaw_deg, roll_from_deg, roll_to_deg; /* yaw either way, up to this */
    scene_clutter background;
    double light;   /* shade of the background */
    double defocus_px;
    bool inverted;
    int cm_count;
    int sign; /* of all ids; 0: random */
} sweep;

static const sweep plain = {.yaw_deg = 10, .roll_from_deg = -15, .roll_to_deg = 15, .light = 160, .defocus_px = 0.5,
                            .cm_count = CMS};

static double between(random_source *source, double from, double to)
{
    return from + (to - from) * (double)(random_bits(source) >> 11) / 9007199254740992.0;
}

/* Ids that ascend, all of one sign; or light and dark at random, so that they do not read the same backwards. */
static void random_ids(random_source *source, int count, int sign, int32_t *ids)
{
    const int32_t first = 1 + (int32_t)between(source, 0, 900);
    bool symmetric = sign == 0;
    for (int i = 0; i < count; i++)
        ids[i] = sign * (first + i);
    while (symmetric) {
        for (int i = 0; i < count; i++)
            ids[i] = (random_bits(source) >> 40 & 1) != 0 ? first + i : -(first + i);
        for (int i = 0; i < count / 2; i++)
            symmetric = symmetric && (ids[i] < 0) == (ids[count - 1 - i] < 0);
    }
}

typedef struct tally {
    int tms, directed, cms;
} tally;

static void place_random(const sweep *s, random_source *source, scene *view, scene_tape *tape)
{
    if (s->inverted) {
        const double light = tape->light;
        tape->light = tape->dark;
        tape->dark = light;
    }
    scene_place(view, tape, (scene_pose){.px_per_module = s->px_per_module,
                                         .yaw_deg = between(source, -s->yaw_deg, s->yaw_deg),
                                         .roll_deg = between(source, s->roll_from_deg, s->roll_to_deg),
                                         .dx_px = between(source, -20, 20),
                                         .dy_px = between(source, -20, 20)});
}

/* Decodes `count` pictures; whatever is wrong in one fails the test. */
static tally read_sweep(const sweep *s, int count)
{
    tally sum = {0};
    for (int i = 0; i < count; i++) {
        random_source source = {(uint64_t)(i + 1)};
        int32_t ids[TAPEMARK_TM_MAX_CMS];
        random_ids(&source, s->cm_count, s->sign, ids);
        scene view = scene_default(340, 240);
        view.seed = (uint64_t)(i + 1);
        view.background = (scene_background){.kind = s->background, .light = s->light, .dark = 60, .scale_px = 40,
                                             .room = {3, 1}};
        view.optics.defocus_px = s->defocus_px;
        view.sensor.jpeg_quality = 90;
        scene_tape tape = scene_tape_of(ids, (size_t)s->cm_count, true);
        place_random(s, &source, &view, &tape);
        view.tapes = &tape;
        view.tape_count = 1;
        const tapemark_config config = {.polarity = s->inverted ? TAPEMARK_LIGHT_ON_DARK : TAPEMARK_DARK_ON_LIGHT};
        const decoding *got = decode_scene(&view, &config, "%g px a module, picture %d", s->px_per_module, i);
        assert_nothing_wrong(got, &view);
        sum.tms += (int)got->result.tm_count;
        sum.directed += got->result.tm_count > 0 && got->tms[0].directed;
        sum.cms += (int)got->result.cm_count;
    }
    return sum;
}

/* At least that many of twelve TMs are read, and all of them with their direction. */
static void assert_tms(sweep s, double px_per_module, int least)
{
    s.px_per_module = px_per_module;
    const tally sum = read_sweep(&s, 12);
    if (sum.tms < least || sum.directed < sum.tms)
        fail_msg("%g px a module: %d of 12 TMs were read, %d of them with direction; at least %d should be",
                 px_per_module, sum.tms, sum.directed, least);
}

static void reads_tms_down_to_0_6_px_a_module(void **state)
{
    (void)state;
    static const double sizes_px[] = {1.1, 1, 0.9, 0.8, 0.67, 0.6};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++)
        assert_tms(plain, sizes_px[i], 11);
}

static void reads_far_tms_of_all_lengths(void **state)
{
    (void)state;
    static const int counts[] = {3, 4, 8, 12};
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        sweep s = plain;
        s.cm_count = counts[i];
        assert_tms(s, 0.8, 10);
    }
}

/* Whose waveform holds least: finder patterns that are hardly lighter than what is between them. */
static void reads_far_tms_that_are_dark_throughout(void **state)
{
    (void)state;
    static const double sizes_px[] = {0.9, 0.8, 0.7};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++) {
        sweep s = plain;
        s.sign = -1;
        s.px_per_module = sizes_px[i];
        s.defocus_px = 0.3;
        const tally sum = read_sweep(&s, 12);
        if (sum.tms < 11)
            fail_msg("%g px a module, ids all negative: %d of 12 TMs were read; at least 11 should be", sizes_px[i],
                     sum.tms);
    }
}

static void reads_far_tms_in_sharp_pictures(void **state)
{
    (void)state;
    sweep s = plain;
    s.defocus_px = 0.1;
    assert_tms(s, 0.9, 11);
    assert_tms(s, 0.8, 11);
    assert_tms(s, 0.7, 9);
}

static void reads_far_tms_in_all_directions(void **state)
{
    (void)state;
    for (double roll_deg = 30; roll_deg < 360; roll_deg += 60) {
        sweep s = plain;
        s.roll_from_deg = roll_deg;
        s.roll_to_deg = roll_deg + 60;
        assert_tms(s, 0.7, 9);
    }
}

static void reads_far_tms_seen_at_an_angle(void **state)
{
    (void)state;
    sweep s = plain;
    s.yaw_deg = 30;
    assert_tms(s, 0.9, 8);
}

static void reads_far_tms_light_on_dark(void **state)
{
    (void)state;
    sweep s = plain;
    s.inverted = true;
    s.light = 90;
    assert_tms(s, 0.9, 10);
    assert_tms(s, 0.67, 10);
}

static void reads_far_tms_out_of_focus(void **state)
{
    (void)state;
    sweep s = plain;
    s.defocus_px = 0.8;
    assert_tms(s, 0.9, 10);
    assert_tms(s, 0.7, 10);
}

static void reads_far_tms_in_a_room(void **state)
{
    (void)state;
    sweep s = plain;
    s.background = SCENE_ROOM;
    s.light = 180;
    assert_tms(s, 0.8, 10);
}

static void reads_cms_from_one_pixel_a_module(void **state)
{
    (void)state;
    static const struct {
        double px;
        int least; /* of 72 */
    } limits[] = {{1.1, 70}, {1, 68}, {0.96, 60}};
    for (size_t i = 0; i < COUNT_OF(limits); i++) {
        sweep s = plain;
        s.px_per_module = limits[i].px;
        const int cms = read_sweep(&s, 12).cms;
        if (cms < limits[i].least)
            fail_msg("%g px a module: %d of 72 CMs were read; at least %d should be", limits[i].px, cms,
                     limits[i].least);
    }
}

/* The ids of the CMs that can be read stand in their places of the TM. */
static void cms_of_a_far_tm_have_their_slots(void **state)
{
    (void)state;
    static const int32_t ids[] = {7, -8, 9, -10, -11, 12};
    one_tape all = place_tape(scene_default(480, 270), ids, CMS, true,
                              (scene_pose){.px_per_module = 1.1, .roll_deg = 4});
    const decoding *got = decode_tape(&all, NULL, "slots");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(got->result.tm_count, 1);
    assert_true(got->result.cm_count > 3);
    for (size_t i = 0; i < got->result.cm_count; i++) {
        assert_int_equal(got->cms[i].tm, 0);
        assert_int_equal(got->cms[i].id, ids[got->cms[i].slot]);
    }
}

/* A row without bars is no TM. */
static void a_far_row_without_bars_is_no_tm(void **state)
{
    (void)state;
    static const int32_t ids[] = {7, -8, 9, -10, -11, 12};
    static const double sizes_px[] = {0.6, 0.75, 0.9};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++) {
        one_tape all = place_tape(scene_default(480, 270), ids, CMS, false,
                                  (scene_pose){.px_per_module = sizes_px[i], .roll_deg = 4});
        const decoding *got = decode_tape(&all, NULL, "no bars");
        assert_nothing_wrong(got, &all.view);
        assert_int_equal(got->result.tm_count, 0);
    }
}

/* A code that is cut by the image's border is not reported as a shorter one. */
static void a_far_tm_cut_by_the_border_is_not_read(void **state)
{
    (void)state;
    static const int32_t ids[] = {7, -8, 9, -10, -11, 12, 13, -14};
    for (double dx_px = 120; dx_px < 220; dx_px += 12.5) {
        one_tape all = place_tape(scene_default(320, 160), ids, 8, true,
                                  (scene_pose){.px_per_module = 0.8, .dx_px = dx_px, .roll_deg = 3});
        const decoding *got = decode_tape(&all, NULL, "cut");
        assert_nothing_wrong(got, &all.view);
        assert_int_equal(got->result.tm_count, 0);
    }
}

/* Where finder patterns pass for bars, a waveform fits other codes too: nothing is read. */
static void leaves_unread_what_is_too_small(void **state)
{
    (void)state;
    static const double sizes_px[] = {0.42, 0.46, 0.5};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++) {
        sweep s = plain;
        s.px_per_module = sizes_px[i];
        const tally sum = read_sweep(&s, 6);
        assert_int_equal(sum.tms, 0);
        assert_int_equal(sum.cms, 0);
    }
}

/* Bars that something lies on in part vote where they are seen; a TM may be lost by it, but none is made another. */
static void far_bars_covered_in_part_make_no_wrong_tm(void **state)
{
    (void)state;
    static const int32_t ids[] = {22, 23, -24, 25, -26};
    int read = 0;
    for (int i = 0; i < 40; i++) {
        const double px = i & 1 ? 1.2 : 0.9, half_px = px * (25 * 5 + 7 + 16) / 2;
        const scene_pose pose = {.px_per_module = px};
        one_tape all = place_tape(scene_default(320, 120), ids, COUNT_OF(ids), true, pose);
        const double end_px = half_px - 3.5 * px;
        const scene_cover cover = {.x_px = i & 2 ? 160 - end_px : 160 + end_px, .y_px = 60 + 3.5 * px,
                                   .width_px = 9 * px, .height_px = 0.4 * (1 + i / 4) * 2 * px,
                                   .shade = i / 4 % 2 ? 235 : 60};
        all.view.covers = &cover;
        all.view.cover_count = 1;
        const decoding *got = decode_tape(&all, NULL, "far bars covered in part");
        assert_nothing_wrong(got, &all.view);
        read += got->result.tm_count == 1;
    }
    assert_true(read >= 10);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_tms_down_to_0_6_px_a_module),
        cmocka_unit_test(reads_far_tms_of_all_lengths),
        cmocka_unit_test(reads_far_tms_that_are_dark_throughout),
        cmocka_unit_test(reads_far_tms_in_sharp_pictures),
        cmocka_unit_test(reads_far_tms_in_all_directions),
        cmocka_unit_test(reads_far_tms_seen_at_an_angle),
        cmocka_unit_test(reads_far_tms_light_on_dark),
        cmocka_unit_test(reads_far_tms_out_of_focus),
        cmocka_unit_test(reads_far_tms_in_a_room),
        cmocka_unit_test(reads_cms_from_one_pixel_a_module),
        cmocka_unit_test(leaves_unread_what_is_too_small),
        cmocka_unit_test(cms_of_a_far_tm_have_their_slots),
        cmocka_unit_test(a_far_row_without_bars_is_no_tm),
        cmocka_unit_test(a_far_tm_cut_by_the_border_is_not_read),
        cmocka_unit_test(far_bars_covered_in_part_make_no_wrong_tm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
