/* What panels look like, from near and from far, and what furnishes a wall. */
#include <string.h>

#include "near.h"
#include "scene.h"

enum { WIDTH_PX = 128, HEIGHT_PX = 96, PIXELS = WIDTH_PX * HEIGHT_PX };

static uint8_t pixels[PIXELS], other[PIXELS];

static void render(const scene *view, uint8_t *into)
{
    if (!scene_render(view, into, NULL))
        fail_msg("%s", scene_problem(view));
}

/* Mean and standard deviation. */
static void measure(const uint8_t *picture, double *mean, double *deviation)
{
    double sum = 0, power = 0;
    for (int i = 0; i < PIXELS; i++) {
        sum += picture[i];
        power += picture[i] * picture[i];
    }
    *mean = sum / PIXELS;
    *deviation = sqrt(fmax(power / PIXELS - *mean * *mean, 0));
}

/* A wall of this look, seen at a slant, its middle this far away. */
static void render_wall(scene_look look, scene_clutter pattern, double distance_m, uint8_t *into)
{
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_panel wall = scene_wall((scene_line){-2000, 0, 2000, 0}, 3000);
    wall.look = look;
    wall.pattern = pattern;
    wall.light = 200;
    wall.dark = 60;
    wall.scale_m = 0.1;
    view.panels = &wall;
    view.panel_count = 1;
    view.background.light = 0;
    view.camera = scene_plan_camera(WIDTH_PX, scene_plan_point(0.3, distance_m, 1500), -75, 9, 20);
    render(&view, into);
}

/* What a look is made of: 0.1 m, at most 0.8 m; a pixel at 400 m is 3 m wide. */
static void far_away_a_look_is_its_mean_and_does_not_alias(void **state)
{
    (void)state;
    static const scene_clutter patterns[] = {SCENE_BLINDS, SCENE_CHECKERBOARD, SCENE_STRIPES, SCENE_TEXT,
                                             SCENE_SQUARES, SCENE_GRID_CODES, SCENE_FINDER_ROWS};
    for (int look = 0; look < SCENE_LOOK_SHADOW; look++) {
        for (size_t i = 0; i < (look == SCENE_LOOK_PATTERN ? sizeof patterns / sizeof patterns[0] : 1); i++) {
            double near = 0, mean, deviation, near_deviation = 0;
            const double near_m[] = {3, 4, 5, 7, 10};
            for (int k = 0; k < 5; k++) {
                render_wall((scene_look)look, patterns[i], near_m[k], pixels);
                measure(pixels, &mean, &deviation);
                near += mean / 5;
                near_deviation += deviation / 5;
            }
            assert_true(near_deviation > (look == SCENE_LOOK_PAINT ? 1 : 3));
            for (double distance_m = 400; distance_m < 900; distance_m *= 1.3) {
                render_wall((scene_look)look, patterns[i], distance_m, pixels);
                measure(pixels, &mean, &deviation);
                assert_near(mean, near, 0.06 * near);
                assert_near(deviation, 0, 2.5);
            }
        }
    }
}

static void looks_differ_and_another_seed_makes_others(void **state)
{
    (void)state;
    static uint8_t seen[SCENE_LOOK_SHADOW][PIXELS];
    for (int look = 0; look < SCENE_LOOK_SHADOW; look++) {
        render_wall((scene_look)look, SCENE_TEXT, 4, seen[look]);
        for (int before = 0; before < look; before++) {
            double power = 0;
            for (int i = 0; i < PIXELS; i++)
                power += pow(seen[look][i] - seen[before][i], 2);
            assert_true(sqrt(power / PIXELS) > 5);
        }
    }
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_panel wall = scene_wall((scene_line){-5, 0, 5, 0}, 3);
    wall.look = SCENE_LOOK_STONE;
    wall.scale_m = 0.1;
    view.panels = &wall;
    view.panel_count = 1;
    view.camera = scene_plan_camera(WIDTH_PX, scene_plan_point(0, 2, 1), -90, 0, 0);
    render(&view, pixels);
    view.seed++;
    render(&view, other);
    assert_memory_not_equal(pixels, other, sizeof pixels);
}

