/* What light, lens, sensor, compression and backgrounds do to a picture, measured on pictures of known content. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "scene.h"

enum { WIDTH_PX = 320, HEIGHT_PX = 240, PIXELS = WIDTH_PX * HEIGHT_PX };

static const int32_t ids[] = {7, -8, 9};
static uint8_t pixels[PIXELS], other[PIXELS];
static uint16_t samples[PIXELS];
static scene_truth truth;

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.4f is not within %.4f of %.4f", value, tolerance, expected);
}

static double mean_of(const uint8_t *image)
{
    double sum = 0;
    for (size_t i = 0; i < PIXELS; i++)
        sum += image[i];
    return sum / PIXELS;
}

static double deviation_of(const uint8_t *image)
{
    double mean = mean_of(image), power = 0;
    for (size_t i = 0; i < PIXELS; i++)
        power += (image[i] - mean) * (image[i] - mean);
    return sqrt(power / PIXELS);
}

static double difference_of(const uint8_t *a, const uint8_t *b)
{
    double power = 0;
    for (size_t i = 0; i < PIXELS; i++)
        power += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(power / PIXELS);
}

static uint8_t at(int32_t x, int32_t y)
{
    return pixels[y * WIDTH_PX + x];
}

static void render(const scene *view, uint8_t *image)
{
    if (!scene_render(view, image, &truth))
        fail_msg("%s", scene_problem(view));
}

/* A scene with one tape in it, in a place that stays. */
static scene scene_with_tape(scene view)
{
    static scene_tape tape;
    static scene_tape *const tapes = &tape;
    tape = scene_tape_of(ids, 3, true);
    scene_place(&view, &tape, (scene_pose){.px_per_module = 2.8, .yaw_deg = 20, .roll_deg = 8});
    view.tapes = tapes;
    view.tape_count = 1;
    return view;
}

/* A dark half, its edge upright in the middle of the image. */
static scene scene_with_edge(void)
{
    static const scene_cover half = {.x_px = WIDTH_PX, .y_px = HEIGHT_PX / 2.0, .width_px = WIDTH_PX,
                                     .height_px = 2 * HEIGHT_PX, .shade = 20};
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 220;
    view.covers = &half;
    view.cover_count = 1;
    return view;
}

/* Mean and variance in px of the slope of the edge along a row: where the edge is, and how wide. */
static void measure_edge(int32_t y, double *mean_px, double *variance_px)
{
    double sum = 0, first = 0, second = 0;
    for (int32_t x = 0; x + 1 < WIDTH_PX; x++) {
        double step = at(x, y) - at(x + 1, y), where = x + 0.5;
        sum += step;
        first += step * where;
        second += step * where * where;
    }
    *mean_px = first / sum;
    *variance_px = second / sum - *mean_px * *mean_px;
}

static void the_same_seed_gives_the_same_picture_and_another_does_not(void **state)
{
    (void)state;
    scene view = scene_with_tape(scene_default(WIDTH_PX, HEIGHT_PX));
    view.background.kind = SCENE_POPCORN;
    render(&view, pixels);
    render(&view, other);
    assert_memory_equal(pixels, other, PIXELS);
    view.seed++;
    render(&view, other);
    assert_true(difference_of(pixels, other) > 5);
}

/* Whatever rounds: geometry, panels, texels, noise, blur, gamma, compression. The sum was made on x86-64. */
static void the_same_scene_gives_the_same_picture_on_every_machine(void **state)
{
    (void)state;
    static const uint8_t texels[] = {250, 20, 90, 30, 200, 10};
    const scene_line line = {-2, -1.6, 2, -1.6};
    scene_panel panels[2 + SCENE_FURNISHING_MAX] = {scene_floor(-2, -2, 4, 4, 0), scene_wall(line, 2.4)};
    panels[0].look = SCENE_LOOK_WOOD;
    panels[0].scale_m = 0.1;
    scene view = scene_default(WIDTH_PX, HEIGHT_PX);
    view.panels = panels;
    view.panel_count = 2 + scene_furnish(line, 2.4, 11, panels + 2, SCENE_FURNISHING_MAX);
    scene_tape tape = scene_tape_of(ids, 3, true);
    scene_tape_on_wall(&tape, line, 1.3, 0.3);
    view.tapes = &tape;
    view.tape_count = 1;
    scene_picture picture = scene_picture_of(texels, 3, 2, 0.3);
    scene_picture_on_wall(&picture, line, 2.6, 1);
    view.pictures = &picture;
    view.picture_count = 1;
    view.camera = scene_plan_camera(200, scene_plan_point(0.3, 0.7, 0.8), -97, -7.3, 3.1);
    view.move.yaw_deg = 0.4;
    view.light = (scene_light){.gradient = 0.2, .gradient_deg = 37, .vignetting = 0.3};
    view.optics = (scene_optics){.defocus_px = 0.7, .motion_px = 1.3, .motion_deg = 21, .disc_px = 1.1};
    view.sensor.gamma = 2.2;
    view.sensor.bloom = 0.1;
    view.sensor.bloom_px = 2;
    view.sensor.pixel_noise = 0.5;
    view.sensor.jpeg_quality = 90;
    render(&view, pixels);
    assert_true(truth.cm_count > 0 && truth.picture_count == 1);
    uint32_t sum = 2166136261u;
    for (size_t i = 0; i < PIXELS; i++)
        sum = (sum ^ pixels[i]) * 16777619u;
    assert_int_equal(sum, 0xede6f520u);
}

