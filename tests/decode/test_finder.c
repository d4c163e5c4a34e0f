/* Finder patterns: located and measured on rendered ones, seen from all sides. */
#include "decoding.h"

#include <math.h>

#include "finder.h"
#include "elementary.h"

enum { SIDE = 300 };

/* A picture with a CM in it, of whose finder patterns the left one is looked at. */
typedef struct pattern {
    uint8_t pixels[SIDE * SIDE];
    tmi_view view;
    double x, y;               /* its true centre */
    double right_x, right_y;   /* its true axes there, one module */
    double down_x, down_y;
} pattern;

static pattern seen;

static tapemark_point mixed(const tapemark_point c[4], double u, double v)
{
    /* Bilinear in the CM's corners: exact without perspective. */
    const double w[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
    tapemark_point out = {0, 0};
    for (int i = 0; i < 4; i++) {
        out.x_px += (float)(w[i] * (double)c[i].x_px);
        out.y_px += (float)(w[i] * (double)c[i].y_px);
    }
    return out;
}

/* Seen from so far away that there is next to no perspective; `squeeze` is how much narrower modules are across the
 * tape (in its own pitch) or along it (in yaw). Its left finder pattern lies near the picture's centre. */
static void render_pattern(double px_per_module, double roll_deg, double yaw_deg, double pitch_deg, double defocus_px)
{
    static const int32_t id = 57;
    scene view = scene_ideal(SIDE, SIDE);
    scene_truth truth;
    view.camera.focal_px = 1e5;
    view.optics.defocus_px = defocus_px;
    scene_tape tape = scene_tape_of(&id, 1, false);
    const direction along = direction_of(roll_deg);
    const double shift = 12.5 * px_per_module * direction_of(yaw_deg).x;
    scene_place(&view, &tape, (scene_pose){.px_per_module = px_per_module, .roll_deg = roll_deg, .yaw_deg = yaw_deg,
                                           .pitch_deg = pitch_deg, .dx_px = shift * along.x + 0.37,
                                           .dy_px = shift * along.y - 0.21});
    view.tapes = &tape;
    view.tape_count = 1;
    if (!scene_render(&view, seen.pixels, &truth))
        fail_msg("cannot be rendered: %s", scene_problem(&view));
    const tapemark_point *c = truth.cms[0].corners;
    const tapemark_point centre = mixed(c, 3.5 / 32, 0.5), right = mixed(c, 4.5 / 32, 0.5);
    const tapemark_point down = mixed(c, 3.5 / 32, 4.5 / 7);
    seen.x = (double)centre.x_px;
    seen.y = (double)centre.y_px;
    seen.right_x = (double)right.x_px - seen.x;
    seen.right_y = (double)right.y_px - seen.y;
    seen.down_x = (double)down.x_px - seen.x;
    seen.down_y = (double)down.y_px - seen.y;
    seen.view = (tmi_view){.pixels = seen.pixels, .width = SIDE, .height = SIDE, .stride = SIDE, .sign = 1};
}

/* As a scan line would find it: off the centre by up to half a module, with the module as long as it is along x. */
static bool locate(double off_u, double off_v, tmi_finder *finder)
{
    const tmi_point start = {(float)(seen.x + off_u * seen.right_x + off_v * seen.down_x),
                             (float)(seen.y + off_u * seen.right_y + off_v * seen.down_y)};
    const double det = seen.right_x * seen.down_y - seen.right_y * seen.down_x;
    const double u = seen.down_y / det, v = -seen.right_y / det; /* of one pixel along x */
    uint32_t reads = 0;
    const bool found =
        tmi_finder_locate(&seen.view, start, (float)(1 / fmax(fabs(u), fabs(v))), 150, finder, &reads);
    assert_in_range(reads, 1, 4000);
    return found;
}

/* The least difference of a true axis to any of the finder's, in parts of its length. */
static double axis_error(const tmi_finder *f, double x, double y)
{
    const double axes[4][2] = {{(double)f->right.x, (double)f->right.y}, {(double)f->down.x, (double)f->down.y},
                               {-(double)f->right.x, -(double)f->right.y}, {-(double)f->down.x, -(double)f->down.y}};
    double least = INFINITY;
    for (int i = 0; i < 4; i++)
        least = fmin(least, hypot(axes[i][0] - x, axes[i][1] - y) / hypot(x, y));
    return least;
}

static void assert_located(const char *what, double value, double centre_px, double axis_share)
{
    static const double offsets[][2] = {{0, 0}, {0.5, 0.3}, {-0.4, 0.5}};
    for (size_t i = 0; i < COUNT_OF(offsets); i++) {
        tmi_finder f;
        if (!locate(offsets[i][0], offsets[i][1], &f))
            fail_msg("%s %g: not located", what, value);
        const double off = hypot((double)f.centre.x - seen.x, (double)f.centre.y - seen.y);
        const double right = axis_error(&f, seen.right_x, seen.right_y);
        const double down = axis_error(&f, seen.down_x, seen.down_y);
        if (off > centre_px || right > axis_share || down > axis_share)
            fail_msg("%s %g: centre off by %.3f px, axes by %.3f and %.3f", what, value, off, right, down);
        assert_true(f.right.x * f.down.y - f.right.y * f.down.x > 0); /* right-handed */
        assert_true(f.score > 0.8f && f.score <= 1.001f);
        assert_true(f.light > f.dark + 40);
    }
}

/* ---- Located --------------------------------------------------------------------------------------------------- */

static void located_at_any_rotation(void **state)
{
    (void)state;
    for (double roll_deg = 0; roll_deg <= 90; roll_deg += 7.5) {
        render_pattern(4, roll_deg, 0, 0, 0.5);
        assert_located("roll", roll_deg, 0.1, 0.02);
    }
}

static void located_at_any_size(void **state)
{
    (void)state;
    static const double sizes_px[] = {1.5, 1.8, 2, 2.5, 3, 5, 8, 12, 20, 30, 40};
    for (size_t i = 0; i < COUNT_OF(sizes_px); i++) {
        render_pattern(sizes_px[i], 10, 0, 0, 0.4);
        assert_located("size", sizes_px[i], 0.1, sizes_px[i] < 2 ? 0.06 : 0.03);
    }
}

/* Down to a third of the width, in directions that are not the tape's own when it is turned as well. */
static void located_when_foreshortened(void **state)
{
    (void)state;
    static const double tilts_deg[] = {-70, -60, -45, 30, 48, 60, 70};
    for (size_t i = 0; i < COUNT_OF(tilts_deg); i++)
        for (double roll_deg = 0; roll_deg <= 90; roll_deg += 22.5) {
            const double px_per_module = 2.2 / direction_of(tilts_deg[i]).x;
            render_pattern(px_per_module, roll_deg, 0, tilts_deg[i], 0.4);
            assert_located("pitch", tilts_deg[i], 0.15, 0.04);
            render_pattern(px_per_module, roll_deg, tilts_deg[i], 0, 0.4);
            assert_located("yaw", tilts_deg[i], 0.15, 0.04);
        }
}

/* Down to a fifth of the width, where rows and columns of pixels run along the pattern's sides or nearly so. */
static void located_when_steep(void **state)
{
    (void)state;
    static const double tilts_deg[] = {-77, -74, 74, 77};
    for (size_t i = 0; i < COUNT_OF(tilts_deg); i++)
        for (int roll_deg = -8; roll_deg <= 98; roll_deg += roll_deg == 8 ? 74 : 4) {
            const double px_per_module = 1.6 / direction_of(tilts_deg[i]).x;
            render_pattern(px_per_module, roll_deg, 0, tilts_deg[i], 0.4);
            assert_located("pitch", tilts_deg[i], 0.15, 0.06);
            render_pattern(px_per_module, roll_deg, tilts_deg[i], 0, 0.4);
            assert_located("yaw", tilts_deg[i], 0.15, 0.06);
        }
}

static void located_when_sheared(void **state)
{
    (void)state;
    for (int yaw_deg = -55; yaw_deg <= 55; yaw_deg += 22)
        for (int pitch_deg = -55; pitch_deg <= 55; pitch_deg += 22) {
            render_pattern(6, 25, yaw_deg, pitch_deg, 0.5);
            assert_located("sheared by yaw", yaw_deg, 0.15, 0.03);
        }
}

static void located_through_blur(void **state)
{
    (void)state;
    for (double defocus_px = 0; defocus_px <= 2.4; defocus_px += 0.4) {
        render_pattern(4, 12, 0, 0, defocus_px);
        tmi_finder f;
        assert_true(locate(0.3, -0.2, &f));
        const double off = hypot((double)f.centre.x - seen.x, (double)f.centre.y - seen.y);
        if (off > 0.15)
            fail_msg("defocus %g: centre off by %.3f px", defocus_px, off);
    }
}

/* ---- Refined ------------------------------------------------------------------------------------------------ */

static tmi_finder true_finder(void)
{
    return (tmi_finder){.centre = {(float)seen.x, (float)seen.y},
                        .right = {(float)seen.right_x, (float)seen.right_y},
                        .down = {(float)seen.down_x, (float)seen.down_y}};
}

static void refining_pulls_back_what_is_off(void **state)
{
    (void)state;
    render_pattern(5, 17, 20, -30, 0.6);
    for (int i = 0; i < 8; i++) {
        tmi_finder f = true_finder();
        const float u = 0.45f * (float)cos(i), v = 0.45f * (float)sin(i);
        uint32_t reads = 0;
        f.centre = tmi_at(&f, u, v);
        f.right.x *= 1 + 0.05f * (float)(i % 3 - 1);
        f.down.y *= 1 - 0.05f * (float)(i % 2);
        tmi_finder_score(&seen.view, &f, &reads);
        const float before = f.score;
        assert_true(tmi_finder_refine(&seen.view, &f, &reads));
        assert_true(hypot((double)f.centre.x - seen.x, (double)f.centre.y - seen.y) < 0.1);
        assert_true(axis_error(&f, seen.right_x, seen.right_y) < 0.02);
        assert_true(axis_error(&f, seen.down_x, seen.down_y) < 0.02);
        assert_true(f.score > before);
    }
}

static void scores_tell_right_from_wrong_places(void **state)
{
    (void)state;
    render_pattern(4, 30, 0, 0, 0.5);
    uint32_t reads = 0;
    tmi_finder f = true_finder(), aside = f, inverted = f;
    aside.centre = tmi_at(&f, 2, 0);
    tmi_finder_score(&seen.view, &f, &reads);
    assert_int_equal(reads, 81);
    tmi_finder_score(&seen.view, &aside, &reads);
    assert_true(f.score > 0.9f && aside.score < 0.7f);
    const tmi_view negative = {.pixels = seen.pixels, .width = SIDE, .height = SIDE, .stride = SIDE, .invert = 255,
                               .sign = -1, .offset = 255};
    tmi_finder_score(&negative, &inverted, &reads);
    assert_true(inverted.score < -0.9f);
}

static void seeking_finds_what_is_modules_off(void **state)
{
    (void)state;
    render_pattern(4, 30, 0, 0, 0.5);
    const tmi_finder there = true_finder();
    for (int v = -1; v <= 1; v++)
        for (int u = -4; u <= 4; u++) {
            uint32_t reads = 0;
            tmi_finder f = there;
            f.centre = tmi_at(&there, (float)u, (float)v);
            tmi_finder_seek(&seen.view, &f, &reads);
            assert_int_equal(reads, 135);
            assert_true(f.score > 0.9f && f.light > f.dark + 100);
            assert_true(hypot((double)f.centre.x - seen.x, (double)f.centre.y - seen.y) < 0.01);
        }
}

/* ---- Rejected ----------------------------------------------------------------------------------------------- */

static void draw(int (*dark)(int x, int y))
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            seen.pixels[y * SIDE + x] = dark(x - SIDE / 2, y - SIDE / 2) ? 40 : 200;
    seen.view = (tmi_view){.pixels = seen.pixels, .width = SIDE, .height = SIDE, .stride = SIDE, .sign = 1};
}

