/* Area sampling of tapes and marker pictures, against many single rays a pixel with a pinhole camera of its own. */
#include <string.h>

#include "near.h"
#include "scene.h"

enum { WIDTH_PX = 48, HEIGHT_PX = 36, PIXELS = WIDTH_PX * HEIGHT_PX };
enum { TEXELS = 24 };

static const int32_t ids[] = {0, -1, 2};
static uint16_t samples[PIXELS];
static double expected[PIXELS];
static scene_truth truth;

/* ---- Single rays --------------------------------------------------------------------------------------- */

/* Cosines and sines of the camera's yaw, pitch and roll. */
static double cosine[3], sine[3];

static void aim(const scene_camera *camera)
{
    const double degrees[3] = {camera->yaw_deg, camera->pitch_deg, camera->roll_deg};
    for (int i = 0; i < 3; i++) {
        cosine[i] = cos(degrees[i] * 3.14159265358979 / 180);
        sine[i] = sin(degrees[i] * 3.14159265358979 / 180);
    }
}

/* What a ray through a point of the image hits of a plane, in metres; false for nothing. */
static bool hit(const scene_camera *camera, scene_vector origin, scene_vector along, scene_vector down, double x_px,
                double y_px, double *u_m, double *v_m)
{
    double x = (x_px - (WIDTH_PX - 1) / 2.0) / camera->focal_px;
    double y = (y_px - (HEIGHT_PX - 1) / 2.0) / camera->focal_px;
    double x1 = cosine[2] * x - sine[2] * y, y1 = sine[2] * x + cosine[2] * y;
    double y2 = cosine[1] * y1 - sine[1], z2 = sine[1] * y1 + cosine[1];
    double ray[3] = {cosine[0] * x1 + sine[0] * z2, y2, -sine[0] * x1 + cosine[0] * z2};
    double nx = along.y * down.z - along.z * down.y, ny = along.z * down.x - along.x * down.z;
    double nz = along.x * down.y - along.y * down.x;
    double ox = origin.x - camera->position_m.x, oy = origin.y - camera->position_m.y;
    double oz = origin.z - camera->position_m.z;
    double facing = nx * ray[0] + ny * ray[1] + nz * ray[2], distance = (nx * ox + ny * oy + nz * oz) / facing;
    if (!(facing > 0) || !(distance > 0))
        return false;
    double px = distance * ray[0] - ox, py = distance * ray[1] - oy, pz = distance * ray[2] - oz;
    *u_m = px * along.x + py * along.y + pz * along.z;
    *v_m = px * down.x + py * down.y + pz * down.z;
    return true;
}

typedef double shade_at(const scene *view, double x_px, double y_px);

/* An even lattice of 610 rays a pixel. */
static void expect(const scene *view, shade_at *shade)
{
    enum { RAYS = 610, MULTIPLIER = 377 };
    aim(&view->camera);
    for (int i = 0; i < PIXELS; i++) {
        double sum = 0;
        for (int k = 0; k < RAYS; k++)
            sum += shade(view, i % WIDTH_PX + (k + 0.5) / RAYS - 0.5,
                         i / WIDTH_PX + (k * MULTIPLIER % RAYS + 0.5) / RAYS - 0.5);
        expected[i] = sum / RAYS;
    }
}

static double tape_shade(const scene *view, double x_px, double y_px)
{
    static uint8_t modules[7 * 98];
    if (modules[0] == 0)
        assert_int_equal(tapemark_segment_draw(ids, 3, true, modules, sizeof modules), TAPEMARK_OK);
    const scene_tape *tape = view->tapes;
    double u, v;
    if (!hit(&view->camera, tape->origin_m, tape->along, tape->down, x_px, y_px, &u, &v))
        return view->background.light;
    u = floor(u / tape->module_m);
    v = floor(v / tape->module_m);
    if (u < -2 || u >= 100 || v < -1 || v >= 8)
        return view->background.light;
    bool ink = u >= 0 && u < 98 && v >= 0 && v < 7 && modules[(int)v * 98 + (int)u];
    return ink ? tape->dark : tape->light;
}