static void defocus_widens_an_edge_and_keeps_its_place_and_the_light(void **state)
{
    (void)state;
    scene view = scene_with_edge();
    double before_px, after_px, variance_px;
    render(&view, pixels);
    double light = mean_of(pixels);
    measure_edge(100, &before_px, &variance_px);
    assert_near(variance_px, 0, 1e-9);
    for (double sigma = 0.5; sigma < 9; sigma *= 2) {
        view.optics.defocus_px = sigma;
        render(&view, pixels);
        measure_edge(100, &after_px, &variance_px);
        assert_near(after_px, before_px, 0.02);
        /* A pixel's share of a Gaussian is a little wider than the Gaussian. */
        assert_near(variance_px, sigma * sigma + 1 / 12.0, 0.04 * sigma * sigma + 0.01);
        assert_near(mean_of(pixels), light, 0.05);
    }
}

static void motion_widens_an_edge_only_along_itself(void **state)
{
    (void)state;
    scene view = scene_with_edge();
    double before_px, after_px, variance_px;
    render(&view, pixels);
    double light = mean_of(pixels);
    measure_edge(100, &before_px, &variance_px);
    for (double length = 2; length < 40; length *= 2.3) {
        view.optics = (scene_optics){.motion_px = length, .motion_deg = 0};
        render(&view, pixels);
        measure_edge(100, &after_px, &variance_px);
        assert_near(after_px, before_px, 0.02);
        assert_near(variance_px, length * length / 12, 0.02 * length * length / 12 + 0.25);
        assert_near(mean_of(pixels), light, 0.05);

        view.optics.motion_deg = 90;
        render(&view, pixels);
        measure_edge(100, &after_px, &variance_px);
        assert_near(variance_px, 0, 1e-3);

        view.optics.motion_deg = 60;
        render(&view, pixels);
        measure_edge(100, &after_px, &variance_px);
        assert_near(variance_px, length * length / 48, 0.05 * length * length / 48 + 0.25);
    }
}

static void exposure_scales_and_clips(void **state)
{
    (void)state;
    scene view = scene_with_edge();
    view.sensor.exposure = 0.5;
    render(&view, pixels);
    assert_int_equal(at(10, 10), 110);
    assert_int_equal(at(300, 10), 10);
    view.sensor.exposure = 4;
    render(&view, pixels);
    assert_int_equal(at(10, 10), 255);
    assert_int_equal(at(300, 10), 80);
    view.sensor.exposure = 0;
    render(&view, pixels);
    assert_int_equal(at(10, 10), 0);
}

static void gamma_keeps_shades_and_lets_light_win_at_edges(void **state)
{
    (void)state;
    scene view = scene_with_edge();
    double linear_px, curved_px, variance_px;
    view.optics.defocus_px = 3;
    render(&view, pixels);
    measure_edge(100, &linear_px, &variance_px);
    view.sensor.gamma = 2.2;
    render(&view, pixels);
    measure_edge(100, &curved_px, &variance_px);
    assert_int_equal(at(10, 10), 220);
    assert_int_equal(at(310, 10), 20);
    assert_true(curved_px > linear_px + 1);
}

