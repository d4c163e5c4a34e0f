/* Bad light, bad optics, bad compression: tapes as real cameras deliver them. */
#include "decoding.h"

static const int32_t six_ids[] = {0, -1, -2, -3, -4, -5};

/* Six CMs across a picture of 640 x 480 px, 3 px a module. */
static one_tape usual_view(void)
{
    return place_tape(scene_default(640, 480), six_ids, 6, true,
                      (scene_pose){.px_per_module = 3, .yaw_deg = 20, .roll_deg = 8});
}

static void reads_a_dark_frame(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.view.sensor.exposure = 40.0 / 190; /* the paper has a shade of 190 */
    assert_all_read(decode_tape(&all, NULL, "peak gray 40"), &all.view, 0.5);
}

static void reads_an_over_exposed_frame(void **state)
{
    (void)state;
    static const double exposures[] = {1.5, 2.5};
    for (size_t i = 0; i < COUNT_OF(exposures); i++) {
        one_tape all = usual_view();
        all.view.sensor.exposure = exposures[i];
        all.view.background.light = 190;
        assert_all_read(decode_tape(&all, NULL, "over-exposed"), &all.view, 0.5);
    }
}

static void reads_under_a_gradient(void **state)
{
    (void)state;
    for (int direction_deg = 0; direction_deg < 360; direction_deg += 60) {
        one_tape all = usual_view();
        all.view.light.gradient = 1.4;
        all.view.light.gradient_deg = direction_deg;
        assert_all_read(decode_tape(&all, NULL, "gradient"), &all.view, 0.5);
    }
}

/* The shadow takes 60 % of the light; its edge runs across the tape, along it, and through a single CM. */
static void reads_across_the_edge_of_a_shadow(void **state)
{
    (void)state;
    static const double directions_deg[] = {0, 90, 45};
    for (size_t i = 0; i < COUNT_OF(directions_deg); i++)
        for (int offset_px = -60; offset_px <= 60; offset_px += 30) {
            one_tape all = usual_view();
            all.view.light = (scene_light){.shadow_depth = 0.6, .shadow_deg = directions_deg[i],
                                           .shadow_offset_px = offset_px, .shadow_soft_px = 6};
            const decoding *got = decode_tape(&all, NULL, "shadow");
            assert_nothing_wrong(got, &all.view);
            if (count_read(got) < 5)
                fail_msg("shadow towards %g at %d: %u of 6 CMs read", directions_deg[i], offset_px,
                         (unsigned)count_read(got));
        }
}

/* A tape in deep shade, of a few gray levels in all, beside sunlit wall. */
static void reads_in_deep_shade_beside_the_light(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.view.light = (scene_light){.shadow_depth = 0.96, .shadow_deg = 90, .shadow_offset_px = -150,
                                   .shadow_soft_px = 6};
    const decoding *got = decode_tape(&all, NULL, "deep shade");
    assert_nothing_wrong(got, &all.view);
    assert_true(count_read(got) >= 5);
}

/* Twenty gray levels in noise of three, as cameras have it in dim rooms, far enough for modules of 1.3 px. */
static void reads_dim_tapes_in_noise(void **state)
{
    (void)state;
    unsigned read = 0, shown = 0;
    for (int seed = 1; seed <= 5; seed++) {
        one_tape all = place_tape(scene_default(640, 480), six_ids, 6, true,
                                  (scene_pose){.px_per_module = 1.3, .roll_deg = 3 * seed});
        all.view.sensor.exposure = 20.0 / 170;
        all.view.sensor.read_noise = 3;
        all.view.seed = (uint64_t)seed;
        const decoding *got = decode_tape(&all, NULL, "dim and noisy");
        assert_nothing_wrong(got, &all.view);
        read += (unsigned)count_read(got);
        shown += COUNT_OF(six_ids);
    }
    if (read + 1 < shown)
        fail_msg("%u of %u CMs read", read, shown);
}

