/* Something lies on a CM of a TM, dark or light, so that a light CM looks dark or a dark one light: no TM is read as
 * another, nor an id with the other sign. */
#include "decoding.h"

#include "random.h"

enum { WIDTH = 560, HEIGHT = 110, CMS_MAX = 6 };

static double between(random_source *source, double least, double most)
{
    return least + (most - least) * random_unit(source);
}

/* A TM of three to six CMs with any code. */
static one_tape any_tape(random_source *source, double px_per_module, int32_t ids[CMS_MAX])
{
    const size_t count = 3 + (size_t)(4 * random_unit(source));
    const int32_t first = 1 + (int32_t)(1500 * random_unit(source));
    for (size_t i = 0; i < count; i++)
        ids[i] = random_unit(source) < 0.5 ? -first - (int32_t)i : first + (int32_t)i;
    one_tape all = place_tape(scene_default(WIDTH, HEIGHT), ids, count, true,
                              (scene_pose){.px_per_module = px_per_module, .roll_deg = between(source, -4, 4),
                                           .yaw_deg = between(source, -20, 20)});
    all.view.seed = random_bits(source);
    return all;
}

/* About as long as a coding region, somewhere near that of this CM, of the other shade: rather dark on a light one,
 * rather light on a dark one. */
static scene_cover cover_on(random_source *source, const one_tape *all, size_t slot, double px)
{
    const bool light = all->tape.ids[slot] >= 0;
    const double along = 25 * ((double)slot - 0.5 * ((double)all->tape.cm_count - 1));
    return (scene_cover){.x_px = 0.5 * WIDTH + px * (along + between(source, -2.5, 2.5)),
                         .y_px = 0.5 * HEIGHT + px * between(source, -1.5, 1.5),
                         .width_px = px * between(source, 8, 22),
                         .height_px = px * between(source, 4, 16),
                         .shade = light ? between(source, 20, 130) : between(source, 150, 235),
                         .angle_deg = between(source, -5, 5)};
}

/* Returns how many of the TMs were read before something was laid on them. */
static size_t read_tapes(double px_min, double px_max, int tapes, uint64_t seed)
{
    random_source source = {seed};
    size_t read = 0;
    for (int i = 0; i < tapes; i++) {
        const double px = between(&source, px_min, px_max);
        int32_t ids[CMS_MAX];
        one_tape all = any_tape(&source, px, ids);
        const size_t slot = (size_t)(random_unit(&source) * (double)all.tape.cm_count);
        const scene_cover cover = cover_on(&source, &all, slot, px);
        read += decode_tape(&all, NULL, "not covered")->result.tm_count;
        all.view.covers = &cover;
        all.view.cover_count = 1;
        char name[64];
        snprintf(name, sizeof name, "tape %d, %.2f px a module, CM %u covered", i, px, (unsigned)slot);
        assert_nothing_wrong(decode_tape(&all, NULL, name), &all.view);
    }
    return read;
}

static void a_covered_cm_is_no_other_cm(void **state)
{
    (void)state;
    assert_true(read_tapes(1.1, 2.8, 120, 1) > 110);
}

static void a_covered_far_cm_is_no_other_cm(void **state)
{
    (void)state;
    assert_true(read_tapes(0.65, 0.95, 60, 2) > 45);
}

/* From afar bars are gray, and light behind; what is gray all along between two finder patterns ends no TM. */
static void something_gray_on_a_cm_is_no_bars(void **state)
{
    (void)state;
    static const int32_t ids[CMS_MAX] = {696, -697, -698, -699, -700, -701};
    for (int i = 0; i < 160; i++) {
        const double px = 1.1 + 0.08 * (i % 5), yaw_deg = 4 * (i / 5 % 8) - 14;
        one_tape all = place_tape(scene_default(WIDTH, HEIGHT), ids, CMS_MAX, true,
                                  (scene_pose){.px_per_module = px, .roll_deg = 2, .yaw_deg = yaw_deg});
        const scene_cover cover = {.x_px = 0.5 * WIDTH + 12.5 * px, .y_px = 0.5 * HEIGHT, .angle_deg = 2,
                                   .width_px = (i % 3 == 0 ? 15 : 18) * px, .height_px = 12 * px,
                                   .shade = 118 + 3 * (i / 40)};
        all.view.covers = &cover;
        all.view.cover_count = 1;
        char name[64];
        snprintf(name, sizeof name, "%.2f px a module, yaw %.0f, shade %.0f", px, yaw_deg, cover.shade);
        assert_nothing_wrong(decode_tape(&all, NULL, name), &all.view);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_covered_cm_is_no_other_cm),
        cmocka_unit_test(a_covered_far_cm_is_no_other_cm),
        cmocka_unit_test(something_gray_on_a_cm_is_no_bars),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
