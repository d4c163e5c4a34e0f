/* Between two finder patterns: maps in perspective, cells, bars. */
#include "decoding.h"

#include <math.h>

#include "bars.h"
#include "marker.h"

enum { WIDTH = 900, HEIGHT = 600, CMS = 5 };

static const int32_t ids[CMS] = {28, -29, 30, 31, -32};

/* A rendered tape, and its finder patterns as they are found: parallelograms. */
typedef struct setting {
    uint8_t pixels[WIDTH * HEIGHT];
    scene_truth truth;
    tmi_view view;
    tmi_finder finders[CMS + 1];
} setting;

static setting set;

static void render(scene view, scene_pose pose, bool bars)
{
    scene_tape tape = scene_tape_of(ids, CMS, bars);
    scene_place(&view, &tape, pose);
    view.tapes = &tape;
    view.tape_count = 1;
    assert_true(scene_render(&view, set.pixels, &set.truth));
    assert_int_equal(set.truth.cm_count, CMS);
    set.view = (tmi_view){.pixels = set.pixels, .width = WIDTH, .height = HEIGHT, .stride = WIDTH, .sign = 1};
    for (int i = 0; i <= CMS; i++)
        set.finders[i] = finder_near_end(&set.view, set.truth.cms[i < CMS ? i : CMS - 1].corners, i == CMS);
}

static const scene_pose poses[] = {
    {.px_per_module = 4},
    {.px_per_module = 4, .roll_deg = 33},
    {.px_per_module = 4.5, .yaw_deg = 60},
    {.px_per_module = 4.5, .yaw_deg = -60, .roll_deg = 10},
    {.px_per_module = 5, .pitch_deg = 60},
    {.px_per_module = 5, .yaw_deg = 50, .pitch_deg = -45, .roll_deg = 170},
};

/* The worst corner of any CM, as the maps have it. */
static double corners_off_by(const tmi_homography maps[CMS])
{
    static const float at[4][2] = {{-3.5f, -3.5f}, {28.5f, -3.5f}, {28.5f, 3.5f}, {-3.5f, 3.5f}};
    double most = 0;
    for (int cm = 0; cm < CMS; cm++)
        for (int i = 0; i < 4; i++) {
            const tmi_point p = tmi_project(&maps[cm], at[i][0], at[i][1]);
            const tapemark_point t = set.truth.cms[cm].corners[i];
            most = fmax(most, hypot((double)(p.x - t.x_px), (double)(p.y - t.y_px)));
        }
    return most;
}

static void map_all(tmi_homography maps[CMS])
{
    uint32_t reads = 0;
    for (int cm = 0; cm < CMS; cm++) {
        tmi_marker_map(&set.finders[cm], &set.finders[cm + 1], &maps[cm]);
        tmi_marker_refine(&set.view, &set.finders[cm], &set.finders[cm + 1], &maps[cm], &reads);
    }
    assert_true(reads > 0);
}

static void maps_reproduce_the_corners(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render(scene_default(WIDTH, HEIGHT), poses[p], true);
        tmi_homography maps[CMS];
        map_all(maps);
        if (corners_off_by(maps) > 0.3)
            fail_msg("pose %u: off by %.2f px", (unsigned)p, corners_off_by(maps));
    }
}

static void row_maps_reproduce_the_corners(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render(scene_default(WIDTH, HEIGHT), poses[p], true);
        tmi_homography maps[CMS];
        uint32_t reads = 0;
        assert_true(tmi_row_maps(&set.view, set.finders, CMS + 1, maps, &reads));
        if (corners_off_by(maps) > 0.3)
            fail_msg("pose %u: off by %.2f px", (unsigned)p, corners_off_by(maps));
    }
}

static void row_maps_need_a_row(void **state)
{
    (void)state;
    render(scene_default(WIDTH, HEIGHT), poses[0], true);
    tmi_homography maps[CMS], before[CMS];
    memset(maps, 0, sizeof maps);
    memcpy(before, maps, sizeof maps);
    uint32_t reads = 0;
    assert_false(tmi_row_maps(&set.view, set.finders, 3, maps, &reads));
    memset(set.pixels, 128, sizeof set.pixels); /* nothing is there any more */
    assert_false(tmi_row_maps(&set.view, set.finders, CMS + 1, maps, &reads));
    assert_memory_equal(maps, before, sizeof maps);
}

