/* Lens, sensor and motion of the camera: each measured against its own law. */
#include <string.h>

#include "near.h"
#include "scene.h"

enum { WIDTH_PX = 160, HEIGHT_PX = 120, PIXELS = WIDTH_PX * HEIGHT_PX };

static const int32_t ids[] = {7, -8, 9};
static uint16_t samples[PIXELS], other[PIXELS];
static scene_truth truth;

static void render(const scene *view, uint16_t *into)
{
    if (!scene_render_samples(view, 16, into, &truth))
        fail_msg("%s", scene_problem(view));
}

/* In gray levels. */
static double at(const uint16_t *picture, int32_t x, int32_t y)
{
    return picture[y * WIDTH_PX + x] * (255 / 65535.0);
}

static double mean_of(const uint16_t *picture)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += picture[i] * (255 / 65535.0);
    return sum / PIXELS;
}

static double deviation_of(const uint16_t *picture)
{
    double mean = mean_of(picture), power = 0;
    for (int i = 0; i < PIXELS; i++)
        power += pow(picture[i] * (255 / 65535.0) - mean, 2);
    return sqrt(power / PIXELS);
}

static scene plain(double shade)
{
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = shade;
    return view;
}

/* A bright square in the middle of the dark. */
static scene with_square(double side_px, double shade)
{
    static scene_cover square;
    square = (scene_cover){.x_px = 80, .y_px = 60, .width_px = side_px - 0.5, .height_px = side_px - 0.5,
                           .shade = shade};
    scene view = plain(0);
    view.covers = &square;
    view.cover_count = 1;
    return view;
}

/* ---- Lens ---------------------------------------------------------------------------------------------- */

static void vignetting_follows_the_cosine_to_the_fourth(void **state)
{
    (void)state;
    scene view = plain(200);
    view.light.vignetting = 0.4;
    render(&view, samples);
    const double cx = (WIDTH_PX - 1) / 2.0, cy = (HEIGHT_PX - 1) / 2.0, corner_px = hypot(cx, cy);
    assert_near(at(samples, 0, 0), 200 * 0.6, 0.01);
    assert_near(at(samples, WIDTH_PX - 1, HEIGHT_PX - 1), 200 * 0.6, 0.01);
    /* The tangent that belongs to the corner's loss, and from it the angle at each other place. */
    double corner_tangent = tan(acos(pow(0.6, 0.25)));
    for (int32_t x = 0; x < WIDTH_PX; x += 7) {
        double angle = atan(corner_tangent * hypot(x - cx, 20 - cy) / corner_px);
        assert_near(at(samples, x, 20), 200 * pow(cos(angle), 4), 0.01);
    }
    view.light.vignetting_px = cx;
    render(&view, samples);
    assert_near(at(samples, 0, HEIGHT_PX / 2), 200 * 0.6, 0.02);
}

static void defocus_of_a_disc_is_even_within_it_and_keeps_the_light(void **state)
{
    (void)state;
    static const double radii_px[] = {0.4, 1.3, 2.5, 6, 17.7};
    for (size_t i = 0; i < sizeof radii_px / sizeof radii_px[0]; i++) {
        double r = radii_px[i];
        scene view = with_square(1, 250);
        view.optics.disc_px = r;
        render(&view, samples);
        /* Each pixel of the disc may be rounded by half of 1 / 257 of a gray level. */
        assert_near(mean_of(samples) * PIXELS, 250, 0.3 + 0.002 * 3.15 * (r + 1) * (r + 1));
        double inside = 250 / fmax(3.14159265 * r * r, 1), variance = 0;
        for (int32_t x = -30; x <= 30; x++) {
            for (int32_t y = -30; y <= 30; y++) {
                double far = hypot(x, y), value = at(samples, 80 + x, 60 + y);
                variance += value / 250 * (x * x + y * y) / 2.0;
                if (far < r - 0.8)
                    assert_near(value, inside, 0.004 * inside + 0.003);
                if (far > r + 0.8)
                    assert_near(value, 0, 1e-9);
            }
        }
        if (r > 1)
            assert_near(variance, r * r / 4, 0.02 * r * r + 0.1);
    }
}

static void blur_keeps_the_light(void **state)
{
    (void)state;
    for (double sigma = 0.3; sigma < 8; sigma *= 2.1) {
        scene view = with_square(5, 250);
        view.optics.defocus_px = sigma;
        view.optics.motion_px = 2 * sigma;
        view.optics.motion_deg = 50;
        render(&view, samples);
        assert_near(mean_of(samples) * PIXELS, 25 * 250, 25 * 250 * 0.003);
    }
}

/* ---- Sensor -------------------------------------------------------------------------------------------- */

