/* Planned worlds: where things are on a plan, and what hides what, in the picture as in the truth. */
#include "near.h"
#include "scene.h"

enum { WIDTH_PX = 320, HEIGHT_PX = 240, PIXELS = WIDTH_PX * HEIGHT_PX };

static const int32_t ids[] = {0, -1, 2};
static uint8_t pixels[PIXELS];
static scene_truth truth;

/* A panel without any texture. */
static scene_panel flat(scene_panel panel, double shade)
{
    panel.look = SCENE_LOOK_PATTERN;
    panel.pattern = SCENE_BLINDS;
    panel.light = panel.dark = shade;
    return panel;
}

static void render(const scene *view)
{
    if (!scene_render(view, pixels, &truth))
        fail_msg("%s", scene_problem(view));
}

static uint8_t at(int32_t x, int32_t y)
{
    return pixels[y * WIDTH_PX + x];
}

/* ---- Places on a plan ---------------------------------------------------------------------------------- */

/* Where a camera on a plan sees a point on it, from the angles of the point's direction alone. Without roll. */
static tapemark_point seen_on_plan(double camera_x, double camera_y, double camera_height, double heading_deg,
                                   double pitch_deg, double focal_px, double x, double y, double height)
{
    double heading = heading_deg * 3.14159265358979 / 180, pitch = pitch_deg * 3.14159265358979 / 180;
    double away = (x - camera_x) * cos(heading) + (y - camera_y) * sin(heading);
    double right = (y - camera_y) * cos(heading) - (x - camera_x) * sin(heading);
    double up = height - camera_height;
    double depth = away * cos(pitch) + up * sin(pitch), above = up * cos(pitch) - away * sin(pitch);
    return (tapemark_point){(float)((WIDTH_PX - 1) / 2.0 + focal_px * right / depth),
                            (float)((HEIGHT_PX - 1) / 2.0 - focal_px * above / depth)};
}

static void assert_point(tapemark_point point, tapemark_point expected)
{
    assert_near((double)point.x_px, (double)expected.x_px, 2e-3);
    assert_near((double)point.y_px, (double)expected.y_px, 2e-3);
}

static void tapes_hang_and_lie_where_the_plan_says(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_tape tapes[2] = {scene_tape_of(ids, 1, false), scene_tape_of(ids, 1, false)};
    const double m = tapes[0].module_m, f = 250;
    /* A wall that runs down the plan faces left on it; the camera looks to the right. */
    scene_tape_on_wall(&tapes[0], (scene_line){3, 1, 3, 4}, 0.9, 0.4);
    scene_tape_on_floor(&tapes[1], (scene_line){2.2, 1.7, 2.6, 2}, 0.1);
    view.tapes = tapes;
    view.tape_count = 2;
    view.camera = scene_plan_camera(f, scene_plan_point(0.5, 2.5, 0.8), -10, -15, 0);
    render(&view);
    assert_int_equal(truth.cm_count, 2);

    const tapemark_point *hung = truth.cms[0].corners;
    double top = 0.4 + 3.5 * m, bottom = 0.4 - 3.5 * m, begin = 1.9, end = 1.9 + 32 * m;
    assert_point(hung[0], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, 3, begin, top));
    assert_point(hung[1], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, 3, end, top));
    assert_point(hung[2], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, 3, end, bottom));
    assert_point(hung[3], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, 3, begin, bottom));
    assert_true(hung[0].x_px < hung[1].x_px);

    /* The line's direction is (0.8, 0.6), its right on the plan (-0.6, 0.8). */
    const tapemark_point *laid = truth.cms[1].corners;
    double x = 2.2 + 0.1 * 0.8 + 0.6 * 3.5 * m, y = 1.7 + 0.1 * 0.6 - 0.8 * 3.5 * m, w = 32 * m, h = 7 * m;
    assert_point(laid[0], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, x, y, 0));
    assert_point(laid[1], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, x + 0.8 * w, y + 0.6 * w, 0));
    assert_point(laid[2], seen_on_plan(0.5, 2.5, 0.8, -10, -15, f, x + 0.8 * w - 0.6 * h, y + 0.6 * w + 0.8 * h, 0));

    /* Distance and angle of the first one, from its middle. */
    double dx = 2.5, dy = (begin + end) / 2 - 2.5, dz = 0.4;
    double distance = sqrt(dx * dx + dy * dy + dz * dz);
    assert_near(truth.cms[0].distance_m, distance, 1e-9);
    assert_near(truth.cms[0].angle_deg, acos(dx / distance) * 180 / 3.14159265358979, 1e-6);

    /* From the other side of the wall there is no tape. */
    view.camera = scene_plan_camera(f, scene_plan_point(5.5, 2.5, 0.8), 190, -15, 0);
    render(&view);
    assert_int_equal(truth.cm_count, 1);
    assert_int_equal(truth.cms[0].tape, 1);
}

