/* Frames of the most unlikely sizes and contents. Each is done within bounded work, and bounded processor time,
 * nothing is read that is not there, and the limits tell "nothing found" from "could not finish". */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "decoding.h"

#include <sys/mman.h>
#include <time.h>

#include "random.h"

enum { SLACK_READS = 40000, READS_PER_CM = 2500, READS_OF_FINDERS = 20 * 1500 };
enum { SECONDS_MAX = 20, PAPER = 210, INK = 25 };

static const int32_t ids[] = {71, -72, 73};
enum { IDS = 3 };

/* ---- Frames -------------------------------------------------------------------------------------------------- */

typedef struct frame {
    uint8_t *pixels;
    int32_t width_px, height_px;
} frame;

static frame make_frame(int32_t width_px, int32_t height_px, uint8_t shade)
{
    frame made = {malloc((size_t)width_px * (size_t)height_px), width_px, height_px};
    assert_non_null(made.pixels);
    memset(made.pixels, shade, (size_t)width_px * (size_t)height_px);
    return made;
}

/* A tape with its quiet zone and little more. */
static frame make_tape(double px_per_module)
{
    const double columns = 25.0 * IDS + 23 + 6, rows = 7 + 6;
    const frame made = make_frame((int32_t)(columns * px_per_module), (int32_t)(rows * px_per_module), 0);
    scene view = scene_default(made.width_px, made.height_px);
    scene_tape tape = scene_tape_of(ids, IDS, true);
    scene_place(&view, &tape, (scene_pose){.px_per_module = px_per_module});
    view.tapes = &tape;
    view.tape_count = 1;
    assert_true(scene_render(&view, made.pixels, NULL));
    return made;
}

static void paste(uint8_t *pixels, ptrdiff_t stride, int32_t x, int32_t y, const frame *what)
{
    for (int32_t row = 0; row < what->height_px; row++)
        memcpy(pixels + (y + row) * stride + x, what->pixels + (size_t)row * (size_t)what->width_px,
               (size_t)what->width_px);
}

static void fill_by(frame *f, bool (*is_dark)(int32_t x, int32_t y, int32_t size), int32_t size)
{
    for (int32_t y = 0; y < f->height_px; y++)
        for (int32_t x = 0; x < f->width_px; x++)
            f->pixels[(size_t)y * (size_t)f->width_px + (size_t)x] = is_dark(x, y, size) ? INK : PAPER;
}

/* ---- Bounds -------------------------------------------------------------------------------------------------- */

static void assert_bounded(const tapemark_result *result, const frame *f, clock_t since)
{
    const double seconds = (double)(clock() - since) / CLOCKS_PER_SEC;
    const uint32_t budget = tapemark_default_work_budget(f->width_px, f->height_px);
    if (result->stats.work > budget + SLACK_READS + READS_PER_CM * result->stats.cms_read + READS_OF_FINDERS)
        fail_msg("%d x %d px: %u reads with a budget of %u", (int)f->width_px, (int)f->height_px,
                 (unsigned)result->stats.work, (unsigned)budget);
    if (seconds > SECONDS_MAX)
        fail_msg("%d x %d px: %.1f s of processor time", (int)f->width_px, (int)f->height_px, seconds);
}

/* Decodes, and sees to it that what is read are these ids alone, and that the answer fits the limits. */
static const decoding *decode_frame(const frame *f)
{
    const clock_t since = clock();
    const decoding *got = decode_pixels(f->pixels, f->width_px, f->height_px, NULL);
    const tapemark_result *result = &got->result;
    assert_bounded(result, f, since);
    for (size_t i = 0; i < result->cm_count; i++)
        assert_true(got->cms[i].id == ids[0] || got->cms[i].id == ids[1] || got->cms[i].id == ids[2]);
    for (size_t i = 0; i < result->tm_count; i++)
        assert_string_equal(got->tms[i].code, "101");
    if (result->stats.limits & (TAPEMARK_LIMIT_CMS | TAPEMARK_LIMIT_TMS))
        assert_int_equal(got->status, TAPEMARK_NO_ROOM);
    else if (result->cm_count + result->tm_count > 0)
        assert_int_equal(got->status, TAPEMARK_OK);
    else
        assert_int_equal(got->status, result->stats.limits ? TAPEMARK_UNFINISHED : TAPEMARK_NOTHING_FOUND);
    return got;
}