static int nowhere(int x, int y)
{
    return (void)x, (void)y, 0;
}

static int checkerboard(int x, int y)
{
    return ((x + 1000) / 8 + (y + 1000) / 8) % 2 == 0;
}

static int stripes(int x, int y)
{
    return (void)y, (x + 1002) / 4 % 2 == 0;
}

static int cross_bars(int x, int y)
{
    return abs(x) < 6 || abs(y) < 6;
}

static int lone_square(int x, int y)
{
    return abs(x) < 6 && abs(y) < 6;
}

/* The core, with two bars at each side: 1:1:3:1:1 along x, not along y. */
static int bars_beside_a_core(int x, int y)
{
    return abs(y) < 60 && (abs(x) < 6 || (abs(x) >= 10 && abs(x) < 14));
}

static int half_a_pattern(int x, int y)
{
    const int ring = abs(x) > abs(y) ? abs(x) : abs(y);
    return y > 0 && (ring < 6 || (ring >= 10 && ring < 14));
}

static void what_is_no_pattern_is_not_believed(void **state)
{
    (void)state;
    static int (*const pictures[])(int, int) = {nowhere, checkerboard, stripes, cross_bars, lone_square,
                                                bars_beside_a_core, half_a_pattern};
    for (size_t i = 0; i < COUNT_OF(pictures); i++) {
        draw(pictures[i]);
        for (int off = -4; off <= 4; off += 2) {
            tmi_finder f = {.score = -1};
            uint32_t reads = 0;
            const tmi_point start = {(float)(SIDE / 2 + off), (float)(SIDE / 2 + off / 2)};
            const bool found = tmi_finder_locate(&seen.view, start, 4, 150, &f, &reads);
            if (found && f.score >= 0.6f)
                fail_msg("picture %u was taken for a finder pattern, score %.2f", (unsigned)i, (double)f.score);
        }
    }
}