static void noise_is_normal_enough_and_without_pattern(void **state)
{
    (void)state;
    scene view = plain(100);
    view.sensor.read_noise = 5;
    render(&view, samples);
    double fourth = 0, beside = 0, below = 0;
    for (int i = 0; i < PIXELS - WIDTH_PX; i++) {
        double noise = (samples[i] * (255 / 65535.0) - 100) / 5;
        fourth += pow(noise, 4);
        beside += noise * (samples[i + 1] * (255 / 65535.0) - 100) / 5;
        below += noise * (samples[i + WIDTH_PX] * (255 / 65535.0) - 100) / 5;
    }
    assert_near(mean_of(samples), 100, 0.15);
    assert_near(deviation_of(samples), 5, 0.1);
    assert_near(fourth / PIXELS, 2.7, 0.15); /* 3 for a normal distribution, 2.7 for the sum of four even ones */
    assert_near(beside / PIXELS, 0, 0.03);
    assert_near(below / PIXELS, 0, 0.03);

    view.seed++;
    render(&view, other);
    double together = 0;
    for (int i = 0; i < PIXELS; i++)
        together += (samples[i] * (255 / 65535.0) - 100) * (other[i] * (255 / 65535.0) - 100) / 25;
    assert_near(together / PIXELS, 0, 0.03);
}

static void the_fixed_pattern_stays_with_the_sensor(void **state)
{
    (void)state;
    scene view = plain(100);
    view.sensor.pixel_noise = 3;
    view.sensor.sensor_seed = 5;
    render(&view, samples);
    assert_near(deviation_of(samples), 3, 0.1);
    view.seed += 17;
    render(&view, other);
    assert_memory_equal(samples, other, sizeof samples);
    view.sensor.sensor_seed = 6;
    render(&view, other);
    assert_memory_not_equal(samples, other, sizeof samples);

    view.sensor.pixel_noise = 0;
    view.sensor.column_noise = 4;
    render(&view, samples);
    assert_near(deviation_of(samples), 4, 0.8);
    for (int i = WIDTH_PX; i < PIXELS; i++)
        assert_int_equal(samples[i], samples[i % WIDTH_PX]);
}

static void over_exposure_clips_and_blooms(void **state)
{
    (void)state;
    scene view = with_square(9, 200);
    view.sensor.exposure = 4;
    render(&view, samples);
    assert_near(at(samples, 80, 60), 255, 0);
    assert_near(at(samples, 86, 60), 0, 0);

    view.sensor.bloom = 0.3;
    view.sensor.bloom_px = 3;
    render(&view, other);
    assert_near(at(other, 80, 60), 255, 0);
    assert_true(at(other, 86, 60) > 20);
    assert_near(at(other, 20, 60), 0, 0);
    /* What is beyond the well is 81 times 800 - 255; 0.3 of it is spread; what falls on the full square is lost. */
    double spread = 0, share_inside = 0;
    for (int i = 0; i < PIXELS; i++)
        spread += (other[i] - samples[i]) * (255 / 65535.0);
    /* The share of the Gaussian, from one place of the square to all of it, in one direction. */
    for (int a = -4; a <= 4; a++)
        for (int b = -4; b <= 4; b++)
            share_inside += (erf((a - b + 0.5) / (3 * sqrt(2))) - erf((a - b - 0.5) / (3 * sqrt(2)))) / 2 / 9;
    assert_near(spread, 0.3 * 81 * (800 - 255) * (1 - share_inside * share_inside), 0.01 * 0.3 * 81 * 545);
}

/* ---- Motion -------------------------------------------------------------------------------------------- */

/* A tape before a wall, in a room. */
static scene with_tape(void)
{
    static scene_tape tape;
    static scene_panel panels[2];
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    const scene_line line = {-2, -0.5, 2, -0.5};
    tape = scene_tape_of(ids, 3, true);
    scene_tape_on_wall(&tape, line, 1.6, 0.3);
    panels[0] = scene_floor(-2, -2, 4, 4, 0);
    panels[1] = scene_wall(line, 2);
    view.tapes = &tape;
    view.tape_count = 1;
    view.panels = panels;
    view.panel_count = 2;
    view.camera = scene_plan_camera(120, scene_plan_point(0, 0.3, 0.4), -90, -10, 3);
    return view;
}

static scene_camera moved(const scene *view, double exposures)
{
    scene_camera camera = view->camera;
    camera.position_m.x += exposures * view->move.by_m.x;
    camera.position_m.y += exposures * view->move.by_m.y;
    camera.position_m.z += exposures * view->move.by_m.z;
    camera.yaw_deg += exposures * view->move.yaw_deg;
    camera.pitch_deg += exposures * view->move.pitch_deg;
    camera.roll_deg += exposures * view->move.roll_deg;
    return camera;
}