static void pictures_hang_and_lie_as_tapes_do(void **state)
{
    (void)state;
    static const uint8_t texel[] = {200};
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_picture pictures[2] = {scene_picture_of(texel, 1, 1, 0.5), scene_picture_of(texel, 1, 1, 0.5)};
    scene_picture_on_wall(&pictures[0], (scene_line){3, 1, 3, 4}, 0.9, 1.2);
    scene_picture_on_floor(&pictures[1], (scene_line){2, 2.5, 3, 2.5}, 0.1);
    view.pictures = pictures;
    view.picture_count = 2;
    view.camera = scene_plan_camera(250, scene_plan_point(0.5, 2.5, 0.8), -10, -15, 0);
    render(&view);
    assert_int_equal(truth.picture_count, 2);
    assert_point(truth.pictures[0].corners[0], seen_on_plan(0.5, 2.5, 0.8, -10, -15, 250, 3, 1.9, 1.45));
    assert_point(truth.pictures[0].corners[2], seen_on_plan(0.5, 2.5, 0.8, -10, -15, 250, 3, 2.4, 0.95));
    assert_point(truth.pictures[1].corners[0], seen_on_plan(0.5, 2.5, 0.8, -10, -15, 250, 2.1, 2.25, 0));
    assert_point(truth.pictures[1].corners[2], seen_on_plan(0.5, 2.5, 0.8, -10, -15, 250, 2.6, 2.75, 0));
}

/* Where two panels of different shades meet, along a row. */
static void walls_floors_and_boxes_stand_where_the_plan_says(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    const scene_box box = {.x_m = 2, .y_m = 0.8, .width_m = 0.4, .depth_m = 0.6, .height_m = 0.3, .turned_deg = 0,
                           .shade = 60};
    scene_panel panels[2 + SCENE_BOX_PANELS] = {flat(scene_floor(0, -5, 10, 10, 0), 100),
                                                flat(scene_wall((scene_line){4, -5, 4, 5}, 2), 200)};
    scene_box_panels(&box, panels + 2);
    for (int i = 0; i < 5; i++)
        panels[2 + i] = flat(panels[2 + i], 40 + 5 * i);
    view.panels = panels;
    view.panel_count = 7;
    view.background.light = 255;
    view.camera = scene_plan_camera(250, scene_plan_point(0.2, 0, 1), 0, -10, 0);
    render(&view);
    float foot = seen_on_plan(0.2, 0, 1, 0, -10, 250, 4, 0, 0).y_px;
    float head = seen_on_plan(0.2, 0, 1, 0, -10, 250, 4, 0, 2).y_px;
    assert_int_equal(at(60, (int32_t)lroundf(foot) + 2), 100);
    assert_int_equal(at(60, (int32_t)lroundf(foot) - 2), 200);
    assert_int_equal(at(60, (int32_t)lroundf(head) + 2), 200);
    assert_int_equal(at(60, (int32_t)lroundf(head) - 2), 255);

    tapemark_point front = seen_on_plan(0.2, 0, 1, 0, -10, 250, 1.8, 0.8, 0.15);
    tapemark_point lid = seen_on_plan(0.2, 0, 1, 0, -10, 250, 2, 0.8, 0.3);
    tapemark_point left = seen_on_plan(0.2, 0, 1, 0, -10, 250, 2, 0.5, 0.15);
    assert_int_equal(at((int32_t)front.x_px, (int32_t)front.y_px), 55);
    assert_int_equal(at((int32_t)lid.x_px, (int32_t)lid.y_px), 60);
    assert_int_equal(at((int32_t)left.x_px, (int32_t)left.y_px), 40);
}

/* ---- What hides what ----------------------------------------------------------------------------------- */

/* A bare room in one shade. */
enum { ROOM_PANELS = 6 };

static void build_room(scene_panel panels[ROOM_PANELS], double shade)
{
    const scene_line walls[4] = {{0, 0, 4, 0}, {4, 0, 4, 3}, {4, 3, 0, 3}, {0, 3, 0, 0}};
    panels[0] = flat(scene_floor(0, 0, 4, 3, 0), shade);
    panels[1] = flat(scene_floor(0, 0, 4, 3, 2.5), shade);
    for (int i = 0; i < 4; i++)
        panels[2 + i] = flat(scene_wall(walls[i], 2.5), shade);
}