/* A finder that was located wrongly, at an end from which the others' places are guessed, bends no row. */
static void row_maps_meet_the_finders(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render(scene_default(WIDTH, HEIGHT), poses[p], true);
        tmi_finder *first = &set.finders[0];
        first->down.x += 0.5f * first->right.x;
        first->down.y += 0.5f * first->right.y;
        tmi_homography maps[CMS];
        uint32_t reads = 0;
        if (tmi_row_maps(&set.view, set.finders, CMS + 1, maps, &reads) && corners_off_by(maps) > 0.5)
            fail_msg("pose %u: off by %.2f px", (unsigned)p, corners_off_by(maps));
    }
}

/* ---- Cells -------------------------------------------------------------------------------------------------- */

static float largest_cell_error(const tmi_cells *cells, int32_t id)
{
    uint16_t rows[TAPEMARK_CELL_ROWS];
    assert_int_equal(tapemark_cm_grid(id, rows), TAPEMARK_OK);
    float most = 0;
    for (int i = 0; i < TAPEMARK_CELLS; i++) {
        const float dark = (float)(rows[i / TAPEMARK_CELL_COLUMNS] >>
                                   (TAPEMARK_CELL_COLUMNS - 1 - i % TAPEMARK_CELL_COLUMNS) & 1);
        most = fmaxf(most, fabsf(cells->value[i] - dark));
    }
    return most;
}

/* Without blur the cells come out as they are printed, whatever the light: a gradient, and a fifth of it. */
static void samples_cells_as_printed(void **state)
{
    (void)state;
    for (int light = 0; light < 3; light++) {
        scene view = scene_ideal(WIDTH, HEIGHT);
        view.light.gradient = light == 1 ? 1 : 0;
        view.sensor.exposure = light == 2 ? 0.2 : 1;
        render(view, (scene_pose){.px_per_module = 5, .yaw_deg = 30, .roll_deg = 12}, true);
        tmi_homography maps[CMS];
        map_all(maps);
        for (int cm = 0; cm < CMS; cm++) {
            tmi_cells cells;
            uint32_t reads = 0;
            assert_true(tmi_marker_sample(&set.view, &maps[cm], 10, &cells, &reads));
            assert_true(reads >= TAPEMARK_CELLS);
            if (largest_cell_error(&cells, ids[cm]) > 0.25f)
                fail_msg("light %d, id %d: a cell is off by %.2f", light, (int)ids[cm],
                         (double)largest_cell_error(&cells, ids[cm]));
            assert_true(cells.leak_along >= 0 && cells.leak_along < 0.1f);
            assert_true(cells.leak_across >= 0 && cells.leak_across < 0.1f);
        }
    }
}

/* So do they where a shadow's edge runs across the CM between two finder patterns, in which dark cells in the light
 * are as bright as light ones in the shade. */
static void samples_cells_across_a_shadows_edge(void **state)
{
    (void)state;
    static const double angles_deg[] = {0, 150, 205};
    for (size_t i = 0; i < COUNT_OF(angles_deg); i++) {
        scene view = scene_ideal(WIDTH, HEIGHT);
        view.light.shadow_depth = 0.85;
        view.light.shadow_deg = angles_deg[i];
        view.light.shadow_soft_px = 2;
        render(view, (scene_pose){.px_per_module = 5, .roll_deg = 3, .dx_px = 110}, false);
        tmi_homography map;
        tmi_cells cells;
        uint32_t reads = 0;
        tmi_marker_map(&set.finders[1], &set.finders[2], &map);
        assert_true(tmi_marker_sample(&set.view, &map, 10, &cells, &reads));
        if (largest_cell_error(&cells, ids[1]) > 0.4f)
            fail_msg("edge at %g degrees: a cell is off by %.2f", angles_deg[i],
                     (double)largest_cell_error(&cells, ids[1]));
    }
}

static void leaks_grow_with_the_blur(void **state)
{
    (void)state;
    float before_along = -1, before_across = -1;
    for (int step = 0; step < 4; step++) {
        scene view = scene_ideal(WIDTH, HEIGHT);
        view.optics.defocus_px = 0.9 * step;
        render(view, poses[0], true);
        tmi_homography map;
        tmi_cells cells;
        uint32_t reads = 0;
        tmi_marker_map(&set.finders[2], &set.finders[3], &map);
        assert_true(tmi_marker_sample(&set.view, &map, 10, &cells, &reads));
        assert_true(cells.leak_along > before_along && cells.leak_across > before_across);
        before_along = cells.leak_along;
        before_across = cells.leak_across;
    }
    assert_true(before_along > 0.15f && before_along <= 0.3f);
}

