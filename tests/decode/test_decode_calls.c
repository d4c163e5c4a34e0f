/* The contract of tapemark_decode: what it refuses, what it writes to, and what it says when there is no room. */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "decoding.h"

#include <math.h>
#include <sys/mman.h>
#include <unistd.h>

enum { WIDTH = 320, HEIGHT = 80, CANARY_BYTES = 64, CANARY = 0xc5 };

static const int32_t three_ids[] = {12, 13, -14};
static uint8_t tape_pixels[WIDTH * HEIGHT];

/* Everything a call needs, good by default; a test spoils one thing at a time. */
typedef struct call {
    tapemark_image image;
    tapemark_config config;
    uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(WIDTH, HEIGHT)];
    size_t workspace_size;
    tapemark_cm cms[8];
    tapemark_tm tms[4];
    tapemark_finder finders[16];
    tapemark_result result;
} call;

static call *good_call(void)
{
    static call c;
    memset(&c, 0, sizeof c);
    c.image = (tapemark_image){tape_pixels, WIDTH, HEIGHT, WIDTH};
    c.workspace_size = sizeof c.workspace;
    c.result = (tapemark_result){.cms = c.cms, .cm_capacity = COUNT_OF(c.cms), .tms = c.tms,
                                 .tm_capacity = COUNT_OF(c.tms), .finders = c.finders,
                                 .finder_capacity = COUNT_OF(c.finders)};
    return &c;
}

static tapemark_status run(call *c)
{
    return tapemark_decode(&c->image, &c->config, c->workspace, c->workspace_size, &c->result);
}

static int render_tape(void **state)
{
    (void)state;
    scene view = scene_default(WIDTH, HEIGHT);
    scene_tape tape = scene_tape_of(three_ids, 3, true);
    scene_place(&view, &tape, (scene_pose){.px_per_module = 3});
    view.tapes = &tape;
    view.tape_count = 1;
    return scene_render(&view, tape_pixels, NULL) ? 0 : -1;
}

static void assert_tape_read(const call *c, tapemark_status status)
{
    assert_int_equal(status, TAPEMARK_OK);
    assert_int_equal(c->result.cm_count, 3);
    assert_int_equal(c->result.tm_count, 1);
    assert_string_equal(c->result.tms[0].code, "110");
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(c->result.cms[i].id, three_ids[i]);
}

/* Nothing is reported, but nothing stands of the call before either. */
static void assert_refused(call *c, tapemark_status expected)
{
    c->result.cm_count = c->result.tm_count = c->result.finder_count = 77;
    c->result.stats.work = 77;
    assert_int_equal(run(c), expected);
    assert_int_equal(c->result.cm_count + c->result.tm_count + c->result.finder_count, 0);
    assert_int_equal(c->result.stats.work, 0);
}

/* ---- Arguments ------------------------------------------------------------------------------------------- */

static void a_good_call_reads_the_tape(void **state)
{
    (void)state;
    call *c = good_call();
    assert_tape_read(c, run(c));
    assert_in_range(c->result.finder_count, 4, COUNT_OF(c->finders));
    assert_tape_read(c, tapemark_decode(&c->image, NULL, c->workspace, c->workspace_size, &c->result));
}

static void refuses_null(void **state)
{
    (void)state;
    call *c = good_call();
    assert_int_equal(tapemark_decode(NULL, &c->config, c->workspace, c->workspace_size, &c->result),
                     TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_decode(&c->image, &c->config, NULL, c->workspace_size, &c->result),
                     TAPEMARK_BAD_WORKSPACE);
    assert_int_equal(tapemark_decode(&c->image, &c->config, c->workspace, c->workspace_size, NULL),
                     TAPEMARK_BAD_CALL);
    c->image.pixels = NULL;
    assert_refused(c, TAPEMARK_BAD_CALL);
}