static void no_light_comes_through_where_walls_meet(void **state)
{
    (void)state;
    static const double headings_deg[] = {-40, 10, 47, 133, 200, 290};
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_panel panels[ROOM_PANELS];
    build_room(panels, 100);
    view.panels = panels;
    view.panel_count = ROOM_PANELS;
    view.background.light = 255;
    for (size_t i = 0; i < sizeof headings_deg / sizeof headings_deg[0]; i++) {
        const scene_vector place_m = scene_plan_point(2.2, 1.3, 1.1);
        view.camera = scene_plan_camera(150, place_m, headings_deg[i], 7 * (double)i - 13, 11);
        render(&view);
        for (size_t k = 0; k < PIXELS; k++)
            assert_int_equal(pixels[k], 100);
    }
}

/* Two pieces of blank paper, edge to edge: nothing of what is behind shows between them. */
static void tapes_that_abut_leave_no_line(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 0;
    scene_tape tapes[2] = {scene_tape_of(ids, 3, true), scene_tape_of(ids, 1, false)};
    tapes[0].light = tapes[0].dark = tapes[1].light = tapes[1].dark = 200;
    const double m = tapes[0].module_m, length_modules = 25 * 3 + 23, above_m = 0.2;
    const scene_line line = {-1, -1, 1, -1};
    scene_tape_on_wall(&tapes[0], line, 0.5, above_m);
    scene_tape_on_wall(&tapes[1], line, 0.5 + (length_modules + 3) * m, above_m);
    view.tapes = tapes;
    view.tape_count = 2;
    view.camera = scene_plan_camera(240, scene_plan_point(0.2, 0, 0.2), -80, 0, 12);
    render(&view);
    assert_int_equal(truth.cm_count, 4);
    const tapemark_point *last = truth.cms[2].corners, *next = truth.cms[3].corners;
    for (double share = -1; share < 2; share += 0.001) {
        double before = (1 - share) / 2, after = share / 2;
        double x = before * (double)(last[1].x_px + last[2].x_px) + after * (double)(next[0].x_px + next[3].x_px);
        double y = before * (double)(last[1].y_px + last[2].y_px) + after * (double)(next[0].y_px + next[3].y_px);
        assert_int_equal(at((int32_t)floor(x + 0.5), (int32_t)floor(y + 0.5)), 200);
    }
}

static double polygon_area(const tapemark_point corners[4])
{
    double area = 0;
    for (int i = 0; i < 4; i++) {
        const tapemark_point a = corners[i], b = corners[(i + 1) % 4];
        area += 0.5 * (double)(a.x_px * b.y_px - b.x_px * a.y_px);
    }
    return area;
}

/* A white picture; all else is black, so that the light in the image is what is seen of it. */
typedef struct white_picture {
    scene view;
    scene_picture picture;
    scene_panel panels[16];
    size_t panel_count;
} white_picture;

static void begin_white(white_picture *all)
{
    static const uint8_t white[] = {255};
    const scene_line line = {0, -2, 4, -2};
    *all = (white_picture){.view = scene_ideal(WIDTH_PX, HEIGHT_PX), .picture = scene_picture_of(white, 1, 1, 0.8)};
    scene_picture_on_wall(&all->picture, line, 1.6, 1);
    all->panels[0] = flat(scene_wall(line, 2), 0);
    all->panels[1] = flat(scene_floor(-5, -5, 10, 10, 0), 0);
    all->panel_count = 2;
    all->view.background.light = 0;
    all->view.camera = scene_plan_camera(300, scene_plan_point(2, 0, 1), -90, 0, 5);
}

static void assert_light_is_what_is_visible(white_picture *all, double least_lost, double most_lost)
{
    all->view.pictures = &all->picture;
    all->view.picture_count = 1;
    all->view.panels = all->panels;
    all->view.panel_count = all->panel_count;
    render(&all->view);
    assert_int_equal(truth.picture_count, 1);
    double light = 0;
    for (size_t i = 0; i < PIXELS; i++)
        light += pixels[i] / 255.0;
    const scene_picture_truth *seen = &truth.pictures[0];
    assert_near(light / polygon_area(seen->corners), seen->visible, 0.02);
    assert_near(seen->visible + seen->lost.outside + seen->lost.covered + seen->lost.hidden, 1, 1e-9);
    assert_true(1 - seen->visible >= least_lost && 1 - seen->visible <= most_lost);
    assert_int_equal(seen->whole, least_lost == 0);
}

