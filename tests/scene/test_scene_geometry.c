/* Where tapes are drawn, and that the truth says so: rendered without blur and noise, then measured. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "scene.h"

enum { WIDTH_PX = 960, HEIGHT_PX = 720, PIXELS = WIDTH_PX * HEIGHT_PX };

static const int32_t ids[] = {0, -1, 2};
static uint8_t pixels[PIXELS];
static scene_truth truth;

typedef struct setup {
    scene view;
    scene_tape tape;
} setup;

/* One tape on paper of its own shade, so that only ink is dark. */
static void prepare(setup *made, size_t cm_count, bool bars, scene_pose pose)
{
    made->view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    made->tape = scene_tape_of(ids, cm_count, bars);
    made->tape.light = made->view.background.light = 200;
    made->tape.dark = 0;
    scene_place(&made->view, &made->tape, pose);
    made->view.tapes = &made->tape;
    made->view.tape_count = 1;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.4f is not within %.4f of %.4f", value, tolerance, expected);
}

static double sample(double x_px, double y_px)
{
    int32_t x = (int32_t)floor(x_px), y = (int32_t)floor(y_px);
    assert_true(x >= 0 && y >= 0 && x + 1 < WIDTH_PX && y + 1 < HEIGHT_PX);
    double u = x_px - x, v = y_px - y;
    const uint8_t *at = pixels + y * WIDTH_PX + x;
    return (1 - v) * ((1 - u) * at[0] + u * at[1]) + v * ((1 - u) * at[WIDTH_PX] + u * at[WIDTH_PX + 1]);
}

static double distance_px(tapemark_point a, tapemark_point b)
{
    return hypot((double)(b.x_px - a.x_px), (double)(b.y_px - a.y_px));
}

/* How much further from a towards b an edge from light to dark lies than where it is expected. */
static double edge_offset_px(tapemark_point a, tapemark_point expected, tapemark_point b)
{
    enum { STEPS = 400 };
    double dx = (double)(b.x_px - a.x_px), dy = (double)(b.y_px - a.y_px), light = 0;
    for (int i = 0; i < STEPS; i++) {
        double share = (i + 0.5) / STEPS;
        light += sample((double)a.x_px + share * dx, (double)a.y_px + share * dy) / 200 / STEPS;
    }
    return light * distance_px(a, b) - distance_px(a, expected);
}

/* A point of a CM by the perspective of its true corners, in modules from its top left one. */
static tapemark_point point_of_cm(const tapemark_point corners[4], double along, double across)
{
    double x[4], y[4];
    for (int i = 0; i < 4; i++)
        x[i] = (double)corners[i].x_px, y[i] = (double)corners[i].y_px;
    double px = x[0] - x[1] + x[2] - x[3], py = y[0] - y[1] + y[2] - y[3];
    double ax = x[1] - x[2], ay = y[1] - y[2], bx = x[3] - x[2], by = y[3] - y[2];
    double g = (px * by - bx * py) / (ax * by - bx * ay), h = (ax * py - px * ay) / (ax * by - bx * ay);
    double u = along / TAPEMARK_CM_WIDTH_MODULES, v = across / TAPEMARK_HEIGHT_MODULES, w = 1 + g * u + h * v;
    return (tapemark_point){
        (float)((x[0] + (x[1] - x[0] + g * x[1]) * u + (x[3] - x[0] + h * x[3]) * v) / w),
        (float)((y[0] + (y[1] - y[0] + g * y[1]) * u + (y[3] - y[0] + h * y[3]) * v) / w),
    };
}

/* The outer edges of a CM's two finder patterns: top, bottom and outer side of each. Half a module to both sides
 * of an edge, there is nothing else. The mean over lines along the edge: a single one sees the pixels' steps. */
static void assert_edges_at_corners(const tapemark_point corners[4])
{
    enum { LINES = 30 };
    static const struct {
        double along, across, out_along, out_across;
    } edges[] = {
        {3.5, 0, 0, -0.45},  {3.5, 7, 0, 0.45},  {28.5, 0, 0, -0.45},
        {28.5, 7, 0, 0.45}, {0, 3.5, -0.45, 0}, {32, 3.5, 0.45, 0},
    };
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        double out_along = edges[i].out_along, out_across = edges[i].out_across, offset = 0;
        for (int line = 0; line < LINES; line++) {
            double shift = 4 * ((line + 0.5) / LINES - 0.5);
            double along = edges[i].along + (out_along == 0 ? shift : 0);
            double across = edges[i].across + (out_across == 0 ? shift : 0);
            offset += edge_offset_px(point_of_cm(corners, along + out_along, across + out_across),
                                     point_of_cm(corners, along, across),
                                     point_of_cm(corners, along - out_along, across - out_across)) / LINES;
        }
        assert_near(offset, 0, 0.02);
    }
}