static void reads_through_jpeg(void **state)
{
    (void)state;
    static const int qualities[] = {80, 50, 30};
    for (size_t i = 0; i < COUNT_OF(qualities); i++) {
        one_tape all = usual_view();
        all.view.sensor.jpeg_quality = qualities[i];
        assert_all_read(decode_tape(&all, NULL, "JPEG"), &all.view, 0.75);
    }
}

/* In the worst compression ids may be lost, but none may be made up. */
static void heavy_jpeg_makes_up_nothing(void **state)
{
    (void)state;
    for (int quality = 5; quality <= 20; quality += 5)
        for (int roll_deg = 0; roll_deg < 90; roll_deg += 30) {
            one_tape all = place_tape(scene_default(640, 480), six_ids, 6, true,
                                      (scene_pose){.px_per_module = 2, .roll_deg = roll_deg});
            all.view.sensor.jpeg_quality = quality;
            assert_nothing_wrong(decode_tape(&all, NULL, "heavy JPEG"), &all.view);
        }
}

static void reads_in_noise(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        one_tape all = usual_view();
        all.view.seed = seed;
        all.view.sensor.read_noise = 3;
        all.view.sensor.shot_noise = 6;
        assert_all_read(decode_tape(&all, NULL, "noise"), &all.view, 0.75);
    }
}

static void reads_out_of_focus(void **state)
{
    (void)state;
    one_tape all = usual_view();
    all.view.optics.defocus_px = 1.2;
    assert_all_read(decode_tape(&all, NULL, "defocus"), &all.view, 0.5);
    all.view.optics.defocus_px = 1.5; /* half a module */
    const decoding *got = decode_tape(&all, NULL, "strong defocus");
    assert_nothing_wrong(got, &all.view);
    assert_int_equal(count_read(got), 6);
}

static void reads_in_motion(void **state)
{
    (void)state;
    for (int direction_deg = 0; direction_deg < 180; direction_deg += 45) {
        one_tape all = usual_view();
        all.view.optics.motion_px = 3; /* a whole module */
        all.view.optics.motion_deg = direction_deg;
        assert_all_read(decode_tape(&all, NULL, "motion"), &all.view, 0.75);
    }
}

/* Whatever blur and noise do to small modules: what is read is right. */
static void degraded_views_make_up_nothing(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        int32_t ids[4];
        for (size_t i = 0; i < 4; i++) {
            const int32_t id = (int32_t)((seed * 7919 + i * 104729) * 2654435761u % TAPEMARK_MAX_ID);
            ids[i] = (seed + i) % 2 ? id : -id;
        }
        one_tape all = place_tape(scene_default(400, 300), ids, 4, true,
                                  (scene_pose){.px_per_module = 1 + 0.1 * (double)(seed % 12),
                                               .yaw_deg = 9.0 * (double)(seed % 7) - 27,
                                               .roll_deg = 41.0 * (double)seed});
        all.view.seed = seed;
        all.view.optics.defocus_px = 0.3 + 0.2 * (double)(seed % 5);
        all.view.sensor.read_noise = (double)(seed % 9);
        all.view.sensor.jpeg_quality = seed % 3 ? 0 : 40;
        assert_nothing_wrong(decode_tape(&all, NULL, "degraded"), &all.view);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_dark_frame),
        cmocka_unit_test(reads_an_over_exposed_frame),
        cmocka_unit_test(reads_under_a_gradient),
        cmocka_unit_test(reads_across_the_edge_of_a_shadow),
        cmocka_unit_test(reads_in_deep_shade_beside_the_light),
        cmocka_unit_test(reads_dim_tapes_in_noise),
        cmocka_unit_test(reads_through_jpeg),
        cmocka_unit_test(heavy_jpeg_makes_up_nothing),
        cmocka_unit_test(reads_in_noise),
        cmocka_unit_test(reads_out_of_focus),
        cmocka_unit_test(reads_in_motion),
        cmocka_unit_test(degraded_views_make_up_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
