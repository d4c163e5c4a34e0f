/* How long a frame takes: a furnished room with tapes, out of focus, with noise and vignetting. */
#include <stdlib.h>
#include <time.h>

#include "near.h"
#include "scene.h"

enum { PANELS_MAX = 2 + 4 + 4 * SCENE_FURNISHING_MAX + SCENE_BOX_PANELS, TAPES = 6, CMS = 6 };

static scene_panel panels[PANELS_MAX];
static scene_tape tapes[TAPES];
static int32_t ids[TAPES][CMS];
static scene_truth truth;

static void build_room(scene *view)
{
    const scene_line walls[4] = {{0, 0, 6, 0}, {6, 0, 6, 4}, {6, 4, 0, 4}, {0, 4, 0, 0}};
    const scene_box box = {.x_m = 4.2, .y_m = 2.2, .width_m = 0.5, .depth_m = 0.4, .height_m = 0.6, .turned_deg = 25,
                           .shade = 90};
    const double height_m = 2.6;
    size_t count = 0;
    panels[count++] = scene_floor(0, 0, 6, 4, 0);
    panels[0].look = SCENE_LOOK_WOOD;
    panels[0].scale_m = 0.12;
    panels[count++] = scene_floor(0, 0, 6, 4, height_m);
    for (int i = 0; i < 4; i++)
        panels[count++] = scene_wall(walls[i], height_m);
    for (int i = 0; i < 4; i++)
        count += scene_furnish(walls[i], height_m, 5 + (uint64_t)i, panels + count, SCENE_FURNISHING_MAX);
    scene_box_panels(&box, panels + count);
    count += SCENE_BOX_PANELS;
    for (int i = 0; i < TAPES; i++) {
        for (int k = 0; k < CMS; k++)
            ids[i][k] = k == 0 ? CMS * i : -(CMS * i + k);
        tapes[i] = scene_tape_of(ids[i], CMS, true);
        scene_tape_on_wall(&tapes[i], walls[i / 3], 0.2 + 1.52 * (i % 3), 0.05);
    }
    view->panels = panels;
    view->panel_count = count;
    view->tapes = tapes;
    view->tape_count = TAPES;
    view->camera = scene_plan_camera(0.8 * view->width_px, scene_plan_point(0.7, 3.3, 1.1), -40, -14, 2);
}

/* The best of several. */
static double frame_ms(int32_t width_px, int32_t height_px)
{
    enum { TRIES = 9 };
    uint8_t *pixels = malloc((size_t)width_px * (size_t)height_px);
    scene view = scene_default(width_px, height_px);
    double best_ms = 1e9;
    assert_non_null(pixels);
    build_room(&view);
    view.light.vignetting = 0.3;
    view.optics.defocus_px = 0.8;
    for (int i = 0; i < TRIES; i++) {
        clock_t before = clock();
        assert_true(scene_render(&view, pixels, &truth));
        best_ms = fmin(best_ms, (double)(clock() - before) * 1e3 / CLOCKS_PER_SEC);
    }
    assert_true(truth.cm_count > 10);
    free(pixels);
    print_message("%d x %d: %.1f ms a frame\n", (int)width_px, (int)height_px, best_ms);
    return best_ms;
}

static void a_frame_is_rendered_in_time(void **state)
{
    (void)state;
    assert_true(frame_ms(640, 480) < 100);
    assert_true(frame_ms(1920, 1080) < 600);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {cmocka_unit_test(a_frame_is_rendered_in_time)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
