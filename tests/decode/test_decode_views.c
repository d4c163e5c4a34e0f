/* Tapes seen from all sides, whole and rendered, with a good camera in good light. */
#include <math.h>

#include "decoding.h"

static const int32_t five_ids[] = {28, -29, 30, 31, -32};

static void reads_a_single_cm_at_many_sizes(void **state)
{
    (void)state;
    static const double sizes_px[] = {1.5, 2, 2.5, 3, 4, 6, 9, 13, 19};
    static const int32_t ids[] = {0, -1, 57, -3081, 79157, -TAPEMARK_MAX_ID};
    for (size_t s = 0; s < COUNT_OF(sizes_px); s++)
        for (size_t i = 0; i < COUNT_OF(ids); i++) {
            const int32_t width_px = (int32_t)(34 * sizes_px[s]) + 40, height_px = (int32_t)(9 * sizes_px[s]) + 40;
            one_tape all = place_tape(scene_default(width_px, height_px), &ids[i], 1, false,
                                      (scene_pose){.px_per_module = sizes_px[s], .dx_px = 0.3, .dy_px = 0.7});
            char name[64];
            snprintf(name, sizeof name, "id %d at %g px a module", (int)ids[i], sizes_px[s]);
            assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
        }
}

static void reads_a_cm_that_fills_the_frame(void **state)
{
    (void)state;
    static const int32_t ids[] = {21, -16};
    static const double sizes_px[] = {2.5, 4, 7.6, 12, 18.6, 26};
    for (size_t s = 0; s < COUNT_OF(sizes_px); s++)
        for (size_t i = 0; i < COUNT_OF(ids); i++) {
            const int32_t width_px = (int32_t)(34 * sizes_px[s]), height_px = (int32_t)(9 * sizes_px[s]);
            one_tape all = place_tape(scene_default(width_px, height_px), &ids[i], 1, false,
                                      (scene_pose){.px_per_module = sizes_px[s]});
            char name[64];
            snprintf(name, sizeof name, "a CM %d wide over the frame, id %d", (int)width_px, (int)ids[i]);
            assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
        }
}

static void reads_a_cm_of_huge_modules(void **state)
{
    (void)state;
    one_tape all = place_tape(scene_default(2040, 540), &five_ids[1], 1, false, (scene_pose){.px_per_module = 60});
    assert_all_read(decode_tape(&all, NULL, "60 px a module"), &all.view, 0.5);
}

static void reads_tapes_of_all_lengths(void **state)
{
    (void)state;
    for (size_t count = TAPEMARK_TM_MIN_CMS; count <= 16; count++) {
        int32_t ids[16];
        for (size_t i = 0; i < count; i++)
            ids[i] = (int32_t)((i * i + count) % 3 == 0 ? -(100 + i) : 100 + i);
        one_tape all = place_tape(scene_default(1120, 120), ids, count, true,
                                  (scene_pose){.px_per_module = 2.5});
        char name[64];
        snprintf(name, sizeof name, "%u CMs", (unsigned)count);
        assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
    }
}

static void reads_the_longest_tape(void **state)
{
    (void)state;
    int32_t ids[TAPEMARK_TM_MAX_CMS];
    const size_t count = ids_for_code("10110111010001110110100100111010", 500, ids);
    one_tape all = place_tape(scene_default(1700, 60), ids, count, true, (scene_pose){.px_per_module = 2});
    assert_all_read(decode_tape(&all, NULL, "32 CMs"), &all.view, 0.5);
}

static void reads_in_all_rolls(void **state)
{
    (void)state;
    for (int roll_deg = 0; roll_deg < 360; roll_deg += 15) {
        one_tape all = place_tape(scene_default(480, 480), five_ids, 5, true,
                                  (scene_pose){.px_per_module = 3, .roll_deg = roll_deg});
        char name[64];
        snprintf(name, sizeof name, "roll %d", roll_deg);
        const decoding *got = decode_tape(&all, NULL, name);
        assert_all_read(got, &all.view, 0.5);
        assert_int_equal(got->result.tm_count, 1);
        assert_string_equal(got->tms[0].code, "10110");
        assert_true(got->tms[0].directed);
        for (size_t i = 0; i < 5; i++) /* reported in the order in which the tape reads */
            assert_int_equal(got->cms[i].id, five_ids[i]);
    }
}