static void noise_is_as_strong_as_asked(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 64;
    view.sensor.read_noise = 3;
    render(&view, pixels);
    assert_near(mean_of(pixels), 64, 0.1);
    assert_near(deviation_of(pixels), 3, 0.1);

    view.sensor.read_noise = 0;
    view.sensor.shot_noise = 8;
    render(&view, pixels);
    assert_near(mean_of(pixels), 64, 0.1);
    assert_near(deviation_of(pixels), 8 * sqrt(64 / 255.0), 0.1);
}

static void a_gradient_goes_its_way(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 100;
    view.light = (scene_light){.gradient = 0.8, .gradient_deg = 90};
    render(&view, pixels);
    /* The diagonal is 400 px. */
    assert_near(at(5, HEIGHT_PX / 2), 100, 1);
    assert_near(at(5, HEIGHT_PX / 2 + 100), 120, 1);
    assert_near(at(300, HEIGHT_PX / 2 - 100), 80, 1);
}

static void a_shadow_has_a_place_a_depth_and_an_edge(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 200;
    view.light = (scene_light){.shadow_depth = 0.7, .shadow_deg = 180, .shadow_offset_px = 40, .shadow_soft_px = 20};
    render(&view, pixels);
    int32_t edge = WIDTH_PX / 2 - 40;
    assert_int_equal(at(edge - 15, 50), 60);
    assert_int_equal(at(edge + 15, 50), 200);
    assert_near(at(edge, 50), 130, 5);
    assert_near(at(edge + 5, 50), 165, 5);
}

static void compression_loses_more_the_lower_the_quality(void **state)
{
    (void)state;
    scene view = scene_with_tape(scene_ideal(WIDTH_PX, HEIGHT_PX));
    render(&view, other);
    double before = 0;
    for (int quality = 100; quality >= 10; quality -= 30) {
        view.sensor.jpeg_quality = quality;
        render(&view, pixels);
        double lost = difference_of(pixels, other);
        assert_true(lost > before);
        assert_near(mean_of(pixels), mean_of(other), 2);
        before = lost;
    }
    view.sensor.jpeg_quality = 100;
    render(&view, pixels);
    assert_true(difference_of(pixels, other) < 1);
    assert_true(before > 5);
}

static void compression_at_its_best_changes_little_whatever_the_size(void **state)
{
    (void)state;
    scene view = scene_ideal(37, 21);
    view.light = (scene_light){.gradient = 1, .gradient_deg = 30};
    render(&view, other);
    view.sensor.jpeg_quality = 100;
    memset(pixels, 0x55, sizeof pixels);
    render(&view, pixels);
    for (size_t i = 0; i < 37 * 21; i++)
        assert_near(pixels[i], other[i], 2);
    for (size_t i = 37 * 21; i < PIXELS; i++)
        assert_int_equal(pixels[i], 0x55);
}

static void deeper_samples_are_the_same_picture(void **state)
{
    (void)state;
    scene view = scene_with_tape(scene_default(WIDTH_PX, HEIGHT_PX));
    render(&view, pixels);
    assert_true(scene_render_samples(&view, 10, samples, NULL));
    for (size_t i = 0; i < PIXELS; i++)
        assert_near(samples[i] * (255.0 / 1023), pixels[i], 0.65);
    assert_false(scene_render_samples(&view, 7, samples, NULL));
    assert_false(scene_render_samples(&view, 17, samples, NULL));
}

static void every_background_differs_and_keeps_its_shades(void **state)
{
    (void)state;
    static uint8_t seen[SCENE_CLUTTER_COUNT][PIXELS];
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background = (scene_background){.light = 200, .dark = 40, .scale_px = 4, .angle_deg = 10,
                                         .room = {.wall_z_m = 3, .floor_y_m = 0.5}};
    for (int kind = 0; kind < SCENE_CLUTTER_COUNT; kind++) {
        view.background.kind = (scene_clutter)kind;
        render(&view, seen[kind]);
        assert_int_equal(truth.cm_count, 0);
        assert_true((deviation_of(seen[kind]) < 1) == (kind == SCENE_PLAIN));
        assert_near(mean_of(seen[kind]), 125, 76);
        for (int before = 0; before < kind; before++)
            assert_true(difference_of(seen[kind], seen[before]) > 10);
    }
    double dark = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(seen[SCENE_CHECKERBOARD][i] == 40 || seen[SCENE_CHECKERBOARD][i] == 200);
        dark += seen[SCENE_CHECKERBOARD][i] == 40;
    }
    assert_near(dark / PIXELS, 0.5, 0.01);
}