static void refuses_arrays_that_are_null_but_not_empty(void **state)
{
    (void)state;
    call *c = good_call();
    c->result.cms = NULL;
    assert_int_equal(run(c), TAPEMARK_BAD_CALL);
    c = good_call();
    c->result.tms = NULL;
    assert_int_equal(run(c), TAPEMARK_BAD_CALL);
    c = good_call();
    c->result.finders = NULL;
    assert_int_equal(run(c), TAPEMARK_BAD_CALL);
}

static void refuses_bad_images(void **state)
{
    (void)state;
    static const struct {
        int32_t width_px, height_px;
        ptrdiff_t stride_bytes;
    } bad[] = {
        {0, HEIGHT, WIDTH}, {-1, HEIGHT, WIDTH}, {65536, HEIGHT, 65536}, {WIDTH, 0, WIDTH}, {WIDTH, -1, WIDTH},
        {WIDTH, 65536, WIDTH}, {WIDTH, HEIGHT, WIDTH - 1}, {WIDTH, HEIGHT, 0}, {WIDTH, HEIGHT, -WIDTH},
        {INT32_MIN, INT32_MIN, WIDTH}, {INT32_MAX, INT32_MAX, PTRDIFF_MAX},
    };
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        call *c = good_call();
        c->image.width_px = bad[i].width_px;
        c->image.height_px = bad[i].height_px;
        c->image.stride_bytes = bad[i].stride_bytes;
        assert_refused(c, TAPEMARK_BAD_CALL);
    }
}

static void refuses_a_workspace_that_is_too_small(void **state)
{
    (void)state;
    call *c = good_call();
    assert_int_equal(tapemark_workspace_bytes(WIDTH, HEIGHT), sizeof c->workspace);
    c->workspace_size--;
    assert_refused(c, TAPEMARK_BAD_WORKSPACE);
    c->workspace_size = 0;
    assert_refused(c, TAPEMARK_BAD_WORKSPACE);
}

static void sizes_out_of_range_have_no_workspace_and_no_budget(void **state)
{
    (void)state;
    static const int32_t bad[] = {0, -1, 65536, INT32_MIN, INT32_MAX};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        assert_int_equal(tapemark_workspace_bytes(bad[i], 480), 0);
        assert_int_equal(tapemark_workspace_bytes(640, bad[i]), 0);
        assert_int_equal(tapemark_default_work_budget(bad[i], 480), 0);
        assert_int_equal(tapemark_default_work_budget(640, bad[i]), 0);
    }
    assert_true(tapemark_default_work_budget(1, 1) > 0);
    assert_true(tapemark_default_work_budget(65535, 65535) > tapemark_default_work_budget(1920, 1080));
}

/* ---- Configuration --------------------------------------------------------------------------------------- */

#define BAD_CONFIG(field, value)                   \
    do {                                           \
        call *c_ = good_call();                    \
        c_->config.field = value;                  \
        assert_refused(c_, TAPEMARK_BAD_CONFIG);   \
    } while (0)

static void refuses_fields_out_of_range(void **state)
{
    (void)state;
    BAD_CONFIG(vote_min, 0.5f);
    BAD_CONFIG(vote_min, -0.7f);
    BAD_CONFIG(vote_min, 1.001f);
    BAD_CONFIG(roll_deg, 360.5f);
    BAD_CONFIG(roll_deg, -361);
    BAD_CONFIG(polarity, (tapemark_polarity)2);
    BAD_CONFIG(confidence_min, -0.01f);
    BAD_CONFIG(confidence_min, 1.01f);
    BAD_CONFIG(id_max, -1);
    BAD_CONFIG(id_max, TAPEMARK_MAX_ID + 1);
    BAD_CONFIG(known_id_count, 1);
}

static void refuses_what_is_no_number(void **state)
{
    (void)state;
    static const float values[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < COUNT_OF(values); i++) {
        BAD_CONFIG(vote_min, values[i]);
        BAD_CONFIG(roll_deg, values[i]);
        BAD_CONFIG(confidence_min, values[i]);
    }
}

