/* Tapes: which finder patterns follow each other, and where the missing ones are. */
#include "decoding.h"

#include <math.h>

#include "tape.h"

enum { WIDTH = 800, HEIGHT = 600, CMS = 6 };

static const int32_t ids[CMS] = {28, -29, 30, 31, -32, 33};

/* A rendered tape and the true places of its finder patterns. */
typedef struct setting {
    uint8_t pixels[WIDTH * HEIGHT];
    tmi_view view;
    tmi_finder finders[CMS + 1];
    tapemark_stats stats;
    tmi_tape tape;
} setting;

static setting set;

static void render_tape(scene_pose pose)
{
    scene view = scene_default(WIDTH, HEIGHT);
    scene_truth truth;
    scene_tape tape = scene_tape_of(ids, CMS, true);
    scene_place(&view, &tape, pose);
    view.tapes = &tape;
    view.tape_count = 1;
    assert_true(scene_render(&view, set.pixels, &truth));
    assert_int_equal(truth.cm_count, CMS);
    set.view = (tmi_view){.pixels = set.pixels, .width = WIDTH, .height = HEIGHT, .stride = WIDTH, .sign = 1};
    for (int i = 0; i < CMS; i++)
        set.finders[i] = finder_near_end(&set.view, truth.cms[i].corners, false);
    set.finders[CMS] = finder_near_end(&set.view, truth.cms[CMS - 1].corners, true);
    memset(&set.stats, 0, sizeof set.stats);
    set.tape.view = &set.view;
    set.tape.stats = &set.stats;
    set.tape.work_max = 1000000;
    set.tape.count = set.tape.partners = 0;
}

/* The same square, `quarters` turned: which axis runs along the tape is not known of a lone finder. */
static tmi_finder turned(tmi_finder f, int quarters)
{
    for (; quarters > 0; quarters--) {
        const tmi_point right = f.right;
        f.right = f.down;
        f.down = (tmi_point){-right.x, -right.y};
    }
    return f;
}

static float distance(tmi_point a, tmi_point b)
{
    return (float)hypot((double)(a.x - b.x), (double)(a.y - b.y));
}

/* One chain of all finders, in order from either end, `right` running along the row. */
static void assert_whole_chain(void)
{
    tmi_finder chain[TMI_MAX_CHAIN];
    tmi_rows rows = {0};
    const int count = tmi_tape_next_chain(&set.tape, &rows, 0, chain);
    assert_int_equal(count, CMS + 1);
    const bool backwards = distance(chain[0].centre, set.finders[0].centre) > 10;
    for (int i = 0; i < count; i++) {
        const tmi_finder *f = &set.finders[backwards ? CMS - i : i];
        assert_true(distance(chain[i].centre, f->centre) < 0.3f);
        const float sign = backwards ? -1 : 1;
        assert_true(distance(chain[i].right, (tmi_point){sign * f->right.x, sign * f->right.y}) < 0.15f);
        assert_true(distance(chain[i].down, (tmi_point){sign * f->down.x, sign * f->down.y}) < 0.15f);
    }
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 0);
}

static const scene_pose poses[] = {
    {.px_per_module = 4},
    {.px_per_module = 3, .roll_deg = 37},
    {.px_per_module = 2.6, .roll_deg = 90},
    {.px_per_module = 3.5, .roll_deg = 181},
    {.px_per_module = 4, .yaw_deg = 50},
    {.px_per_module = 4.5, .yaw_deg = -55, .pitch_deg = 30, .roll_deg = 15},
    {.px_per_module = 3, .pitch_deg = -62},
};

static void links_neighbours_whatever_their_axes_and_order(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render_tape(poses[p]);
        for (int i = 0; i <= CMS; i++) { /* 0, 3, 6, 2, 5, 1, 4 */
            const tmi_finder f = turned(set.finders[3 * i % (CMS + 1)], i);
            assert_int_equal(tmi_tape_add(&set.tape, &f), i);
        }
        tmi_tape_link(&set.tape);
        assert_int_equal(set.stats.finders, CMS + 1);
        assert_int_equal(set.stats.rejects[TAPEMARK_REJECT_LONE], 0);
        assert_whole_chain();
    }
}

/* Whichever two neighbours were located foretell all others; so does any single one. */
static void foretells_what_the_scan_lines_missed(void **state)
{
    (void)state;
    for (size_t p = 0; p < COUNT_OF(poses); p++) {
        render_tape(poses[p]);
        for (int known = 0; known < CMS; known++) {
            set.tape.count = 0;
            tmi_tape_add(&set.tape, &set.finders[known]);
            tmi_tape_add(&set.tape, &set.finders[known + 1]);
            tmi_tape_link(&set.tape);
            assert_int_equal(set.tape.count, CMS + 1);
            assert_whole_chain();
        }
    }
}

static void a_single_finder_foretells_its_tape(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4, .roll_deg = 8});
    for (int known = 0; known <= CMS; known++)
        for (int quarters = 0; quarters < 4; quarters++) {
            const tmi_finder f = turned(set.finders[known], quarters);
            set.tape.count = 0;
            tmi_tape_add(&set.tape, &f);
            tmi_tape_link(&set.tape);
            assert_int_equal(set.tape.count, CMS + 1);
            assert_whole_chain();
        }
}