/* Wherever the camera stands: along the tape or across it, from afar or at an angle. */
static void narrow_cells_are_told(void **state)
{
    (void)state;
    static const struct {
        scene_pose pose;
        bool narrow;
    } views[] = {
        {{.px_per_module = 1.1}, false},
        {{.px_per_module = 0.8}, true},
        {{.px_per_module = 4, .yaw_deg = 74}, false},
        {{.px_per_module = 4, .yaw_deg = 78.5}, true},
        {{.px_per_module = 4, .pitch_deg = -74}, false},
        {{.px_per_module = 4, .pitch_deg = -78.5}, true},
    };
    for (size_t i = 0; i < COUNT_OF(views); i++) {
        scene view = scene_ideal(WIDTH, HEIGHT);
        view.camera.focal_px = 1e4; /* one module is like the next */
        render(view, views[i].pose, true);
        tmi_homography map;
        tmi_cells cells;
        uint32_t reads = 0;
        tmi_marker_map(&set.finders[1], &set.finders[2], &map);
        assert_true(tmi_marker_sample(&set.view, &map, 10, &cells, &reads));
        if (cells.narrow != views[i].narrow)
            fail_msg("view %u: narrow %d", (unsigned)i, cells.narrow);
    }
}

static void cells_without_contrast_are_not_sampled(void **state)
{
    (void)state;
    scene view = scene_ideal(WIDTH, HEIGHT);
    view.sensor.exposure = 0.2; /* leaves some 32 gray levels */
    render(view, poses[0], true);
    tmi_homography map;
    tmi_cells cells;
    uint32_t reads = 0;
    tmi_marker_map(&set.finders[0], &set.finders[1], &map);
    assert_true(tmi_marker_sample(&set.view, &map, 20, &cells, &reads));
    assert_false(tmi_marker_sample(&set.view, &map, 45, &cells, &reads));
}

/* ---- Bars ---------------------------------------------------------------------------------------------------- */

static float bars_score(const tmi_homography *map, int finder, float u, float direction)
{
    uint32_t reads = 0;
    const float score = tmi_bars_score(&set.view, (tmi_bars_place){map, &set.finders[finder], u, direction}, &reads);
    assert_true(reads > 0);
    return score;
}

static void bars_are_seen_at_the_ends_alone(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render(scene_default(WIDTH, HEIGHT), poses[p], true);
        tmi_homography maps[CMS];
        map_all(maps);
        assert_true(bars_score(&maps[0], 0, 0, -1) > 0.8f);
        assert_true(bars_score(&maps[CMS - 1], CMS, TAPEMARK_CM_PITCH_MODULES, 1) > 0.8f);
        for (int cm = 0; cm < CMS; cm++) {
            assert_true(bars_score(&maps[cm], cm, 0, 1) < 0.6f);
            assert_true(bars_score(&maps[cm], cm + 1, TAPEMARK_CM_PITCH_MODULES, -1) < 0.6f);
        }
    }
}

static void no_bars_no_score(void **state)
{
    (void)state;
    render(scene_default(WIDTH, HEIGHT), poses[0], false);
    tmi_homography maps[CMS];
    map_all(maps);
    assert_true(bars_score(&maps[0], 0, 0, -1) < 0.4f);
    assert_true(bars_score(&maps[CMS - 1], CMS, TAPEMARK_CM_PITCH_MODULES, 1) < 0.4f);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_reproduce_the_corners),
        cmocka_unit_test(row_maps_reproduce_the_corners),
        cmocka_unit_test(row_maps_need_a_row),
        cmocka_unit_test(row_maps_meet_the_finders),
        cmocka_unit_test(samples_cells_as_printed),
        cmocka_unit_test(samples_cells_across_a_shadows_edge),
        cmocka_unit_test(leaks_grow_with_the_blur),
        cmocka_unit_test(narrow_cells_are_told),
        cmocka_unit_test(cells_without_contrast_are_not_sampled),
        cmocka_unit_test(bars_are_seen_at_the_ends_alone),
        cmocka_unit_test(no_bars_no_score),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
