/* A tape in tiles on A4, put together again as people do it: by the crosses at its joints, which are looked for in
 * the rasterised pages, and not quite in line. */
#include "printing.h"

#include <math.h>

enum { DPI = 200, CROSSES_MAX = 64 };
static const double MODULE_MM = 6, FLAP_MM = 6, BAND_MM = 4.5;

/* ---- Crosses ------------------------------------------------------------------------------------------- */

typedef struct cross {
    size_t page;
    double x_px, y_px;
} cross;

static double lightest_of_arm(const raster *page, int32_t x, int32_t y, int dx, int dy)
{
    double lightest = 0;
    for (double away_mm = 0.3; away_mm < 1.4; away_mm += 0.1) {
        double away_px = away_mm * page->px_per_mm, darkest = 255;
        for (int side = -1; side <= 1; side++)
            darkest = fmin(darkest, raster_at(page, x + dx * away_px + dy * side, y + dy * away_px + dx * side));
        lightest = fmax(lightest, darkest);
    }
    return lightest;
}

/* Four thin arms, and nothing between them. */
static bool is_cross(const raster *page, int32_t x, int32_t y)
{
    double away_px = 0.9 * page->px_per_mm;
    if (page->pixels[(size_t)y * (size_t)page->width_px + (size_t)x] > 170)
        return false;
    for (int i = 0; i < 4; i++) {
        if (raster_at(page, x + (i % 2 == 0 ? away_px : -away_px), y + (i / 2 == 0 ? away_px : -away_px)) < 230)
            return false;
    }
    return lightest_of_arm(page, x, y, 1, 0) < 200 && lightest_of_arm(page, x, y, -1, 0) < 200 &&
           lightest_of_arm(page, x, y, 0, 1) < 200 && lightest_of_arm(page, x, y, 0, -1) < 200;
}

/* The centre of what is dark around x and y along one axis, on the arms of the other axis. */
static double arm_centre(const raster *page, double x, double y, bool upright)
{
    double sum = 0, weight = 0;
    for (double away_px = 4; away_px <= 11; away_px++) {
        for (int end = -1; end <= 1; end += 2) {
            for (int side = -3; side <= 3; side++) {
                double along = end * away_px;
                double dark = 255 - raster_at(page, x + (upright ? side : along), y + (upright ? along : side));
                sum += dark * side;
                weight += dark;
            }
        }
    }
    return (upright ? x : y) + sum / weight;
}

static size_t find_crosses(const raster *page, size_t number, cross *crosses)
{
    size_t count = 0;
    for (int32_t y = 0; y < page->height_px; y++) {
        for (int32_t x = 0; x < page->width_px; x++) {
            size_t known = 0;
            if (!is_cross(page, x, y))
                continue;
            while (known < count && hypot(crosses[known].x_px - x, crosses[known].y_px - y) > 5)
                known++;
            if (known == count) {
                assert_true(count < CROSSES_MAX);
                crosses[count++] = (cross){number, x, y};
            }
        }
    }
    for (size_t i = 0; i < count; i++) {
        double x = round(crosses[i].x_px), y = round(crosses[i].y_px);
        crosses[i].x_px = arm_centre(page, x, y, true);
        crosses[i].y_px = arm_centre(page, x, y, false);
    }
    return count;
}

/* ---- Joints -------------------------------------------------------------------------------------------- */

/* An upper and a lower cross. */
typedef struct joint {
    size_t page;
    double x_px, top_px, bottom_px;
} joint;

static int compare_joints(const void *a, const void *b)
{
    const joint *first = a, *second = b;
    if (first->page != second->page)
        return first->page < second->page ? -1 : 1;
    if (fabs(first->top_px - second->top_px) > 20)
        return first->top_px < second->top_px ? -1 : 1;
    return first->x_px < second->x_px ? -1 : 1;
}