static void what_is_seen_of_a_picture_is_what_the_truth_says(void **state)
{
    (void)state;
    white_picture all;
    begin_white(&all);
    assert_light_is_what_is_visible(&all, 0, 0);

    all.view.camera.position_m.x += 0.9;
    assert_light_is_what_is_visible(&all, 0.1, 0.6);
    assert_near(truth.pictures[0].lost.outside, 1 - truth.pictures[0].visible, 1e-9);

    /* A wall before it, seen from either of its sides. */
    for (int turned = 0; turned < 2; turned++) {
        begin_white(&all);
        scene_line line = turned ? (scene_line){3, -1, 2.1, -1} : (scene_line){2.1, -1, 3, -1};
        all.panels[all.panel_count++] = flat(scene_wall(line, 1.1), 0);
        assert_light_is_what_is_visible(&all, 0.1, 0.5);
        assert_near(truth.pictures[0].lost.hidden, 1 - truth.pictures[0].visible, 1e-9);
    }

    /* A box, and a cover in the image. */
    begin_white(&all);
    const scene_box box = {.x_m = 1.8, .y_m = -1.2, .width_m = 0.2, .depth_m = 0.2, .height_m = 1.1,
                           .turned_deg = 30};
    scene_box_panels(&box, all.panels + all.panel_count);
    for (int i = 0; i < 5; i++)
        all.panels[all.panel_count++].light = 0;
    assert_light_is_what_is_visible(&all, 0.1, 0.5);

    begin_white(&all);
    const scene_cover cover = {.x_px = 160, .y_px = 100, .width_px = 80, .height_px = 30, .angle_deg = 20};
    all.view.covers = &cover;
    all.view.cover_count = 1;
    assert_light_is_what_is_visible(&all, 0.05, 0.4);
    assert_near(truth.pictures[0].lost.covered, 1 - truth.pictures[0].visible, 1e-9);

    /* A wall that is behind hides nothing, in whatever order they come. */
    begin_white(&all);
    all.panels[all.panel_count++] = flat(scene_wall((scene_line){0, -2.1, 4, -2.1}, 3), 0);
    assert_light_is_what_is_visible(&all, 0, 0);
}

static void the_nearer_hides_whatever_the_order(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    const scene_panel near = flat(scene_wall((scene_line){-0.2, -1, 3, -1}, 2), 50);
    const scene_panel far = flat(scene_wall((scene_line){-3, -2, 3, -2}, 2), 200);
    const scene_panel orders[2][2] = {{near, far}, {far, near}};
    view.panel_count = 2;
    view.camera = scene_plan_camera(200, scene_plan_point(0, 0, 1), -90, 0, 0);
    for (int i = 0; i < 2; i++) {
        view.panels = orders[i];
        render(&view);
        assert_int_equal(at(200, 120), 50);
        assert_int_equal(at(60, 120), 200);
        /* The near wall's end is seen at 120 - 0.2 * 200 px: 119.5 of 160 is half of a pixel. */
        assert_near(at(119, 120), 200, 2);
        assert_near(at(120, 120), 50, 2);
    }

    /* Walls that cross: to the left of the middle the one is nearer, to the right the other. */
    const scene_panel crossing[2] = {flat(scene_wall((scene_line){-1, -1, 1, -3}, 2), 50),
                                     flat(scene_wall((scene_line){-1, -3, 1, -1}, 2), 200)};
    view.panels = crossing;
    render(&view);
    assert_int_equal(at(140, 120), 50);
    assert_int_equal(at(180, 120), 200);
    /* They cross in the middle of pixel 160, which is half of each: the one that is drawn later is taken for nearer
     * up to a millimetre behind. */
    view.camera.position_m.x -= 0.5 * 2 / 200;
    render(&view);
    assert_int_equal(at(159, 120), 50);
    assert_near(at(160, 120), 125, 20);
    assert_int_equal(at(161, 120), 200);
}

/* Too thin to lie on the middle of every pixel, and seen all the same. */
static void a_thin_pole_takes_its_share_of_a_pixel(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    const scene_panel panels[2] = {flat(scene_wall((scene_line){-3, -2, 3, -2}, 2), 200),
                                   flat(scene_wall((scene_line){0.0002, -1, 0.0017, -1}, 2), 0)};
    view.panels = panels;
    view.panel_count = 2;
    view.camera = scene_plan_camera(200, scene_plan_point(0, 0, 1), -90, 0, 0);
    render(&view);
    for (int32_t y = 20; y < 220; y++) {
        assert_near(at(160, y), 200 * 0.7, 6);
        assert_int_equal(at(159, y), 200);
        assert_int_equal(at(161, y), 200);
    }
}