static double picture_shade(const scene *view, double x_px, double y_px)
{
    const scene_picture *picture = view->pictures;
    double u, v, border_m = picture->border_m;
    if (!hit(&view->camera, picture->origin_m, picture->along, picture->down, x_px, y_px, &u, &v) || u < -border_m ||
        v < -border_m || u > picture->width_m + border_m || v > picture->height_m + border_m)
        return view->background.light;
    double column = floor(u / picture->width_m * picture->columns);
    double row = floor(v / picture->height_m * picture->rows);
    if (column < 0 || row < 0 || column >= picture->columns || row >= picture->rows)
        return picture->border_shade;
    return picture->texels[(int)row * picture->columns + (int)column];
}

/* Largest and mean difference of the picture from what is expected, in gray levels. */
static void compare(double *most, double *mean)
{
    *most = *mean = 0;
    for (int i = 0; i < PIXELS; i++) {
        double difference = fabs(samples[i] * (255 / 65535.0) - expected[i]);
        *most = fmax(*most, difference);
        *mean += difference / PIXELS;
    }
}

/* ---- Tapes --------------------------------------------------------------------------------------------- */

static const scene_pose poses[] = {
    {.px_per_module = 4, .dx_px = 0.3, .dy_px = 0.1},
    {.px_per_module = 0.7, .yaw_deg = 20, .roll_deg = 17},
    {.px_per_module = 1.5, .yaw_deg = -50, .pitch_deg = 30, .roll_deg = 200},
    {.px_per_module = 9, .pitch_deg = -65, .roll_deg = 100},
    {.px_per_module = 0.2, .roll_deg = 45},
};

static void each_pixel_of_a_tape_is_the_mean_of_its_area(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof poses / sizeof poses[0]; i++) {
        scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
        scene_tape tape = scene_tape_of(ids, 3, true);
        view.camera.yaw_deg = 20;
        view.camera.pitch_deg = -15;
        view.camera.roll_deg = 33;
        scene_place(&view, &tape, poses[i]);
        view.tapes = &tape;
        view.tape_count = 1;
        assert_true(scene_render_samples(&view, 16, samples, NULL));
        expect(&view, tape_shade);
        double most, mean;
        compare(&most, &mean);
        /* 34 or 89 points a pixel: an edge is off by no more than its contrast of 158, or 128, by so many. */
        assert_near(most, 0, 158 * 2.0 / 34);
        assert_near(mean, 0, 0.3);
    }
}

/* ---- Pictures ------------------------------------------------------------------------------------------ */

static uint32_t bits = 1;

static uint8_t random_shade(void)
{
    bits = bits * 1664525u + 1013904223u;
    return (uint8_t)(bits >> 24);
}

static void each_pixel_of_a_picture_is_the_mean_of_its_area(void **state)
{
    (void)state;
    static uint8_t texels[TEXELS * (TEXELS + 7)];
    for (size_t i = 0; i < sizeof texels; i++)
        texels[i] = random_shade();
    static const double border_m[] = {0, 0.013};
    for (size_t i = 0; i < sizeof poses / sizeof poses[0]; i++) {
        scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
        scene_picture picture = scene_picture_of(texels, TEXELS, TEXELS + 7, 0.1);
        picture.border_m = border_m[i % 2];
        view.camera.yaw_deg = -130;
        view.camera.pitch_deg = 25;
        view.camera.roll_deg = -12;
        view.camera.position_m = (scene_vector){3, -1, 0.4};
        scene_place_picture(&view, &picture, poses[i]);
        view.pictures = &picture;
        view.picture_count = 1;
        assert_true(scene_render_samples(&view, 16, samples, NULL));
        expect(&view, picture_shade);
        double most, mean;
        compare(&most, &mean);
        assert_near(most, 0, 4); /* of single pixels, the rays themselves are off by so much */
        assert_near(mean, 0, 0.12);
    }
}