static void without_work_left_nothing_is_foretold(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4});
    set.tape.work_max = 0;
    tmi_tape_add(&set.tape, &set.finders[2]);
    tmi_tape_add(&set.tape, &set.finders[3]);
    set.stats.work = 1500; /* what the second one added, for it has the first one for a partner */
    tmi_tape_link(&set.tape);
    assert_int_equal(set.tape.count, 2);
    assert_int_equal(set.stats.limits, TAPEMARK_LIMIT_WORK);
    tmi_finder chain[TMI_MAX_CHAIN];
    tmi_rows rows = {0};
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 2);
}

/* A finder pattern that is covered ends the row; what lies beyond is a row of its own. */
static bool is_neighbour(int of, int which)
{
    for (int d = 0; d < TMI_DIRECTIONS; d++)
        if (set.tape.nodes[of].neighbour[d] == which)
            return true;
    return false;
}

/* Two that a third may follow: it follows the one that suits it best, and the other one is left alone. */
static void follows_the_better_of_two(void **state)
{
    (void)state;
    for (int rival_first = 0; rival_first < 2; rival_first++) {
        render_tape((scene_pose){.px_per_module = 4});
        tmi_finder rival = set.finders[0];
        rival.centre.x += 4.4f * rival.down.x - 3 * rival.right.x;
        rival.centre.y += 4.4f * rival.down.y - 3 * rival.right.y;
        const int rival_at = tmi_tape_add(&set.tape, rival_first ? &rival : &set.finders[0]) + !rival_first;
        assert_int_equal(tmi_tape_add(&set.tape, rival_first ? &set.finders[0] : &rival), 1);
        assert_int_equal(tmi_tape_add(&set.tape, &set.finders[1]), 2);
        tmi_tape_link(&set.tape);
        assert_true(is_neighbour(2, 1 - rival_at));
        assert_true(is_neighbour(1 - rival_at, 2));
        assert_false(is_neighbour(2, rival_at));
        assert_false(is_neighbour(rival_at, 2));
    }
}

static void a_gap_splits_the_row(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4});
    const tmi_point gone = set.finders[3].centre;
    for (int y = -20; y <= 20; y++)
        memset(set.pixels + ((int)gone.y + y) * WIDTH + (int)gone.x - 20, 120, 41);
    for (int i = 0; i <= CMS; i++)
        if (i != 3)
            tmi_tape_add(&set.tape, &set.finders[i]);
    tmi_tape_link(&set.tape);
    tmi_finder chain[TMI_MAX_CHAIN];
    tmi_rows rows = {0};
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 3);
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 3);
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 0);
}

static void lone_finders_are_counted(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4});
    memset(set.pixels, 150, sizeof set.pixels);
    tmi_tape_add(&set.tape, &set.finders[0]);
    tmi_tape_add(&set.tape, &set.finders[4]);
    tmi_tape_link(&set.tape);
    assert_int_equal(set.stats.rejects[TAPEMARK_REJECT_LONE], 2);
    tmi_finder chain[TMI_MAX_CHAIN];
    tmi_rows rows = {0};
    assert_int_equal(tmi_tape_next_chain(&set.tape, &rows, 0, chain), 0);
}

static void knows_where_its_finders_are(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4, .roll_deg = 30});
    for (int i = 0; i <= CMS; i++)
        tmi_tape_add(&set.tape, &set.finders[i]);
    for (int i = 0; i <= CMS; i++) {
        assert_int_equal(tmi_tape_finder_at(&set.tape, set.finders[i].centre), i);
        assert_int_equal(tmi_tape_finder_at(&set.tape, tmi_at(&set.finders[i], 3.4f, -3.4f)), i);
        assert_int_equal(tmi_tape_finder_at(&set.tape, tmi_at(&set.finders[i], 5, 0)), TMI_NONE);
        assert_int_equal(tmi_tape_finder_at(&set.tape, tmi_at(&set.finders[i], 0, -5)), TMI_NONE);
    }
}

static void more_finders_than_there_is_room_for_are_a_limit(void **state)
{
    (void)state;
    render_tape((scene_pose){.px_per_module = 4});
    for (int i = 0; i < TMI_MAX_FINDERS; i++)
        assert_int_equal(tmi_tape_add(&set.tape, &set.finders[0]), i);
    assert_int_equal(set.stats.limits, 0);
    assert_int_equal(tmi_tape_add(&set.tape, &set.finders[0]), TMI_NONE);
    assert_int_equal(set.stats.limits, TAPEMARK_LIMIT_CANDIDATES);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(links_neighbours_whatever_their_axes_and_order),
        cmocka_unit_test(foretells_what_the_scan_lines_missed),
        cmocka_unit_test(a_single_finder_foretells_its_tape),
        cmocka_unit_test(without_work_left_nothing_is_foretold),
        cmocka_unit_test(follows_the_better_of_two),
        cmocka_unit_test(a_gap_splits_the_row),
        cmocka_unit_test(lone_finders_are_counted),
        cmocka_unit_test(knows_where_its_finders_are),
        cmocka_unit_test(more_finders_than_there_is_room_for_are_a_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