static const decoding *decode_nothing(const frame *f)
{
    const decoding *got = decode_frame(f);
    assert_int_equal(got->result.cm_count + got->result.tm_count, 0);
    return got;
}

/* ---- Sizes --------------------------------------------------------------------------------------------------- */

static void reads_a_tape_at_the_far_end_of_the_longest_frames(void **state)
{
    (void)state;
    enum { LONGEST = 65535 };
    frame tape = make_tape(2.5);
    frame wide = make_frame(LONGEST, tape.height_px, PAPER), high = make_frame(tape.width_px, LONGEST, PAPER);
    paste(wide.pixels, LONGEST, LONGEST - tape.width_px, 0, &tape);
    paste(high.pixels, high.width_px, 0, LONGEST - tape.height_px, &tape);
    assert_int_equal(decode_frame(&wide)->result.cm_count, IDS);
    const decoding *got = decode_frame(&high);
    assert_int_equal(got->result.cm_count, IDS);
    assert_true((int)got->cms[0].corners[0].y_px > LONGEST - tape.height_px);
    free(tape.pixels);
    free(wide.pixels);
    free(high.pixels);
}

#if SIZE_MAX > UINT32_MAX && !defined(__SANITIZE_ADDRESS__)
/* 65535 x 65535 px, of which all pages but a few are the system's page of zeros: no place in it is out of reach. */
static void reads_a_tape_in_the_last_corner_of_the_largest_frame(void **state)
{
    (void)state;
    enum { SIDE = 65535 };
    const size_t bytes = (size_t)SIDE * SIDE, workspace_bytes = tapemark_workspace_bytes(SIDE, SIDE);
    uint8_t *pixels = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    uint8_t *workspace = malloc(workspace_bytes);
    assert_true(pixels != MAP_FAILED);
    assert_non_null(workspace);
    frame tape = make_tape(3);
    paste(pixels, SIDE, SIDE - tape.width_px, SIDE - tape.height_px, &tape);
    tapemark_cm cms[4];
    tapemark_result result = {.cms = cms, .cm_capacity = COUNT_OF(cms)};
    const tapemark_image image = {pixels, SIDE, SIDE, SIDE};
    const frame all = {pixels, SIDE, SIDE};
    const clock_t since = clock();
    assert_int_equal(tapemark_decode(&image, NULL, workspace, workspace_bytes, &result), TAPEMARK_OK);
    assert_bounded(&result, &all, since);
    assert_int_equal(result.cm_count, IDS);
    assert_true((int)cms[0].corners[0].x_px > SIDE - tape.width_px);
    assert_true((int)cms[0].corners[0].y_px > SIDE - tape.height_px);
    free(tape.pixels);
    free(workspace);
    munmap(pixels, bytes);
}
#endif

static void odd_sizes_read_what_is_in_them(void **state)
{
    (void)state;
    static const int32_t margins[][2] = {{0, 0}, {1, 1}, {3, 2}, {5, 7}, {13, 11}, {16, 16}, {17, 31}, {33, 1}};
    frame tape = make_tape(2.5);
    for (size_t i = 0; i < COUNT_OF(margins); i++) {
        frame f = make_frame(tape.width_px + margins[i][0], tape.height_px + margins[i][1], PAPER);
        paste(f.pixels, f.width_px, margins[i][0], margins[i][1], &tape);
        assert_int_equal(decode_frame(&f)->result.cm_count, IDS);
        free(f.pixels);
    }
    free(tape.pixels);
}

