/* Tapes with cells that are wrong, as dirt, scratches and bad prints make them: what the CMs of a segment show
 * together is read, since their ids ascend; what contradicts that, or has nothing to go by, is not. */
#include "decoding.h"

#include "random.h"

enum { CMS = 6, WIDTH = 1080, HEIGHT = 200, CELLS = TAPEMARK_CELLS, PICTURES = 16 };

/* A tape's modules with its quiet zone, and the ink between. */
enum { INK_MODULES = 25 * CMS + 23, COLUMNS = INK_MODULES + 4, ROWS = TAPEMARK_HEIGHT_MODULES + 2 };

typedef struct damage {
    int cells;   /* flipped in each CM */
    int repeats; /* CMs that repeat the id of the one before: from the CM in the middle on all ids are so many less */
} damage;

static double between(random_source *source, double from, double to)
{
    return from + (to - from) * (double)(random_bits(source) >> 11) / 9007199254740992.0;
}

static void choose_ids(const damage *how, random_source *source, int32_t ids[CMS])
{
    const int32_t first = 4 + (int32_t)between(source, 0, 900);
    for (int i = 0; i < CMS; i++) {
        ids[i] = first + i - (i >= CMS / 2 ? how->repeats : 0);
        if (random_bits(source) >> 40 & 1)
            ids[i] = -ids[i];
    }
}

static void flip_cells(uint8_t *modules, int cm, int count, random_source *source)
{
    bool flipped[CELLS] = {false};
    for (int i = 0; i < count;) {
        const int cell = (int)between(source, 0, CELLS);
        if (flipped[cell])
            continue;
        flipped[cell] = true;
        uint8_t *module = &modules[cell / 16 * INK_MODULES + 8 + 25 * cm + 8 + cell % 16];
        *module = !*module;
        i++;
    }
}

/* The print of a damaged tape. */
static void print(const damage *how, const int32_t ids[CMS], random_source *source, uint8_t texels[ROWS * COLUMNS])
{
    static uint8_t modules[TAPEMARK_HEIGHT_MODULES * INK_MODULES];
    assert_int_equal(tapemark_segment_draw(ids, CMS, true, modules, sizeof modules), TAPEMARK_OK);
    for (int cm = 0; cm < CMS; cm++)
        flip_cells(modules, cm, how->cells, source);
    memset(texels, 203, ROWS * COLUMNS);
    for (int row = 0; row < TAPEMARK_HEIGHT_MODULES; row++)
        for (int column = 0; column < INK_MODULES; column++)
            if (modules[row * INK_MODULES + column])
                texels[(row + 1) * COLUMNS + column + 2] = 22;
}

static int count_right(const decoding *got, const int32_t ids[CMS])
{
    int right = 0;
    for (size_t i = 0; i < got->result.cm_count; i++) {
        bool known = false;
        for (int k = 0; k < CMS; k++)
            known = known || got->cms[i].id == ids[k];
        if (!known)
            fail_msg("%s: id %d was read, which is not there", got->name, (int)got->cms[i].id);
        right++;
    }
    return right;
}

/* CMs read in all pictures. Any wrong id fails the test. */
static int read_damaged(damage how, int pictures)
{
    int right = 0;
    for (int i = 0; i < pictures; i++) {
        random_source source = {(uint64_t)(i + 1)};
        int32_t ids[CMS];
        uint8_t texels[ROWS * COLUMNS];
        choose_ids(&how, &source, ids);
        print(&how, ids, &source, texels);
        scene view = scene_default(WIDTH, HEIGHT);
        view.seed = (uint64_t)(i + 1);
        scene_picture picture = scene_picture_of(texels, COLUMNS, ROWS, 0.06 * ROWS / TAPEMARK_HEIGHT_MODULES);
        picture.module_m = 0.06 / TAPEMARK_HEIGHT_MODULES;
        scene_place_picture(&view, &picture,
                            (scene_pose){.px_per_module = 5.7, .yaw_deg = between(&source, -3, 3),
                                         .roll_deg = (i & 1 ? 180 : 0) + between(&source, -3, 3)});
        view.pictures = &picture;
        view.picture_count = 1;
        right += count_right(decode_scene(&view, NULL, "%d cells flipped, picture %d", how.cells, i), ids);
    }
    return right;
}

static void reads_ascending_ids_with_cells_flipped(void **state)
{
    (void)state;
    static const struct {
        int cells, least; /* of PICTURES * CMS */
    } limits[] = {{0, 96}, {2, 86}, {5, 80}, {11, 40}};
    for (size_t i = 0; i < COUNT_OF(limits); i++) {
        const int right = read_damaged((damage){.cells = limits[i].cells}, PICTURES);
        if (right < limits[i].least)
            fail_msg("%d cells flipped: %d of %d CMs were read; at least %d should be", limits[i].cells, right,
                     PICTURES * CMS, limits[i].least);
    }
}

/* Two flipped cells can make another word, with nothing wrong in it: the rest of the segment tells. */
static void another_word_by_damage_is_not_believed(void **state)
{
    (void)state;
    read_damaged((damage){.cells = 2}, 48);
}

/* A tape that repeats an id in its middle, as one pieced together does: no id of one half in the other. */
static void ids_that_do_not_ascend_are_not_made_up(void **state)
{
    (void)state;
    for (int repeats = 1; repeats <= 3; repeats++)
        read_damaged((damage){.cells = 6, .repeats = repeats}, PICTURES);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_ascending_ids_with_cells_flipped),
        cmocka_unit_test(another_word_by_damage_is_not_believed),
        cmocka_unit_test(ids_that_do_not_ascend_are_not_made_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