static void refuses_known_ids_out_of_order(void **state)
{
    (void)state;
    static const int32_t falling[] = {-14, 13, 12}, twice[] = {-14, 12, 12, 13};
    call *c = good_call();
    c->config.known_ids = falling;
    c->config.known_id_count = COUNT_OF(falling);
    assert_refused(c, TAPEMARK_BAD_CONFIG);
    c->config.known_ids = twice;
    c->config.known_id_count = COUNT_OF(twice);
    assert_refused(c, TAPEMARK_BAD_CONFIG);
}

static void takes_fields_at_the_ends_of_their_ranges(void **state)
{
    (void)state;
    static const int32_t known[] = {-14, 12, 13};
    call *c = good_call();
    c->config = (tapemark_config){.vote_min = 0.501f, .roll_known = true, .roll_deg = -360, .contrast_min = 1,
                                  .id_max = TAPEMARK_MAX_ID, .known_ids = known, .known_id_count = 3,
                                  .work_budget = UINT32_MAX};
    assert_tape_read(c, run(c));
    c->config = (tapemark_config){.vote_min = 1, .roll_deg = 360, .id_max = 14};
    assert_tape_read(c, run(c));
}

/* ---- Memory ---------------------------------------------------------------------------------------------- */

static void any_alignment_of_the_workspace_will_do(void **state)
{
    (void)state;
    const size_t size = tapemark_workspace_bytes(WIDTH, HEIGHT);
    uint8_t *block = malloc(size + 16 + 2 * CANARY_BYTES);
    assert_non_null(block);
    for (size_t offset = 0; offset < 16; offset++) {
        uint8_t *workspace = block + CANARY_BYTES + offset;
        memset(block, CANARY, size + 16 + 2 * CANARY_BYTES);
        call *c = good_call();
        assert_tape_read(c, tapemark_decode(&c->image, NULL, workspace, size, &c->result));
        for (size_t i = 0; i < CANARY_BYTES; i++) {
            assert_int_equal(workspace[-1 - (ptrdiff_t)i], CANARY);
            assert_int_equal(workspace[size + i], CANARY);
        }
    }
    free(block);
}

/* What the workspace held before makes no difference. */
static void the_workspace_needs_no_preparation(void **state)
{
    (void)state;
    for (int fill = 0; fill < 256; fill += 51) {
        call *c = good_call();
        memset(c->workspace, fill, sizeof c->workspace);
        assert_tape_read(c, run(c));
    }
}

static void results_are_the_same_each_time(void **state)
{
    (void)state;
    call *c = good_call();
    assert_tape_read(c, run(c));
    tapemark_cm cms[3];
    memcpy(cms, c->cms, sizeof cms);
    const uint32_t work = c->result.stats.work;
    assert_tape_read(c, run(c));
    assert_memory_equal(cms, c->cms, sizeof cms);
    assert_int_equal(c->result.stats.work, work);
}

/* The view is the middle of a larger picture, on pages that cannot be written to. Around it there is what a decoder
 * that looks beyond its view would stumble over. */
static void keeps_to_its_view_and_never_writes_to_it(void **state)
{
    (void)state;
    enum { STRIDE = WIDTH + 37, ROWS = HEIGHT + 4 };
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), size = (STRIDE * ROWS + page - 1) / page * page;
    uint8_t *picture = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(picture, MAP_FAILED);
    for (int pattern = 0; pattern < 2; pattern++) {
        assert_int_equal(mprotect(picture, size, PROT_READ | PROT_WRITE), 0);
        for (size_t i = 0; i < size; i++)
            picture[i] = pattern ? (uint8_t)(i / 3 % 2 * 255) : CANARY;
        for (int y = 0; y < HEIGHT; y++)
            memcpy(picture + (y + 2) * STRIDE + 5, tape_pixels + y * WIDTH, WIDTH);
        assert_int_equal(mprotect(picture, size, PROT_READ), 0);
        call *c = good_call();
        assert_tape_read(c, run(c));
        tapemark_cm cms[3];
        memcpy(cms, c->cms, sizeof cms);
        c->image = (tapemark_image){picture + 2 * STRIDE + 5, WIDTH, HEIGHT, STRIDE};
        assert_tape_read(c, run(c));
        assert_memory_equal(cms, c->cms, sizeof cms);
    }
    assert_int_equal(munmap(picture, size), 0);
}