/* In the order of the tape: behind the first tile, before the second one, behind it, … */
static size_t find_joints(const raster_pages *pages, joint *joints)
{
    cross crosses[CROSSES_MAX];
    size_t count = 0;
    for (size_t number = 0; number < pages->count; number++) {
        const raster *page = &pages->items[number];
        double apart_px = (9 * MODULE_MM + BAND_MM) * page->px_per_mm;
        size_t cross_count = find_crosses(page, number, crosses);
        for (size_t i = 0; i < cross_count; i++) {
            for (size_t k = 0; k < cross_count; k++) {
                if (fabs(crosses[k].x_px - crosses[i].x_px) < 1 &&
                    fabs(crosses[k].y_px - crosses[i].y_px - apart_px) < 1.5) {
                    assert_true(count < CROSSES_MAX);
                    joints[count++] = (joint){number, crosses[i].x_px, crosses[i].y_px, crosses[k].y_px};
                }
            }
        }
    }
    qsort(joints, count, sizeof *joints, compare_joints);
    return count;
}

/* ---- Gluing -------------------------------------------------------------------------------------------- */

/* From the assembled tape to a page: turned about the joint's middle. */
typedef struct pose {
    double page_x, page_y;            /* of the middle of the joint before, on the page */
    double x, y;                      /* of the same on the assembled tape */
    double cosine, sine;
} pose;

static void to_tape(const pose *at, double page_x, double page_y, double *x, double *y)
{
    double dx = page_x - at->page_x, dy = page_y - at->page_y;
    *x = at->x + at->cosine * dx - at->sine * dy;
    *y = at->y + at->sine * dx + at->cosine * dy;
}

typedef struct tile {
    const raster *page;
    double left_px, right_px, top_px, bottom_px;  /* to be cut out */
} tile;

/* What is glued on later covers what was there. */
static void glue(raster *tape, const tile *cut, const pose *at)
{
    const double slack_px = 20;  /* for what is turned */
    int32_t begin = (int32_t)fmax(at->x + cut->left_px - at->page_x - slack_px, 0);
    int32_t end = (int32_t)fmin(at->x + cut->right_px - at->page_x + slack_px, tape->width_px);
    for (int32_t y = 0; y < tape->height_px; y++) {
        for (int32_t x = begin; x < end; x++) {
            double dx = x - at->x, dy = y - at->y;
            double page_x = at->page_x + at->cosine * dx + at->sine * dy;
            double page_y = at->page_y - at->sine * dx + at->cosine * dy;
            if (page_x >= cut->left_px && page_x <= cut->right_px && page_y >= cut->top_px &&
                page_y <= cut->bottom_px)
                tape->pixels[(size_t)y * (size_t)tape->width_px + (size_t)x] =
                    (uint8_t)lround(raster_at(cut->page, page_x, page_y));
        }
    }
}

static tile tile_of(const raster_pages *pages, const joint *before, const joint *after)
{
    const joint *any = before != NULL ? before : after;
    const raster *page = &pages->items[any->page];
    double flap_px = FLAP_MM * page->px_per_mm, band_px = BAND_MM / 2 * page->px_per_mm;
    return (tile){page, before != NULL ? before->x_px : 0,
                  after != NULL ? after->x_px + flap_px : page->width_px, any->top_px - band_px,
                  any->bottom_px + band_px};
}

/* Each next tile by so much too far along and across, and turned, in turns to one side and the other. */
typedef struct clumsiness {
    double along_mm, across_mm, turn_deg;
} clumsiness;

static raster assemble(const raster_pages *pages, const joint *joints, size_t joint_count, const clumsiness *hands)
{
    const double px_per_mm = DPI / 25.4, radians_per_degree = 0.017453292519943295;
    size_t tile_count = joint_count / 2 + 1;
    raster tape = {NULL, (int32_t)(2400 * px_per_mm), (int32_t)((9 * MODULE_MM + 30) * px_per_mm), px_per_mm};
    tape.pixels = malloc((size_t)tape.width_px * (size_t)tape.height_px);
    assert_non_null(tape.pixels);
    memset(tape.pixels, 255, (size_t)tape.width_px * (size_t)tape.height_px);
    double angle = 0, middle_px = tape.height_px / 2.0;
    pose at = {0, (joints[0].top_px + joints[0].bottom_px) / 2, 0, middle_px, 1, 0};
    for (size_t i = 0; i < tile_count; i++) {
        const joint *before = i > 0 ? &joints[2 * i - 1] : NULL;
        const joint *after = i + 1 < tile_count ? &joints[2 * i] : NULL;
        if (before != NULL) {
            const joint *last = before - 1;
            double x, y, side = i % 2 == 0 ? 1 : -1;
            to_tape(&at, last->x_px, (last->top_px + last->bottom_px) / 2, &x, &y);
            angle += side * (i == 1 ? 1 : 2) * hands->turn_deg * radians_per_degree;
            at = (pose){before->x_px, (before->top_px + before->bottom_px) / 2,
                        x + side * hands->along_mm * px_per_mm, y + side * hands->across_mm * px_per_mm, cos(angle),
                        sin(angle)};
        }
        const tile cut = tile_of(pages, before, after);
        glue(&tape, &cut, &at);
    }
    return tape;
}

