/* The picture of a plan: the decoder reads the tape in it, where it hangs and facing where it should. */
#include "printing.h"

#include <math.h>
#include <time.h>

/* A room so small that its tape is drawn module by module, large enough for the decoder: one CM on each wall, facing
 * into the room, and one on the floor. */
static hand_tape small_room(void)
{
    static const int32_t ids[] = {10, -11, 12, -13, 14};
    static const hand_segment segments[] = {
        {0, 1, false}, {1, 1, false}, {2, 1, false}, {3, 1, false}, {4, 1, false}};
    static const plan_line lines[] = {{{0.1, 0}, {0.8, 0}, PLAN_ON_WALL, 0.1},
                                      {{1, 0.05}, {1, 0.7}, PLAN_ON_WALL, 0.1},
                                      {{0.9, 0.75}, {0.2, 0.75}, PLAN_ON_WALL, 0.1},
                                      {{0, 0.7}, {0, 0.05}, PLAN_ON_WALL, 0.1},
                                      {{0.3, 0.3}, {0.7, 0.5}, PLAN_ON_FLOOR, 0}};
    hand_tape tape = hand_tape_new(8, ids, segments, COUNT_OF(segments));
    tape.wanted.width_m = 1;
    tape.wanted.height_m = 0.75;
    memcpy(tape.wanted.lines, lines, sizeof lines);
    return tape;
}

static raster preview_of(const hand_tape *tape)
{
    error_text error = {""};
    const char *folder = new_folder(), *path = path_in(folder, "plan.png");
    if (!print_preview(&tape->wanted, &tape->layout, path, &error))
        fail_msg("%s", error.text);
    raster picture = raster_read(path, 0);
    remove_folder(folder);
    return picture;
}

static const tapemark_cm *find_cm(const readings *read, int32_t id)
{
    for (size_t i = 0; i < read->cm_count; i++) {
        if (read->cms[i].id == id)
            return &read->cms[i];
    }
    fail_msg("CM %d is not seen", (int)id);
    return NULL;
}

/* The unit vector from a corner to another one. */
static tapemark_point direction(tapemark_point from, tapemark_point to)
{
    float x = to.x_px - from.x_px, y = to.y_px - from.y_px, length = hypotf(x, y);
    return (tapemark_point){x / length, y / length};
}

/* 0.1 is less than six degrees. */
static void assert_direction(tapemark_point seen, double x, double y)
{
    assert_near(seen.x_px, x, 0.1);
    assert_near(seen.y_px, y, 0.1);
}

static void tape_hangs_on_its_lines_and_faces_the_room(void **state)
{
    static readings read;
    (void)state;
    hand_tape tape = small_room();
    raster picture = preview_of(&tape);
    read_markers(&picture, &read);
    assert_int_equal(read.cm_count, 5);
    const tapemark_cm *top = find_cm(&read, 10);
    /* Of the CM's 32 modules of 8 mm, on the plan. */
    double px_per_m = ((double)top->corners[1].x_px - (double)top->corners[0].x_px) / (32 * 0.008);
    /* The room's corner, from the CM whose ink begins a module after its line. */
    double left_px = (double)top->corners[0].x_px - (0.1 + 0.008) * px_per_m;
    double top_px = (double)top->corners[0].y_px;
    for (size_t i = 0; i < tape.layout.segment_count; i++) {
        const plan_line *line = &tape.wanted.lines[i];
        const tapemark_cm *cm = find_cm(&read, tape.layout.ids[i]);
        double dx = line->to.x_m - line->from.x_m, dy = line->to.y_m - line->from.y_m, length = hypot(dx, dy);
        assert_direction(direction(cm->corners[0], cm->corners[1]), dx / length, dy / length);
        /* The lower edge lies to the right of the line's direction. */
        assert_direction(direction(cm->corners[0], cm->corners[3]), -dy / length, dx / length);
        double u_m = 0.008, v_m = line->mount == PLAN_ON_FLOOR ? -0.028 : 0;
        double x_m = line->from.x_m + (u_m * dx - v_m * dy) / length;
        double y_m = line->from.y_m + (u_m * dy + v_m * dx) / length;
        /* Tape on a wall is drawn a hair beside it. */
        assert_near(((double)cm->corners[0].x_px - left_px) / px_per_m, x_m, 0.008);
        assert_near(((double)cm->corners[0].y_px - top_px) / px_per_m, y_m, 0.008);
    }
    raster_release(&picture);
    hand_tape_release(&tape);
}