static void reads_in_perspective(void **state)
{
    (void)state;
    static const scene_pose poses[] = {
        {.px_per_module = 4, .yaw_deg = 40},
        {.px_per_module = 4, .yaw_deg = -55},
        {.px_per_module = 4, .pitch_deg = 50},
        {.px_per_module = 4, .pitch_deg = -60},
        {.px_per_module = 4, .yaw_deg = 45, .pitch_deg = 30, .roll_deg = 20},
        {.px_per_module = 4, .yaw_deg = -50, .pitch_deg = -35, .roll_deg = 200},
        {.px_per_module = 5, .yaw_deg = 60, .roll_deg = 90},
    };
    for (size_t i = 0; i < COUNT_OF(poses); i++) {
        one_tape all = place_tape(scene_default(720, 720), five_ids, 5, true, poses[i]);
        char name[64];
        snprintf(name, sizeof name, "perspective %u", (unsigned)i);
        assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
    }
}

/* A tape on the floor ahead: its seven rows cover ten pixels, while modules are three pixels wide along it. */
static void reads_a_tape_on_the_floor(void **state)
{
    (void)state;
    one_tape all = place_tape(scene_default(640, 360), five_ids, 5, true,
                              (scene_pose){.px_per_module = 3, .pitch_deg = -67.6, .dy_px = 60});
    const decoding *got = decode_tape(&all, NULL, "on the floor");
    assert_true(got->truth.tapes[0].px_across < 10.0 / TAPEMARK_HEIGHT_MODULES);
    assert_all_read(got, &all.view, 0.5);
}

/* So steep that modules are four and six times as long one way as the other. */
static void reads_at_steep_angles(void **state)
{
    (void)state;
    static const scene_pose poses[] = {
        {.px_per_module = 5.5, .pitch_deg = 75, .roll_deg = 2},
        {.px_per_module = 8.5, .pitch_deg = -80, .roll_deg = -2},
        {.px_per_module = 7, .yaw_deg = 75},
        {.px_per_module = 7, .yaw_deg = -75, .pitch_deg = 5},
        {.px_per_module = 7, .yaw_deg = 75, .roll_deg = 90},
    };
    for (size_t i = 0; i < COUNT_OF(poses); i++) {
        scene view = scene_default(1200, 720);
        view.camera.focal_px = 3000;
        one_tape all = place_tape(view, five_ids, 5, true, poses[i]);
        char name[64];
        snprintf(name, sizeof name, "steep %u", (unsigned)i);
        assert_all_read(decode_tape(&all, NULL, name), &all.view, 0.5);
    }
}

/* Where a column of the picture of a flat tape lies when what is right of the fold is seen at a slant. */
static double folded(double x_px, double fold_px, double part)
{
    return x_px < fold_px ? x_px : fold_px + part * (x_px - fold_px);
}

/* Squeezes a picture's columns right of the fold to so large a part of their width. */
static void fold_rows(const uint8_t *flat, uint8_t *out, int32_t width_px, int32_t height_px, double fold_px,
                      double part)
{
    for (int32_t y = 0; y < height_px; y++)
        for (int32_t x = 0; x < width_px; x++) {
            const double from = x < fold_px ? x : fold_px + (x - fold_px) / part;
            const int32_t left = (int32_t)from < width_px - 2 ? (int32_t)from : width_px - 2;
            const double share = from < width_px - 1 ? from - left : 1;
            const uint8_t *at = &flat[y * width_px + left];
            out[y * width_px + x] = (uint8_t)((1 - share) * at[0] + share * at[1] + 0.5);
        }
}