/* ---- Tests --------------------------------------------------------------------------------------------- */

/* A TM of five, a CM alone and a TM of three: joints within both TMs, and beside bars. */
static hand_tape tape_to_cut(void)
{
    static const int32_t ids[] = {41, -42, 43, -44, -45, 46, -47, -48, 49};
    static const hand_segment segments[] = {{0, 5, true}, {0, 1, false}, {0, 3, true}};
    return hand_tape_new(MODULE_MM, ids, segments, COUNT_OF(segments));
}

static raster_pages print_tiles(const hand_tape *tape, print_summary *summary)
{
    error_text error = {""};
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    const print_settings settings = {.paper = PRINT_A4};
    if (!print_pdf(&tape->wanted, &tape->layout, &settings, path, summary, &error))
        fail_msg("%s", error.text);
    raster_pages pages = rasterise(path, DPI);
    remove_folder(folder);
    return pages;
}

static void assembled_tape_is_read(void **state)
{
    static const clumsiness hands[] = {{0, 0, 0}, {0.3, 0.3, 0.3}, {-0.3, 0.3, -0.3}, {0.3, -0.3, 0}};
    static readings read;
    joint joints[CROSSES_MAX];
    print_summary summary;
    (void)state;
    hand_tape tape = tape_to_cut();
    raster_pages pages = print_tiles(&tape, &summary);
    assert_in_range(summary.joints, 6, 12);
    size_t joint_count = find_joints(&pages, joints);
    assert_int_equal(joint_count, 2 * summary.joints);
    for (size_t i = 0; i < COUNT_OF(hands); i++) {
        raster assembled = assemble(&pages, joints, joint_count, &hands[i]);
        read_markers(&assembled, &read);
        assert_reads_all(&tape, &read);
        raster_release(&assembled);
    }
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

/* Put together without a slip, the tape is as long as it was laid, and each module where it belongs. */
static void assembled_tape_has_its_length(void **state)
{
    static readings read;
    joint joints[CROSSES_MAX];
    print_summary summary;
    (void)state;
    hand_tape tape = tape_to_cut();
    raster_pages pages = print_tiles(&tape, &summary);
    size_t joint_count = find_joints(&pages, joints);
    raster assembled = assemble(&pages, joints, joint_count, &(clumsiness){0, 0, 0});
    read_markers(&assembled, &read);
    assert_int_equal(read.tm_count, 2);
    const tapemark_point *first = read.tms[0].corners, *last = read.tms[1].corners;
    const layout_segment *segments = tape.layout.segments;
    double length_modules = segments[2].start_modules + 98.0 - segments[0].start_modules;
    double dx_px = (double)last[1].x_px - (double)first[0].x_px, dy_px = (double)last[1].y_px - (double)first[0].y_px;
    double length_px = hypot(dx_px, dy_px);
    /* Each joint is found to some hundredths of a millimetre. */
    assert_near(length_px / assembled.px_per_mm, length_modules * MODULE_MM, 0.1 + 0.05 * (double)summary.joints);
    assert_modules(&assembled, tape.layout.ids + 6, 3, true, last);
    raster_release(&assembled);
    raster_pages_release(&pages);
    hand_tape_release(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(assembled_tape_is_read),
        cmocka_unit_test(assembled_tape_has_its_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