/* A gray picture of a single value fills the room, and makes it less light than the page around it. */
static void a_background_fills_the_room(void **state)
{
    static const char pgm[] = "P5\n4 4\n255\n\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40\x40";
    (void)state;
    hand_tape tape = small_room();
    const char *folder = new_folder();
    char path[512];
    snprintf(path, sizeof path, "%s", path_in(folder, "floor.pgm"));
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(pgm, 1, sizeof pgm - 1, file), sizeof pgm - 1);
    assert_int_equal(fclose(file), 0);
    raster plain = preview_of(&tape);
    tape.wanted.background_path = path;
    raster filled = preview_of(&tape);
    assert_int_equal(filled.width_px, plain.width_px);
    /* Three quarters of the way across the room, between its walls' tapes. */
    double x_px = 0.75 * filled.width_px, y_px = 0.3 * filled.height_px;
    assert_true(raster_at(&plain, x_px, y_px) > 220);
    assert_in_range(raster_at(&filled, x_px, y_px), 120, 200);
    assert_int_equal(raster_at(&filled, 2, 2), 255);
    raster_release(&plain);
    raster_release(&filled);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void an_unreadable_background_is_told(void **state)
{
    (void)state;
    hand_tape tape = small_room();
    const char *folder = new_folder();
    char background[512], path[512];
    snprintf(background, sizeof background, "%s", path_in(folder, "floor.jpg"));
    snprintf(path, sizeof path, "%s", path_in(folder, "plan.png"));
    tape.wanted.background_path = background;
    error_text error = {""};
    assert_false(print_preview(&tape.wanted, &tape.layout, path, &error));
    assert_non_null(strstr(error.text, "floor.jpg"));
    FILE *file = fopen(background, "wb");
    assert_non_null(file);
    assert_true(fputs("\xff\xd8\xff no picture", file) >= 0);
    assert_int_equal(fclose(file), 0);
    assert_false(print_preview(&tape.wanted, &tape.layout, path, &error));
    assert_non_null(strstr(error.text, "floor.jpg"));
    assert_int_equal(list_folder(folder, NULL, 0), 1);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void a_preview_that_cannot_be_written_is_told(void **state)
{
    (void)state;
    hand_tape tape = small_room();
    error_text error = {""};
    assert_false(print_preview(&tape.wanted, &tape.layout, "/dev/full", &error));
    assert_non_null(strstr(error.text, "/dev/full"));
    assert_non_null(strstr(error.text, "No space left on device"));
    hand_tape_release(&tape);
}

/* Rooms of every shape: pictures stay within what can be looked at. */
static void rooms_of_every_shape_are_drawn(void **state)
{
    static const double shapes[][2] = {{0.1, 0.1}, {2500, 0.1}, {0.1, 2500}, {2500, 2500}, {6, 4}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        hand_tape tape = small_room();
        tape.wanted.width_m = shapes[i][0];
        tape.wanted.height_m = shapes[i][1];
        for (size_t line = 0; line < tape.wanted.line_count; line++)
            tape.wanted.lines[line] = (plan_line){{0, 0}, {shapes[i][0], shapes[i][1]}, PLAN_ON_WALL, 0};
        raster picture = preview_of(&tape);
        assert_in_range(picture.width_px, 150, 4000);
        assert_in_range(picture.height_px, 150, 4000);
        raster_release(&picture);
        hand_tape_release(&tape);
    }
}

/* Near a row, in a column. */
static bool is_dark_near(const raster *picture, double x_px, double y_px)
{
    bool dark = false;
    for (int i = -2; i <= 2; i++)
        dark = dark || raster_at(picture, x_px, y_px + i) < 160;
    return dark;
}

/* The scale stands below the room at the left, the summary at the right, also where the room is high and narrow. */
static void the_scale_leaves_room_for_the_summary(void **state)
{
    const double px_per_mm = 5, margin_mm = 11, below_mm = 9, end_mm = 0.5, summary_mm = 66;
    static const double shapes[][2] = {{0.1, 2500}, {1.5, 40}, {1, 1}, {6, 4}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(shapes); i++) {
        hand_tape tape = small_room();
        tape.wanted.width_m = shapes[i][0];
        tape.wanted.height_m = shapes[i][1];
        raster picture = preview_of(&tape);
        double row_px = picture.height_px - below_mm * px_per_mm, x_px = (margin_mm + end_mm) * px_per_mm;
        assert_true(is_dark_near(&picture, x_px, row_px));
        while (x_px < picture.width_px && is_dark_near(&picture, x_px, row_px))
            x_px++;
        assert_true(x_px / px_per_mm < picture.width_px / px_per_mm - margin_mm - summary_mm);
        raster_release(&picture);
        hand_tape_release(&tape);
    }
}

/* Two thousand lines with a TM each. */
static void many_lines_are_drawn_in_time(void **state)
{
    enum { LINES = 2000, CMS = 3 };
    static int32_t ids[CMS * LINES];
    static hand_segment segments[LINES];
    (void)state;
    for (int32_t i = 0; i < CMS * LINES; i++)
        ids[i] = i % 2 == 0 ? i : -i;
    for (size_t i = 0; i < LINES; i++)
        segments[i] = (hand_segment){i, CMS, true};
    hand_tape tape = hand_tape_new(8, ids, segments, LINES);
    for (size_t i = 0; i < LINES; i++)
        tape.wanted.lines[i] = (plan_line){{2 + 2 * (double)(i % 48), 2 + 2 * (double)(i / 48)},
                                           {3 + 2 * (double)(i % 48), 2.5 + 2 * (double)(i / 48)}, PLAN_ON_FLOOR, 0};
    clock_t start = clock();
    raster picture = preview_of(&tape);
    /* Sanitizers take their share. */
    assert_true((double)(clock() - start) / CLOCKS_PER_SEC < 20);
    raster_release(&picture);
    hand_tape_release(&tape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tape_hangs_on_its_lines_and_faces_the_room),
        cmocka_unit_test(a_background_fills_the_room),
        cmocka_unit_test(an_unreadable_background_is_told),
        cmocka_unit_test(a_preview_that_cannot_be_written_is_told),
        cmocka_unit_test(rooms_of_every_shape_are_drawn),
        cmocka_unit_test(the_scale_leaves_room_for_the_summary),
        cmocka_unit_test(many_lines_are_drawn_in_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