/* In one plane the later covers the earlier; out of it, the nearer does. Paper of other tapes hides ink. */
static void the_later_covers_the_earlier_in_its_plane(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_tape tapes[2] = {scene_tape_of(ids, 1, false), scene_tape_of(ids + 2, 1, false)};
    const scene_line line = {-1, -1, 1, -1};
    tapes[0].light = tapes[0].dark = 90;
    tapes[1].light = tapes[1].dark = 210;
    scene_tape_on_wall(&tapes[0], line, 0.9, 1);
    scene_tape_on_wall(&tapes[1], line, 1.03, 1);
    const scene_panel wall = flat(scene_wall(line, 2), 10);
    view.panels = &wall;
    view.panel_count = 1;
    view.tapes = tapes;
    view.tape_count = 2;
    view.camera = scene_plan_camera(300, scene_plan_point(0, 0, 1), -90, 0, 0);
    render(&view);
    assert_int_equal(at(173, 120), 210);
    assert_int_equal(at(140, 120), 90);
    assert_int_equal(truth.cm_count, 2);
    /* The second one's paper begins a module before its ink: 0.13 m less 1 module of the first one's 32. */
    assert_near(truth.cms[0].visible, (0.13 / tapes[0].module_m - 1) / 32, 0.02);
    assert_near(truth.cms[0].lost.hidden, 1 - truth.cms[0].visible, 1e-9);
    assert_true(truth.cms[1].whole);

    /* 2 mm further away it is behind, and loses its paper's end and some of its ink: the ink under the first one. */
    tapes[1].origin_m.z += 0.002;
    view.panel_count = 0;
    render(&view);
    assert_int_equal(at(173, 120), 90);
    assert_true(truth.cms[0].whole);
    assert_near(truth.cms[1].visible, 1 - (33 - 0.13 / tapes[0].module_m) / 32, 0.02);
}

/* ---- Large plans --------------------------------------------------------------------------------------- */

static void of_a_large_plan_only_what_is_in_sight_counts(void **state)
{
    (void)state;
    enum { ROWS = 60, TAPES_A_ROW = 14, TAPES = ROWS * TAPES_A_ROW, CMS = 6 };
    static int32_t all_ids[TAPES][CMS];
    static scene_tape tapes[TAPES];
    static scene_panel walls[ROWS];
    for (int32_t row = 0; row < ROWS; row++) {
        const scene_line line = {-1, -2.0 * row - 2, 24, -2.0 * row - 2};
        walls[row] = flat(scene_wall(line, 2.5), 100);
        for (int32_t i = 0; i < TAPES_A_ROW; i++) {
            int32_t tape = row * TAPES_A_ROW + i;
            for (int32_t k = 0; k < CMS; k++)
                all_ids[tape][k] = tape * CMS + k;
            tapes[tape] = scene_tape_of(all_ids[tape], CMS, true);
            scene_tape_on_wall(&tapes[tape], line, 1.6 * i + 0.1, 1);
        }
    }
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.panels = walls;
    view.panel_count = ROWS;
    view.tapes = tapes;
    view.tape_count = TAPES;
    view.camera = scene_plan_camera(200, scene_plan_point(3, 0, 1), -80, 0, 0);
    render(&view);
    assert_true(truth.cm_count > 4 && truth.cm_count < 20);
    for (size_t i = 0; i < truth.cm_count; i++)
        assert_true(truth.cms[i].id < TAPES_A_ROW * CMS);
    assert_int_equal(truth.left_out, 0);

    /* Without walls there are more in sight than there is room for. */
    view.panel_count = 0;
    view.camera = scene_plan_camera(200, scene_plan_point(8, 0, 30), -90, -20, 0);
    render(&view);
    assert_int_equal(truth.cm_count, SCENE_CMS_MAX);
    assert_true(truth.left_out > 500);
    for (size_t i = 1; i < truth.cm_count; i++)
        assert_true(truth.cms[i - 1].id < truth.cms[i].id);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(tapes_hang_and_lie_where_the_plan_says),
        cmocka_unit_test(pictures_hang_and_lie_as_tapes_do),
        cmocka_unit_test(walls_floors_and_boxes_stand_where_the_plan_says),
        cmocka_unit_test(no_light_comes_through_where_walls_meet),
        cmocka_unit_test(tapes_that_abut_leave_no_line),
        cmocka_unit_test(what_is_seen_of_a_picture_is_what_the_truth_says),
        cmocka_unit_test(the_nearer_hides_whatever_the_order),
        cmocka_unit_test(a_thin_pole_takes_its_share_of_a_pixel),
        cmocka_unit_test(the_later_covers_the_earlier_in_its_plane),
        cmocka_unit_test(of_a_large_plan_only_what_is_in_sight_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