static double largest_difference(const uint16_t *picture, const double *expected)
{
    double most = 0;
    for (int i = 0; i < PIXELS; i++) {
        double difference = fabs(picture[i] * (255 / 65535.0) - expected[i]);
        if (difference > most)
            most = difference;
    }
    return most;
}

static void a_moving_camera_sees_the_mean_of_its_poses(void **state)
{
    (void)state;
    enum { POSES = 24 };
    static double sums[PIXELS], one[PIXELS];
    static const scene_move moves[] = {
        {.by_m = {0.02, 0.01, 0}}, {.by_m = {0, 0, 0.04}}, {.yaw_deg = 1.5}, {.pitch_deg = -1, .roll_deg = 2},
    };
    for (size_t i = 0; i < sizeof moves / sizeof moves[0]; i++) {
        scene view = with_tape();
        view.move = moves[i];
        render(&view, samples);
        const tapemark_point corner = truth.cms[0].corners[0];
        memset(sums, 0, sizeof sums);
        scene still = view;
        still.move = (scene_move){.yaw_deg = 0};
        for (int k = 0; k < POSES; k++) {
            still.camera = moved(&view, (k + 0.5) / POSES - 0.5);
            render(&still, other);
            for (int p = 0; p < PIXELS; p++)
                sums[p] += other[p] * (255 / 65535.0) / POSES;
        }
        /* Steps of half a pixel leave an edge with a contrast of 158 off by less than this. */
        assert_near(largest_difference(samples, sums), 0, 12);
        still.camera = view.camera;
        render(&still, other);
        for (int p = 0; p < PIXELS; p++)
            one[p] = other[p] * (255 / 65535.0);
        assert_true(largest_difference(samples, one) > 40);
        /* The truth is that of the middle of the exposure. */
        assert_near((double)corner.x_px, (double)truth.cms[0].corners[0].x_px, 1e-6);
        assert_near((double)corner.y_px, (double)truth.cms[0].corners[0].y_px, 1e-6);
    }
}

static void a_camera_that_hardly_moves_sees_what_a_still_one_does(void **state)
{
    (void)state;
    scene view = with_tape();
    render(&view, samples);
    view.move.by_m.x = 1e-9;
    render(&view, other);
    for (int i = 0; i < PIXELS; i++)
        assert_near(samples[i], other[i], 1);
}

/* Corners are there where a still camera sees them, if it stands where this one is when their row is exposed. */
static void a_rolling_shutter_sees_each_row_at_its_time(void **state)
{
    (void)state;
    scene view = with_tape();
    view.move = (scene_move){.by_m = {0.001, 0, 0}, .yaw_deg = 0.05, .readout = 60};
    render(&view, samples);
    assert_true(truth.cm_count > 0);
    const scene_truth rolling = truth;
    for (size_t i = 0; i < rolling.cm_count; i++) {
        for (int k = 0; k < 4; k++) {
            tapemark_point seen = rolling.cms[i].corners[k];
            scene still = view;
            still.camera = moved(&view, 60 * (((double)seen.y_px + 0.5) / HEIGHT_PX - 0.5));
            still.move = (scene_move){.yaw_deg = 0};
            render(&still, other);
            bool found = false;
            for (size_t j = 0; j < truth.cm_count; j++) {
                if (truth.cms[j].slot != rolling.cms[i].slot)
                    continue;
                found = true;
                assert_near((double)truth.cms[j].corners[k].x_px, (double)seen.x_px, 0.01);
                assert_near((double)truth.cms[j].corners[k].y_px, (double)seen.y_px, 0.01);
            }
            assert_true(found);
            /* And the row shows what that camera sees, but for its own little motion. */
            int32_t row = (int32_t)floor((double)seen.y_px + 0.5);
            for (int32_t x = 0; x < WIDTH_PX; x++)
                assert_near(at(samples, x, row), at(other, x, row), 40);
        }
    }
    scene global = view;
    global.move.readout = 0;
    render(&global, other);
    assert_true(fabs((double)(truth.cms[0].corners[0].x_px - rolling.cms[0].corners[0].x_px)) > 0.3);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(vignetting_follows_the_cosine_to_the_fourth),
        cmocka_unit_test(defocus_of_a_disc_is_even_within_it_and_keeps_the_light),
        cmocka_unit_test(blur_keeps_the_light),
        cmocka_unit_test(noise_is_normal_enough_and_without_pattern),
        cmocka_unit_test(the_fixed_pattern_stays_with_the_sensor),
        cmocka_unit_test(over_exposure_clips_and_blooms),
        cmocka_unit_test(a_moving_camera_sees_the_mean_of_its_poses),
        cmocka_unit_test(a_camera_that_hardly_moves_sees_what_a_still_one_does),
        cmocka_unit_test(a_rolling_shutter_sees_each_row_at_its_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