static void true_corners_lie_on_rendered_edges(void **state)
{
    (void)state;
    static const struct {
        size_t cm_count;
        scene_pose pose;
    } cases[] = {
        {3, {.px_per_module = 8}},
        {3, {.px_per_module = 8.3, .dx_px = 0.37, .dy_px = -0.21}},
        {3, {.px_per_module = 8, .roll_deg = 33, .dx_px = 10}},
        {3, {.px_per_module = 6, .roll_deg = 90}},
        {2, {.px_per_module = 12, .roll_deg = 191, .yaw_deg = 20}},
        {1, {.px_per_module = 20, .yaw_deg = 40}},
        {1, {.px_per_module = 20, .yaw_deg = -40, .pitch_deg = 25, .roll_deg = 5}},
        {1, {.px_per_module = 20, .pitch_deg = -50, .roll_deg = 310}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setup made;
        prepare(&made, cases[i].cm_count, true, cases[i].pose);
        assert_true(scene_render(&made.view, pixels, &truth));
        assert_int_equal(truth.cm_count, cases[i].cm_count);
        for (size_t slot = 0; slot < truth.cm_count; slot++) {
            assert_int_equal(truth.cms[slot].id, ids[slot]);
            assert_int_equal(truth.cms[slot].slot, slot);
            assert_true(truth.cms[slot].whole);
            assert_edges_at_corners(truth.cms[slot].corners);
        }
    }
}

/* Ink in the picture, in square pixels. */
static double ink_area(void)
{
    double area = 0;
    for (size_t i = 0; i < PIXELS; i++)
        area += (200 - pixels[i]) / 200.0;
    return area;
}

static double dark_modules(size_t cm_count, bool bars)
{
    static uint8_t modules[7 * 128];
    assert_int_equal(tapemark_segment_draw(ids, cm_count, bars, modules, sizeof modules), TAPEMARK_OK);
    double count = 0;
    for (size_t i = 0; i < 7 * tapemark_segment_width_modules(cm_count, bars); i++)
        count += modules[i];
    return count;
}

static void all_the_ink_is_drawn_however_small(void **state)
{
    (void)state;
    static const double scales[] = {0.4, 0.6, 1, 1.7, 3, 5.5, 8};
    for (size_t i = 0; i < sizeof scales / sizeof scales[0]; i++) {
        for (int turned = 0; turned < 2; turned++) {
            setup made;
            prepare(&made, 3, true, (scene_pose){.px_per_module = scales[i], .roll_deg = turned ? 27 : 0});
            assert_true(scene_render(&made.view, pixels, NULL));
            double expected = dark_modules(3, true) * scales[i] * scales[i];
            assert_near(ink_area(), expected, 0.015 * expected);
        }
    }
}

static void every_module_is_drawn_where_it_belongs(void **state)
{
    (void)state;
    static uint8_t modules[7 * 128];
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 7, .yaw_deg = 25, .pitch_deg = 10, .roll_deg = 170});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_int_equal(tapemark_segment_draw(ids, 3, true, modules, sizeof modules), TAPEMARK_OK);
    for (size_t slot = 0; slot < 3; slot++) {
        for (size_t i = 0; i < 32 * 7; i++) {
            tapemark_point at = point_of_cm(truth.cms[slot].corners, (double)(i % 32) + 0.5, (double)(i / 32) + 0.5);
            bool dark = modules[i / 32 * 98 + 8 + 25 * slot + i % 32];
            assert_near(sample((double)at.x_px, (double)at.y_px), dark ? 0 : 200, 1);
        }
    }
}

static void poses_mean_what_they_say(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 1, false, (scene_pose){.px_per_module = 5, .dx_px = 31, .dy_px = -12});
    assert_true(scene_render(&made.view, pixels, &truth));
    const tapemark_point *corners = truth.cms[0].corners;
    assert_near((double)corners[0].x_px, (WIDTH_PX - 1) / 2.0 + 31 - 16 * 5, 1e-3);
    assert_near((double)corners[0].y_px, (HEIGHT_PX - 1) / 2.0 - 12 - 3.5 * 5, 1e-3);
    assert_near((double)corners[2].x_px, (WIDTH_PX - 1) / 2.0 + 31 + 16 * 5, 1e-3);
    assert_near((double)corners[2].y_px, (HEIGHT_PX - 1) / 2.0 - 12 + 3.5 * 5, 1e-3);
    assert_near(truth.cms[0].px_along, 5, 1e-6);
    assert_near(truth.cms[0].px_across, 5, 1e-6);
    assert_near(truth.cms[0].px_min, 5, 1e-6);

    prepare(&made, 1, false, (scene_pose){.px_per_module = 5, .roll_deg = 90});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_true(corners[1].y_px > corners[0].y_px + 100);

    prepare(&made, 1, false, (scene_pose){.px_per_module = 5, .yaw_deg = 60});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_true(corners[3].y_px - corners[0].y_px > corners[2].y_px - corners[1].y_px + 5);
    assert_near(truth.cms[0].px_along, 2.5, 0.01);
    assert_near(truth.cms[0].px_across, 5, 0.01);
    assert_near(truth.cms[0].px_min, 2.5, 0.01);

    prepare(&made, 1, false, (scene_pose){.px_per_module = 5, .pitch_deg = 60});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_true(corners[1].x_px - corners[0].x_px > corners[2].x_px - corners[3].x_px + 5);
    assert_near(truth.cms[0].px_across, 2.5, 0.01);
}