static const scene_cm_truth *truth_of(const scene_truth *truth, const tapemark_cm *cm)
{
    for (size_t i = 0; i < truth->cm_count; i++)
        if (truth->cms[i].id == cm->id)
            return &truth->cms[i];
    fail_msg("CM %d is not there", (int)cm->id);
    return NULL;
}

/* How far a CM's corners are reported from where they are, along the picture, px; 0 where it is folded itself. */
static double off_by(const tapemark_cm *cm, const tapemark_point corners[4], double fold_px, double part)
{
    double most = 0, left = INFINITY, right = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const double x = (double)corners[i].x_px;
        most = fmax(most, fabs((double)cm->corners[i].x_px - folded(x, fold_px, part)));
        left = fmin(left, x);
        right = fmax(right, x);
    }
    return left < fold_px && fold_px < right ? 0 : most;
}

/* Round a corner of two walls: each CM lies where it lies, though no plane goes through them all. */
static void places_a_tape_round_a_corner(void **state)
{
    (void)state;
    enum { WIDTH = 720, HEIGHT = 80, FOLDS = 25, STEP_PX = 20 };
    static uint8_t flat[WIDTH * HEIGHT], bent[WIDTH * HEIGHT];
    static const double parts[] = {0.4, 0.6, 0.8};
    one_tape all = place_tape(scene_default(WIDTH, HEIGHT), five_ids, 5, true, (scene_pose){.px_per_module = 4.5});
    all.view.tapes = &all.tape;
    all.view.tape_count = 1;
    scene_truth truth;
    assert_true(scene_render(&all.view, flat, &truth));
    size_t read = 0;
    for (int fold = 0; fold < FOLDS; fold++)
        for (size_t p = 0; p < COUNT_OF(parts); p++) {
            const double fold_px = WIDTH / 2 + STEP_PX * (fold - FOLDS / 2);
            fold_rows(flat, bent, WIDTH, HEIGHT, fold_px, parts[p]);
            const decoding *got = decode_pixels(bent, WIDTH, HEIGHT, NULL);
            for (size_t i = 0; i < got->result.cm_count; i++) {
                const tapemark_cm *cm = &got->cms[i];
                const double off = off_by(cm, truth_of(&truth, cm)->corners, fold_px, parts[p]);
                if (off > 1.5)
                    fail_msg("folded at %g px to %g: CM %d is off by %.1f px", fold_px, parts[p],
                             (int)cm->id, off);
            }
            read += got->result.cm_count;
        }
    if (read < 240)
        fail_msg("%u CMs were read", (unsigned)read);
}

/* Below two pixels a module not every CM can be read; most are, and the code as a whole. */
static void reads_small_modules(void **state)
{
    (void)state;
    size_t read = 0, in_view = 0;
    for (int place = 0; place < 8; place++) {
        one_tape all = place_tape(scene_default(320, 120), five_ids, 5, true,
                                  (scene_pose){.px_per_module = 1.2, .dx_px = 0.13 * place, .dy_px = 0.3 * place});
        all.view.seed = (uint64_t)place;
        all.view.optics.defocus_px = 0.35;
        const decoding *got = decode_tape(&all, NULL, "1.2 px a module");
        assert_nothing_wrong(got, &all.view);
        read += count_read(got);
        in_view += got->truth.cm_count;
    }
    if (10 * read < 8 * in_view)
        fail_msg("at 1.2 px a module %u of %u CMs were read", (unsigned)read, (unsigned)in_view);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_single_cm_at_many_sizes),
        cmocka_unit_test(reads_a_cm_that_fills_the_frame),
        cmocka_unit_test(reads_a_cm_of_huge_modules),
        cmocka_unit_test(reads_tapes_of_all_lengths),
        cmocka_unit_test(reads_the_longest_tape),
        cmocka_unit_test(reads_in_all_rolls),
        cmocka_unit_test(reads_in_perspective),
        cmocka_unit_test(reads_a_tape_on_the_floor),
        cmocka_unit_test(reads_at_steep_angles),
        cmocka_unit_test(places_a_tape_round_a_corner),
        cmocka_unit_test(reads_small_modules),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