/* A core and its light ring, in a dark plane. */
static int well(int x, int y)
{
    const int ring = abs(x) > abs(y) ? abs(x) : abs(y);
    return ring < 6 || ring >= 10;
}

/* A ray goes no further than the next ring can be: not over the whole plane around a square, light or dark. */
static void rays_that_meet_no_ring_cost_little(void **state)
{
    (void)state;
    static int (*const pictures[])(int, int) = {lone_square, well};
    for (size_t i = 0; i < COUNT_OF(pictures); i++) {
        draw(pictures[i]);
        tmi_finder f;
        uint32_t reads = 0;
        assert_false(tmi_finder_locate(&seen.view, (tmi_point){SIDE / 2, SIDE / 2}, 4, 150, &f, &reads));
        if (reads > 330)
            fail_msg("picture %u: %u pixels were read", (unsigned)i, (unsigned)reads);
    }
}

static void patterns_at_the_border_break_nothing(void **state)
{
    (void)state;
    draw(checkerboard);
    for (int y = -1; y <= SIDE; y += 7)
        for (int x = -1; x <= SIDE; x += x < 8 || x > SIDE - 16 ? 3 : 60) {
            tmi_finder f;
            uint32_t reads = 0;
            tmi_finder_locate(&seen.view, (tmi_point){(float)x, (float)y}, 5, 100, &f, &reads);
            assert_in_range(reads, 1, 4000);
        }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(located_at_any_rotation),
        cmocka_unit_test(located_at_any_size),
        cmocka_unit_test(located_when_foreshortened),
        cmocka_unit_test(located_when_steep),
        cmocka_unit_test(located_when_sheared),
        cmocka_unit_test(located_through_blur),
        cmocka_unit_test(refining_pulls_back_what_is_off),
        cmocka_unit_test(scores_tell_right_from_wrong_places),
        cmocka_unit_test(seeking_finds_what_is_modules_off),
        cmocka_unit_test(what_is_no_pattern_is_not_believed),
        cmocka_unit_test(rays_that_meet_no_ring_cost_little),
        cmocka_unit_test(patterns_at_the_border_break_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