/* What lies between the rows is neither read nor written: whatever it is, the reading is the same. */
static void bytes_between_rows_do_not_matter(void **state)
{
    (void)state;
    frame tape = make_tape(3);
    const size_t workspace_bytes = tapemark_workspace_bytes(tape.width_px, tape.height_px);
    uint8_t *workspace = malloc(workspace_bytes);
    tapemark_cm cms[5][4] = {{{0}}};
    for (int gap = 1; gap <= 5; gap++) {
        const ptrdiff_t stride = tape.width_px + 37 * gap;
        const size_t bytes = (size_t)stride * (size_t)(tape.height_px - 1) + (size_t)tape.width_px;
        uint8_t *pixels = malloc(bytes), *before = malloc(bytes);
        assert_true(workspace && pixels && before);
        random_source source = {(uint64_t)gap};
        for (size_t i = 0; i < bytes; i++)
            pixels[i] = (uint8_t)(random_bits(&source) >> 40);
        paste(pixels, stride, 0, 0, &tape);
        memcpy(before, pixels, bytes);
        tapemark_result result = {.cms = cms[gap - 1], .cm_capacity = 4};
        const tapemark_image image = {pixels, tape.width_px, tape.height_px, stride};
        assert_int_equal(tapemark_decode(&image, NULL, workspace, workspace_bytes, &result), TAPEMARK_OK);
        assert_int_equal(result.cm_count, IDS);
        assert_memory_equal(pixels, before, bytes);
        for (size_t i = 0; i < IDS; i++)
            assert_memory_equal(cms[gap - 1][i].corners, cms[0][i].corners, sizeof cms[0][i].corners);
        free(pixels);
        free(before);
    }
    free(workspace);
    free(tape.pixels);
}

/* ---- Contents ------------------------------------------------------------------------------------------------- */

static bool in_checkerboard(int32_t x, int32_t y, int32_t size)
{
    return (x / size + y / size) % 2;
}

static bool in_stripe_down(int32_t x, int32_t y, int32_t size)
{
    (void)y;
    return x / size % 2;
}

static bool in_stripe_across(int32_t x, int32_t y, int32_t size)
{
    (void)x;
    return y / size % 2;
}

static bool in_slanted_stripe(int32_t x, int32_t y, int32_t size)
{
    return (3 * x + y) / (3 * size) % 2;
}

static void regular_patterns_hold_nothing(void **state)
{
    (void)state;
    bool (*const patterns[])(int32_t, int32_t, int32_t) = {in_checkerboard, in_stripe_down, in_stripe_across,
                                                           in_slanted_stripe};
    frame f = make_frame(333, 257, 0);
    for (size_t i = 0; i < COUNT_OF(patterns); i++)
        for (int32_t size = 1; size <= 64; size++) {
            fill_by(&f, patterns[i], size);
            decode_nothing(&f);
        }
    free(f.pixels);
}

static bool in_finder(int32_t x, int32_t y)
{
    const int32_t dx = abs(x - 3), dy = abs(y - 3), ring = dx > dy ? dx : dy;
    return ring <= 1 || ring == 3;
}

static bool in_close_finders(int32_t x, int32_t y, int32_t size)
{
    return x / size % 9 < 7 && y / size % 9 < 7 && in_finder(x / size % 9, y / size % 9);
}

/* Each a CM's length from the next, to all sides. */
static bool in_finders_a_pitch_apart(int32_t x, int32_t y, int32_t size)
{
    return x / size % 25 < 7 && y / size % 25 < 7 && in_finder(x / size % 25, y / size % 25);
}

/* A finder pattern whose core is a finder pattern, and so on. */
static bool in_nested_finders(int32_t x, int32_t y, int32_t size)
{
    double side = 49.0 * size, u = (x % (25 * 7 * size)) / side * 7, v = (y % (16 * 7 * size)) / side * 7;
    if (u >= 7 || v >= 7)
        return false;
    while (u > 2 && u < 5 && v > 2 && v < 5) {
        u = (u - 2) * 7 / 3;
        v = (v - 2) * 7 / 3;
        side *= 3.0 / 7;
        if (side < 4)
            return true;
    }
    return in_finder((int32_t)u, (int32_t)v);
}

static void frames_full_of_finders_are_cut_and_say_so(void **state)
{
    (void)state;
    bool (*const patterns[])(int32_t, int32_t, int32_t) = {in_close_finders, in_finders_a_pitch_apart};
    frame f = make_frame(4056, 3040, 0);
    for (size_t i = 0; i < COUNT_OF(patterns); i++)
        for (int32_t size = 1; size <= 9; size += 4) {
            fill_by(&f, patterns[i], size);
            const decoding *got = decode_nothing(&f);
            assert_int_equal(got->status, TAPEMARK_UNFINISHED);
            assert_true(got->result.stats.limits & (TAPEMARK_LIMIT_CANDIDATES | TAPEMARK_LIMIT_WORK));
        }
    free(f.pixels);
}