/* Where a camera at a place sees a tape that lies a metre ahead of the origin. */
static tapemark_point seen_from(scene_camera camera)
{
    setup made;
    prepare(&made, 1, false, (scene_pose){.px_per_module = 5});
    camera.focal_px = made.view.camera.focal_px;
    made.view.camera = camera;
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_int_equal(truth.cm_count, 1);
    return truth.cms[0].corners[0];
}

static void the_camera_turns_and_moves(void **state)
{
    (void)state;
    tapemark_point still = seen_from((scene_camera){0}), seen = seen_from((scene_camera){.yaw_deg = 5});
    assert_near((double)(seen.x_px - still.x_px), -WIDTH_PX * tan(5 * 3.14159265 / 180), 3);
    seen = seen_from((scene_camera){.pitch_deg = 5});
    assert_near((double)(seen.y_px - still.y_px), WIDTH_PX * tan(5 * 3.14159265 / 180), 3);
    seen = seen_from((scene_camera){.roll_deg = 10});
    assert_true(seen.y_px > still.y_px + 10);
    seen = seen_from((scene_camera){.position_m = {0.1, 0.05, 0}});
    assert_near((double)(seen.x_px - still.x_px), -0.1 * 5 * 7 / 0.06, 0.01);
    assert_near((double)(seen.y_px - still.y_px), -0.05 * 5 * 7 / 0.06, 0.01);
    seen = seen_from((scene_camera){.position_m = {0, 0, 0.5}});
    assert_true(seen.x_px < still.x_px - 20);
}

static void a_tape_is_placed_before_the_camera_wherever_it_stands(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 4, .yaw_deg = 30});
    assert_true(scene_render(&made.view, pixels, &truth));
    tapemark_point expected = truth.cms[2].corners[2];

    made.view.camera = (scene_camera){WIDTH_PX, {3, -1, 2}, 130, -35, 20};
    scene_place(&made.view, &made.tape, (scene_pose){.px_per_module = 4, .yaw_deg = 30});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_near((double)truth.cms[2].corners[2].x_px, (double)expected.x_px, 1e-2);
    assert_near((double)truth.cms[2].corners[2].y_px, (double)expected.y_px, 1e-2);
}

static void assert_no_tape_seen(const scene *view)
{
    assert_true(scene_render(view, pixels, &truth));
    assert_int_equal(truth.cm_count, 0);
    assert_int_equal(truth.tape_count, 0);
    for (size_t i = 0; i < PIXELS; i++)
        assert_int_equal(pixels[i], 200);
}

static void a_tape_behind_the_camera_or_seen_from_its_back_is_not_there(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 4});
    made.view.camera.yaw_deg = 180;
    assert_no_tape_seen(&made.view);
    made.view.camera.yaw_deg = 0;
    scene_place(&made.view, &made.tape, (scene_pose){.px_per_module = 4, .yaw_deg = 180});
    assert_no_tape_seen(&made.view);
    scene_place(&made.view, &made.tape, (scene_pose){.px_per_module = 4, .dx_px = 2000});
    assert_no_tape_seen(&made.view);
}

/* A tape that begins beside the camera and runs away from it: its near end is out of sight. */
static void a_tape_that_passes_the_camera_is_drawn_as_far_as_it_is_seen(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 4});
    made.tape.origin_m = (scene_vector){-0.15, -0.02, -0.05};
    made.tape.along = (scene_vector){0, 0, 1};
    made.view.tapes = &made.tape;
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_int_equal(truth.tape_count, 0);
    assert_true(truth.cm_count >= 1);
    assert_true(truth.cms[truth.cm_count - 1].whole);
    assert_int_equal(truth.cms[truth.cm_count - 1].slot, 2);
    bool ink_at_border = false;
    for (size_t y = 0; y < HEIGHT_PX; y++) {
        for (size_t x = 0; x < 30; x++)
            ink_at_border = ink_at_border || pixels[y * WIDTH_PX + x] == 0;
        for (size_t x = WIDTH_PX / 2; x < WIDTH_PX; x++)
            assert_int_equal(pixels[y * WIDTH_PX + x], 200);
    }
    assert_true(ink_at_border);
}