/* The last row ends where memory ends, with nothing mapped behind; the stride would reach beyond. */
static void reads_nothing_behind_the_last_pixel(void **state)
{
    (void)state;
    enum { STRIDE = WIDTH + 100 };
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t bytes = STRIDE * (HEIGHT - 1) + WIDTH, size = (bytes + page - 1) / page * page;
    uint8_t *memory = mmap(NULL, size + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(memory, MAP_FAILED);
    assert_int_equal(mprotect(memory + size, page, PROT_NONE), 0);
    uint8_t *pixels = memory + size - bytes;
    for (int y = 0; y < HEIGHT; y++)
        memcpy(pixels + y * STRIDE, tape_pixels + y * WIDTH, WIDTH);
    call *c = good_call();
    c->image = (tapemark_image){pixels, WIDTH, HEIGHT, STRIDE};
    assert_tape_read(c, run(c));
    assert_int_equal(munmap(memory, size + page), 0);
}

/* ---- Room and budget -------------------------------------------------------------------------------------- */

static void says_when_there_is_no_room_for_cms(void **state)
{
    (void)state;
    for (size_t capacity = 1; capacity < 3; capacity++) {
        call *c = good_call();
        memset(c->cms, CANARY, sizeof c->cms);
        c->result.cm_capacity = capacity;
        assert_int_equal(run(c), TAPEMARK_NO_ROOM);
        assert_int_equal(c->result.cm_count, capacity);
        assert_int_equal(c->result.tm_count, 1);
        assert_int_equal(c->result.stats.limits, TAPEMARK_LIMIT_CMS);
        for (size_t i = 0; i < capacity; i++)
            assert_int_equal(c->cms[i].id, three_ids[i]);
        const uint8_t *behind = (const uint8_t *)&c->cms[capacity];
        for (size_t i = 0; i < sizeof c->cms[0]; i++)
            assert_int_equal(behind[i], CANARY);
    }
}

/* Two tapes, one above the other, and room for one. */
static void says_when_there_is_no_room_for_tms(void **state)
{
    (void)state;
    static uint8_t two[2 * HEIGHT * WIDTH], workspace[TAPEMARK_WORKSPACE_BYTES(WIDTH, 2 * HEIGHT)];
    memcpy(two, tape_pixels, sizeof tape_pixels);
    memcpy(two + sizeof tape_pixels, tape_pixels, sizeof tape_pixels);
    call *c = good_call();
    c->image = (tapemark_image){two, WIDTH, 2 * HEIGHT, WIDTH};
    c->result.tm_capacity = 1;
    assert_int_equal(tapemark_decode(&c->image, NULL, workspace, sizeof workspace, &c->result), TAPEMARK_NO_ROOM);
    assert_int_equal(c->result.tm_count, 1);
    assert_int_equal(c->result.cm_count, 6);
    assert_int_equal(c->result.stats.limits, TAPEMARK_LIMIT_TMS);
}

static void kinds_that_are_not_wanted_are_no_lack_of_room(void **state)
{
    (void)state;
    call *c = good_call();
    c->result.tms = NULL;
    c->result.tm_capacity = 0;
    assert_int_equal(run(c), TAPEMARK_OK);
    assert_int_equal(c->result.stats.limits, 0);
    assert_int_equal(c->result.tm_count, 0);
    assert_int_equal(c->result.cm_count, 3);
    for (size_t i = 0; i < 3; i++) {
        assert_int_equal(c->cms[i].tm, -1);
        assert_int_equal(c->cms[i].slot, -1);
    }
    c = good_call();
    c->result.cms = NULL;
    c->result.cm_capacity = 0;
    assert_int_equal(run(c), TAPEMARK_OK);
    assert_int_equal(c->result.stats.limits, 0);
    assert_int_equal(c->result.cm_count, 0);
    assert_int_equal(c->result.tm_count, 1);
}

static void finders_that_do_not_fit_are_no_loss(void **state)
{
    (void)state;
    for (size_t capacity = 0; capacity < 3; capacity++) {
        call *c = good_call();
        c->result.finder_capacity = capacity;
        if (capacity == 0)
            c->result.finders = NULL;
        assert_tape_read(c, run(c));
        assert_int_equal(c->result.finder_count, capacity);
    }
}

static void says_when_the_budget_was_spent(void **state)
{
    (void)state;
    call *c = good_call();
    c->config.work_budget = 1;
    assert_int_equal(run(c), TAPEMARK_UNFINISHED);
    assert_int_equal(c->result.cm_count, 0);
    assert_true((c->result.stats.limits & (TAPEMARK_LIMIT_SCAN | TAPEMARK_LIMIT_WORK)) != 0);
}

/* Whatever the budget, what is read is right, and with enough of it all is. */
static void a_small_budget_makes_up_nothing(void **state)
{
    (void)state;
    for (uint32_t budget = 500; budget <= 64000; budget *= 2) {
        call *c = good_call();
        c->config.work_budget = budget;
        const tapemark_status status = run(c);
        if (status == TAPEMARK_NOTHING_FOUND)
            fail_msg("a budget of %u was not enough, and nothing was said about it", (unsigned)budget);
        for (size_t i = 0; i < c->result.cm_count; i++)
            assert_true(c->cms[i].id == 12 || c->cms[i].id == 13 || c->cms[i].id == -14);
        if (budget == 64000)
            assert_tape_read(c, status);
    }
}

static void the_statistics_add_up(void **state)
{
    (void)state;
    call *c = good_call();
    assert_tape_read(c, run(c));
    const tapemark_stats *s = &c->result.stats;
    assert_int_equal(s->limits, 0);
    assert_int_equal(s->tiles, TAPEMARK_TILES(WIDTH) * TAPEMARK_TILES(HEIGHT));
    assert_in_range(s->tiles_active, 1, s->tiles);
    assert_true(s->pattern_hits >= s->finders_tried);
    assert_in_range(s->finders, 4, COUNT_OF(c->finders));
    assert_int_equal(s->finders, c->result.finder_count);
    assert_true(s->segments >= 1 && s->cms_tried >= 3);
    assert_in_range(s->work, 1, tapemark_default_work_budget(WIDTH, HEIGHT));
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_call_reads_the_tape),
        cmocka_unit_test(refuses_null),
        cmocka_unit_test(refuses_arrays_that_are_null_but_not_empty),
        cmocka_unit_test(refuses_bad_images),
        cmocka_unit_test(refuses_a_workspace_that_is_too_small),
        cmocka_unit_test(sizes_out_of_range_have_no_workspace_and_no_budget),
        cmocka_unit_test(refuses_fields_out_of_range),
        cmocka_unit_test(refuses_what_is_no_number),
        cmocka_unit_test(refuses_known_ids_out_of_order),
        cmocka_unit_test(takes_fields_at_the_ends_of_their_ranges),
        cmocka_unit_test(any_alignment_of_the_workspace_will_do),
        cmocka_unit_test(the_workspace_needs_no_preparation),
        cmocka_unit_test(results_are_the_same_each_time),
        cmocka_unit_test(keeps_to_its_view_and_never_writes_to_it),
        cmocka_unit_test(reads_nothing_behind_the_last_pixel),
        cmocka_unit_test(says_when_there_is_no_room_for_cms),
        cmocka_unit_test(says_when_there_is_no_room_for_tms),
        cmocka_unit_test(kinds_that_are_not_wanted_are_no_lack_of_room),
        cmocka_unit_test(finders_that_do_not_fit_are_no_loss),
        cmocka_unit_test(says_when_the_budget_was_spent),
        cmocka_unit_test(a_small_budget_makes_up_nothing),
        cmocka_unit_test(the_statistics_add_up),
    };
    return cmocka_run_group_tests(tests, render_tape, NULL);
}