/* Tiles of 0.5 m with joints of 4 mm, seen so that a metre is 100 px: the joints' share is exact. */
static void joints_of_tiles_take_the_light_that_they_should(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_panel wall = scene_wall((scene_line){-5, 0, 5, 0}, 3);
    wall.look = SCENE_LOOK_TILES;
    wall.light = 200;
    wall.dark = 0;
    wall.scale_m = 0.5;
    view.panels = &wall;
    view.panel_count = 1;
    view.camera = scene_plan_camera(100, scene_plan_point(0.1, 1, 1.25), -90, 0, 0);
    render(&view, pixels);
    /* Joints begin at x = 0 and below heights of 1 and 1.5 m: 10 px left of the middle, 25 px above and below it. How
     * much darker they are than the tiles on both sides, in pixels, as the mean of several lines. */
    enum { LINES = 30 };
    double upright = 0, level = 0;
    for (int i = 0; i < LINES; i++) {
        const uint8_t *across = pixels + (32 + i) * WIDTH_PX + 54, *down = pixels + 23 * WIDTH_PX + 60 + i;
        double beside = (across[-2] + across[2]) / 2.0, above = (down[-2 * WIDTH_PX] + down[2 * WIDTH_PX]) / 2.0;
        upright += (3 - (across[-1] + across[0] + across[1]) / beside) / LINES;
        level += (3 - (down[-WIDTH_PX] + down[0] + down[WIDTH_PX]) / above) / LINES;
    }
    assert_near(upright, 0.4, 0.03);
    assert_near(level, 0.4, 0.03);
}

static void a_shadow_darkens_what_is_beneath_and_nothing_else(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    scene_panel panels[2] = {scene_wall((scene_line){-5, 0, 5, 0}, 3), scene_wall((scene_line){0, 0, 1, 0}, 2)};
    panels[0].look = SCENE_LOOK_PATTERN;
    panels[0].pattern = SCENE_BLINDS;
    panels[0].light = panels[0].dark = 200;
    panels[1].look = SCENE_LOOK_SHADOW;
    panels[1].light = 100;
    panels[1].dark = 40;
    view.panels = panels;
    view.panel_count = 2;
    view.camera = scene_plan_camera(40, scene_plan_point(0.5, 1, 1), -90, 0, 0);
    render(&view, pixels);
    const uint8_t *column = pixels + WIDTH_PX / 2;
    assert_near(column[(48 - 39) * WIDTH_PX], 200 * 0.4, 5);
    assert_near(column[48 * WIDTH_PX], 200 * (1 - 0.6 * 0.25), 3);
    assert_near(column[(48 + 39) * WIDTH_PX], 200, 2);
    assert_int_equal(column[(48 - 43) * WIDTH_PX], 200);
    assert_int_equal(pixels[40 * WIDTH_PX + WIDTH_PX / 2 - 25], 200);

    /* Behind the wall it darkens nothing. */
    panels[1].origin_m.z += 0.1;
    render(&view, pixels);
    for (int i = 0; i < PIXELS; i++)
        assert_true(pixels[i] == 200 || pixels[i] == 160);
}

static void a_wall_is_furnished_within_its_bounds(void **state)
{
    (void)state;
    scene_panel panels[SCENE_FURNISHING_MAX + 1], fewer[5];
    memset(panels, 0x55, sizeof panels);
    const scene_line line = {1, 2, 9, 2};
    size_t most = 0;
    for (uint64_t seed = 0; seed < 200; seed++) {
        size_t count = scene_furnish(line, 2.6, seed, panels, SCENE_FURNISHING_MAX);
        assert_true(count >= 4 && count <= SCENE_FURNISHING_MAX);
        most = count > most ? count : most;
        for (size_t i = 0; i < count; i++) {
            double x[2] = {panels[i].origin_m.x, panels[i].origin_m.x};
            x[1] += panels[i].width_m * panels[i].along.x + panels[i].height_m * panels[i].down.x;
            double top = -panels[i].origin_m.y;
            double bottom = top - panels[i].width_m * panels[i].along.y - panels[i].height_m * panels[i].down.y;
            assert_true(fmin(x[0], x[1]) > 1 - 1e-9 && fmax(x[0], x[1]) < 9 + 1e-9);
            assert_true(top < 2.6 + 1e-9 && bottom > -1e-9);
            assert_near(panels[i].origin_m.z, -2, 1e-9);
        }
        assert_near(panels[0].origin_m.y + panels[0].height_m, 0, 1e-9); /* the baseboard stands on the floor, */
        assert_near(panels[1].origin_m.y + panels[1].height_m, panels[0].origin_m.y, 1e-9); /* its groove on it */
        assert_int_equal(scene_furnish(line, 2.6, seed, fewer, 5), count < 5 ? count : 5);
        assert_memory_equal(fewer, panels, (count < 5 ? count : 5) * sizeof *fewer);
    }
    assert_true(most > 10);
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.panels = panels;
    view.panel_count = scene_furnish((scene_line){0, 0, 8, 0}, 0.2, 3, panels, SCENE_FURNISHING_MAX);
    assert_int_equal(view.panel_count, 4); /* too low for anything but its foot */
    assert_null(scene_problem(&view));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_away_a_look_is_its_mean_and_does_not_alias),
        cmocka_unit_test(looks_differ_and_another_seed_makes_others),
        cmocka_unit_test(joints_of_tiles_take_the_light_that_they_should),
        cmocka_unit_test(a_shadow_darkens_what_is_beneath_and_nothing_else),
        cmocka_unit_test(a_wall_is_furnished_within_its_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