/* A huge tape on the ground below, seen by a camera that is tilted to its side: ground to the lower right. */
static void nothing_is_drawn_above_the_horizon(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 4});
    made.view.camera.roll_deg = 45;
    made.tape.light = 100;
    made.tape.module_m = 1;
    made.tape.origin_m = (scene_vector){-49, 1, 3.5};
    made.tape.along = (scene_vector){1, 0, 0};
    made.tape.down = (scene_vector){0, 0, -1};
    made.view.tapes = &made.tape;
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_true(pixels[PIXELS - 1] <= 100);
    for (size_t i = 0; i < PIXELS; i++) {
        if (i % WIDTH_PX + i / WIDTH_PX < (WIDTH_PX + HEIGHT_PX) / 2 - 3)
            assert_int_equal(pixels[i], 200);
    }
}

static void the_quiet_zone_is_one_module_and_two_at_the_ends_of_a_tm(void **state)
{
    (void)state;
    for (int bars = 0; bars < 2; bars++) {
        setup made;
        prepare(&made, 3, bars, (scene_pose){.px_per_module = 8});
        made.view.background.light = 100;
        assert_true(scene_render(&made.view, pixels, &truth));
        double left = (WIDTH_PX - 1) / 2.0 - 8 * (bars ? 98 : 82) / 2.0, top = (HEIGHT_PX - 1) / 2.0 - 28;
        double quiet = bars ? 16 : 8;
        assert_near(sample(left - quiet - 1.5, top + 20), 100, 0);
        assert_near(sample(left - quiet + 0.5, top + 20), 200, 0);
        assert_near(sample(left - 1.5, top + 20), 200, 0);
        assert_near(sample(left + 0.5, top + 20), 0, 0);
        assert_near(sample(left + 2.5, top - 9.5), 100, 0);
        assert_near(sample(left + 2.5, top - 7.5), 200, 0);
        double right = WIDTH_PX - 1 - left, bottom = HEIGHT_PX - 1 - top;
        assert_near(sample(right + quiet - 0.5, bottom + 7.5), 200, 0);
        assert_near(sample(right + quiet + 1.5, bottom + 7.5), 100, 0);
        assert_near(sample(right + quiet - 0.5, bottom + 9.5), 100, 0);
    }
}

static void what_the_border_or_a_cover_takes_is_not_whole(void **state)
{
    (void)state;
    setup made;
    prepare(&made, 3, true, (scene_pose){.px_per_module = 8, .dx_px = WIDTH_PX / 2.0});
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_int_equal(truth.cm_count, 2);
    assert_true(truth.cms[0].whole);
    assert_false(truth.cms[1].whole);
    assert_near(truth.cms[1].visible, 0.5, 0.02);
    assert_false(truth.tapes[0].whole);

    scene_place(&made.view, &made.tape, (scene_pose){.px_per_module = 8});
    const scene_cover cover = {.x_px = WIDTH_PX / 2.0, .y_px = HEIGHT_PX / 2.0, .width_px = 64, .height_px = 200,
                               .shade = 77};
    made.view.covers = &cover;
    made.view.cover_count = 1;
    assert_true(scene_render(&made.view, pixels, &truth));
    assert_int_equal(truth.cm_count, 3);
    assert_true(truth.cms[0].whole && truth.cms[2].whole);
    assert_false(truth.cms[1].whole);
    assert_near(truth.cms[1].visible, 0.75, 0.02);
    assert_near(sample(WIDTH_PX / 2.0 + 30, HEIGHT_PX / 2.0 + 90), 77, 0);
    assert_near(sample(WIDTH_PX / 2.0 + 35, HEIGHT_PX / 2.0 + 90), 200, 0);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(true_corners_lie_on_rendered_edges),
        cmocka_unit_test(all_the_ink_is_drawn_however_small),
        cmocka_unit_test(every_module_is_drawn_where_it_belongs),
        cmocka_unit_test(poses_mean_what_they_say),
        cmocka_unit_test(the_camera_turns_and_moves),
        cmocka_unit_test(a_tape_is_placed_before_the_camera_wherever_it_stands),
        cmocka_unit_test(a_tape_behind_the_camera_or_seen_from_its_back_is_not_there),
        cmocka_unit_test(a_tape_that_passes_the_camera_is_drawn_as_far_as_it_is_seen),
        cmocka_unit_test(nothing_is_drawn_above_the_horizon),
        cmocka_unit_test(the_quiet_zone_is_one_module_and_two_at_the_ends_of_a_tm),
        cmocka_unit_test(what_the_border_or_a_cover_takes_is_not_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