static void finders_in_finders_are_no_marker(void **state)
{
    (void)state;
    frame f = make_frame(1400, 900, 0);
    for (int32_t size = 1; size <= 4; size++) {
        fill_by(&f, in_nested_finders, size);
        assert_true(decode_nothing(&f)->result.stats.pattern_hits > 0);
    }
    free(f.pixels);
}

/* More than there is room for by far: what is read is right, and it is told that there was more. */
static void a_thousand_tapes_in_a_frame_are_cut_and_say_so(void **state)
{
    (void)state;
    frame tape = make_tape(3), f = make_frame(4056, 3040, PAPER);
    int count = 0;
    for (int32_t y = 0; y + tape.height_px <= f.height_px; y += tape.height_px)
        for (int32_t x = 0; x + tape.width_px <= f.width_px; x += tape.width_px, count++)
            paste(f.pixels, f.width_px, x, y, &tape);
    assert_in_range(count, 900, 2000);
    const decoding *got = decode_frame(&f);
    assert_true(got->result.stats.limits & TAPEMARK_LIMIT_CANDIDATES);
    free(tape.pixels);
    free(f.pixels);
}

static void reads_one_marker_of_4000_px(void **state)
{
    (void)state;
    enum { MODULE = 125, WIDTH = 4056, HEIGHT = 1024 };
    uint8_t modules[32 * 7];
    assert_int_equal(tapemark_segment_draw(ids, 1, false, modules, sizeof modules), TAPEMARK_OK);
    frame f = make_frame(WIDTH, HEIGHT, PAPER);
    for (int32_t y = 0; y < 7 * MODULE; y++)
        for (int32_t x = 0; x < 32 * MODULE; x++)
            if (modules[y / MODULE * 32 + x / MODULE])
                f.pixels[(size_t)(y + 70) * WIDTH + (size_t)(x + 28)] = INK;
    const decoding *got = decode_frame(&f);
    assert_int_equal(got->result.cm_count, 1);
    assert_int_equal(got->cms[0].id, ids[0]);
    free(f.pixels);
}

/* A picture of a tape hangs below the tape; in the picture hangs a picture of a tape below the tape. */
static void pictures_of_pictures_read_what_they_show(void **state)
{
    (void)state;
    enum { WIDTH = 1280, HEIGHT = 800 };
    frame shown = make_frame(WIDTH, HEIGHT, PAPER), f = make_frame(WIDTH, HEIGHT, PAPER);
    for (int depth = 0; depth < 4; depth++) {
        scene view = scene_default(WIDTH, HEIGHT);
        scene_tape tape = scene_tape_of(ids, IDS, true);
        scene_place(&view, &tape, (scene_pose){.px_per_module = 9, .dy_px = -300, .roll_deg = 2});
        scene_picture picture = scene_picture_of(shown.pixels, WIDTH, HEIGHT, 0.75);
        scene_place_picture(&view, &picture, (scene_pose){.px_per_module = 0.7, .dy_px = 90, .roll_deg = -3});
        view.tapes = &tape;
        view.tape_count = 1;
        view.pictures = &picture;
        view.picture_count = 1;
        assert_true(scene_render(&view, f.pixels, NULL));
        const decoding *got = decode_frame(&f);
        assert_in_range(got->result.cm_count, depth == 0 ? IDS : 2 * IDS, (depth + 1) * IDS);
        memcpy(shown.pixels, f.pixels, (size_t)WIDTH * HEIGHT);
    }
    free(shown.pixels);
    free(f.pixels);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_a_tape_at_the_far_end_of_the_longest_frames),
#if SIZE_MAX > UINT32_MAX && !defined(__SANITIZE_ADDRESS__)
        cmocka_unit_test(reads_a_tape_in_the_last_corner_of_the_largest_frame),
#endif
        cmocka_unit_test(odd_sizes_read_what_is_in_them),
        cmocka_unit_test(bytes_between_rows_do_not_matter),
        cmocka_unit_test(regular_patterns_hold_nothing),
        cmocka_unit_test(frames_full_of_finders_are_cut_and_say_so),
        cmocka_unit_test(finders_in_finders_are_no_marker),
        cmocka_unit_test(a_thousand_tapes_in_a_frame_are_cut_and_say_so),
        cmocka_unit_test(reads_one_marker_of_4000_px),
        cmocka_unit_test(pictures_of_pictures_read_what_they_show),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