/* A thousand texels in a few pixels, on a floor that runs away: here most samplers alias. */
static void a_picture_made_small_keeps_its_light(void **state)
{
    (void)state;
    enum { SIDE = 1000 };
    static uint8_t texels[SIDE * SIDE];
    double light = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        texels[i] = (i % SIDE + i / SIDE) % 2 ? 250 : 10;
        light += texels[i];
    }
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.background.light = 0;
    scene_picture picture = scene_picture_of(texels, SIDE, SIDE, 1);
    view.pictures = &picture;
    view.picture_count = 1;
    for (double px = 3; px < 30; px *= 1.7) {
        scene_place_picture(&view, &picture, (scene_pose){.px_per_module = px / SIDE, .roll_deg = 20, .dx_px = 0.3});
        assert_true(scene_render_samples(&view, 16, samples, NULL));
        double sum = 0;
        for (int i = 0; i < PIXELS; i++)
            sum += samples[i] * (255 / 65535.0);
        assert_near(sum, light / ((double)SIDE * SIDE) * px * px, 1e-3 * 130 * px * px);
    }
    view.camera = scene_plan_camera(60, scene_plan_point(0, 0, 0.3), 0, -5, 0);
    scene_picture_on_floor(&picture, (scene_line){0.5, 0, 5, 0}, 0);
    picture.width_m = picture.height_m = 40;
    picture.origin_m = scene_plan_point(0.3, -20, 0);
    assert_true(scene_render_samples(&view, 16, samples, NULL));
    /* Far enough away that each pixel holds many squares of 0.04 m. */
    for (int x = 5; x < WIDTH_PX - 5; x++)
        assert_near(samples[14 * WIDTH_PX + x] * (255 / 65535.0), 130, 1);
}

static void pictures_are_seen_from_their_front_with_light_as_gamma_says(void **state)
{
    (void)state;
    static const uint8_t halves[] = {255, 100};
    scene view = scene_ideal(WIDTH_PX, HEIGHT_PX);
    view.sensor.gamma = 2.2;
    view.background.light = 77;
    scene_picture picture = scene_picture_of(halves, 2, 1, 1);
    view.pictures = &picture;
    view.picture_count = 1;
    /* The middle of the picture goes through the middle of a pixel: half the light, not half the shade. */
    scene_place_picture(&view, &picture, (scene_pose){.px_per_module = 10, .dx_px = 0.5, .dy_px = 0.5});
    assert_true(scene_render_samples(&view, 16, samples, &truth));
    double half = (1 + pow(100 / 255.0, 2.2)) / 2;
    assert_near(samples[18 * WIDTH_PX + 24] * (255 / 65535.0), 255 * pow(half, 1 / 2.2), 0.1);
    assert_near(samples[18 * WIDTH_PX + 19] * (255 / 65535.0), 255, 0.01);
    assert_near(samples[18 * WIDTH_PX + 29] * (255 / 65535.0), 100, 0.01);
    assert_near(samples[5 * WIDTH_PX + 5] * (255 / 65535.0), 77, 0.01);
    assert_int_equal(truth.picture_count, 1);
    assert_near((double)truth.pictures[0].corners[0].x_px, 14, 1e-3);
    assert_near((double)truth.pictures[0].corners[2].y_px, 23, 1e-3);
    assert_near(truth.pictures[0].px_min, 10, 1e-6);

    scene_place_picture(&view, &picture, (scene_pose){.px_per_module = 10, .yaw_deg = 180});
    assert_true(scene_render_samples(&view, 16, samples, &truth));
    assert_int_equal(truth.picture_count, 0);
    for (int i = 0; i < PIXELS; i++)
        assert_near(samples[i] * (255 / 65535.0), 77, 0.01);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_pixel_of_a_tape_is_the_mean_of_its_area),
        cmocka_unit_test(each_pixel_of_a_picture_is_the_mean_of_its_area),
        cmocka_unit_test(a_picture_made_small_keeps_its_light),
        cmocka_unit_test(pictures_are_seen_from_their_front_with_light_as_gamma_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