static void patterns_have_their_scale_and_angle(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background = (scene_background){SCENE_BLINDS, .light = 200, .dark = 40, .scale_px = 10};
    render(&view, pixels);
    for (int32_t x = 0; x < WIDTH_PX; x++)
        assert_int_equal(at(x, 77), x / 10 % 2 ? 40 : 200);
    view.background.angle_deg = 90;
    render(&view, pixels);
    for (int32_t y = 1; y < HEIGHT_PX; y++)
        assert_int_equal(at(77, y), y / 10 % 2 ? 40 : 200);
}

static void a_room_has_a_wall_above_a_floor(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background = (scene_background){SCENE_ROOM, .light = 200, .dark = 100, .scale_px = 1,
                                         .room = {.wall_z_m = 2, .floor_y_m = 0.5}};
    render(&view, pixels);
    /* They meet at 0.5 / 2 of a focal length below the centre. */
    int32_t meet = HEIGHT_PX / 2 + WIDTH_PX / 4;
    assert_near(at(160, 20), 200, 11);
    assert_near(at(160, meet - 3), 200, 11);
    assert_near(at(160, meet + 6), 100, 6);
    assert_near(at(160, HEIGHT_PX - 1), 100, 6);
}

static void what_cannot_be_rendered_is_named(void **state)
{
    (void)state;
    enum { BAD = 13 };
    static const int32_t bad_id[] = {TAPEMARK_MAX_ID + 1};
    scene good = scene_with_tape(scene_default(WIDTH_PX, HEIGHT_PX));
    scene bad[BAD];
    scene_tape bad_tape = good.tapes[0], sizeless = good.tapes[0];
    bad_tape.ids = bad_id;
    bad_tape.cm_count = 1;
    sizeless.module_m = 0;
    for (size_t i = 0; i < BAD; i++)
        bad[i] = good;
    bad[0].width_px = 0;
    bad[1].height_px = SCENE_SIDE_MAX_PX + 1;
    bad[2].camera.focal_px = 0;
    bad[3].background.kind = SCENE_CLUTTER_COUNT;
    bad[4].background.scale_px = 0;
    bad[5].optics.defocus_px = -1;
    bad[6].optics.motion_px = 1e9;
    bad[7].sensor.exposure = (double)NAN;
    bad[8].sensor.jpeg_quality = 101;
    bad[9].sensor.read_noise = -1;
    bad[10].tapes = &bad_tape;
    bad[11].tapes = &sizeless;

    static int32_t many_ids[SCENE_CMS_MAX + 1];
    scene_tape long_tape = scene_tape_of(many_ids, SCENE_CMS_MAX + 1, false);
    bad[12].tapes = &long_tape;

    assert_null(scene_problem(&good));
    long_tape.cm_count = SCENE_CMS_MAX;
    assert_null(scene_problem(&bad[12]));
    long_tape.cm_count++;
    memset(pixels, 0x55, sizeof pixels);
    for (size_t i = 0; i < BAD; i++) {
        assert_non_null(scene_problem(&bad[i]));
        assert_false(scene_render(&bad[i], pixels, &truth));
    }
    for (size_t i = 0; i < PIXELS; i++)
        assert_int_equal(pixels[i], 0x55);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_seed_gives_the_same_picture_and_another_does_not),
        cmocka_unit_test(the_same_scene_gives_the_same_picture_on_every_machine),
        cmocka_unit_test(defocus_widens_an_edge_and_keeps_its_place_and_the_light),
        cmocka_unit_test(motion_widens_an_edge_only_along_itself),
        cmocka_unit_test(exposure_scales_and_clips),
        cmocka_unit_test(gamma_keeps_shades_and_lets_light_win_at_edges),
        cmocka_unit_test(noise_is_as_strong_as_asked),
        cmocka_unit_test(a_gradient_goes_its_way),
        cmocka_unit_test(a_shadow_has_a_place_a_depth_and_an_edge),
        cmocka_unit_test(compression_loses_more_the_lower_the_quality),
        cmocka_unit_test(compression_at_its_best_changes_little_whatever_the_size),
        cmocka_unit_test(deeper_samples_are_the_same_picture),
        cmocka_unit_test(every_background_differs_and_keeps_its_shades),
        cmocka_unit_test(patterns_have_their_scale_and_angle),
        cmocka_unit_test(a_room_has_a_wall_above_a_floor),
        cmocka_unit_test(what_cannot_be_rendered_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
