/* Maps that are written and read again, in both formats. */
#include "test_main.h"

#include "map_file.h"
#include "map_ids.h"
#include "planned_map.h"

#include <sys/stat.h>

static const char *output_path(void)
{
    const char *path = temporary_file(".map", "", 0);
    unlink(path);
    return path;
}

static bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

static void expect_near(map_point found, map_point wanted)
{
    assert_true(fabs(found.x_m - wanted.x_m) <= 1e-6 && fabs(found.y_m - wanted.y_m) <= 1e-6);
}

static void expect_same_cms(const tape_map *found, const tape_map *wanted, bool ends)
{
    assert_int_equal(found->cm_count, wanted->cm_count);
    for (size_t i = 0; i < wanted->cm_count; i++) {
        assert_int_equal(found->cms[i].id, wanted->cms[i].id);
        expect_near(found->cms[i].centre, wanted->cms[i].centre);
        if (ends) {
            expect_near(found->cms[i].start, wanted->cms[i].start);
            expect_near(found->cms[i].end, wanted->cms[i].end);
        }
    }
}

static void expect_same_segments(const tape_map *found, const tape_map *wanted)
{
    assert_int_equal(found->segment_count, wanted->segment_count);
    for (size_t i = 0; i < wanted->segment_count; i++) {
        const map_segment *a = &found->segments[i], *b = &wanted->segments[i];
        assert_string_equal(a->code, b->code);
        assert_int_equal(a->first_cm, b->first_cm);
        assert_int_equal(a->cm_count, b->cm_count);
        assert_int_equal(a->complete, b->complete);
    }
}

static void read_again(const char *path, tape_map *map)
{
    error_text error;
    if (!map_file_read(path, map_ids_check, map, &error))
        fail_msg("%s", error.text);
    unlink(path);
}

static void own_format_keeps_everything(void **state)
{
    const char *path = output_path();
    tape_map map, found;
    error_text error;
    (void)state;
    assert_true(make_planned_map(3000, &map));
    assert_true(map_file_write(path, &map, &error));
    read_again(path, &found);
    expect_same_cms(&found, &map, true);
    expect_same_segments(&found, &map);
    for (size_t i = 0; i < map.segment_count; i++) {
        expect_near(found.segments[i].start, map.segments[i].start);
        expect_near(found.segments[i].end, map.segments[i].end);
        assert_int_equal(found.segments[i].mount, map.segments[i].mount);
        assert_true(found.segments[i].above_floor_m == map.segments[i].above_floor_m);
    }
    assert_true(found.width_m == 1710 && found.height_m == 1000 && fabs(found.module_mm - map.module_mm) <= 1e-6);
    tape_map_release(&found);
    tape_map_release(&map);
}

static void paper_format_keeps_ids_codes_and_centres(void **state)
{
    const char *path = output_path();
    tape_map map, found;
    error_text error;
    (void)state;
    assert_true(make_planned_map(500, &map));
    assert_true(map_file_write_paper(path, &map, map_ids_bits, &error));
    read_again(path, &found);
    expect_same_cms(&found, &map, false);
    expect_same_segments(&found, &map);
    assert_true(found.width_m == 1710 && found.height_m == 1000 && found.module_mm == 0);
    tape_map_release(&found);
    tape_map_release(&map);
}

/* What the inventors' format does not tell, ours leaves out. */
static void unknown_places_stay_unknown(void **state)
{
    map_cm cms[] = {
        {7, {1, 2}, {1, 2}, {1, 2}}, {-3, {3.25, -0.0000004}, {0, 0}, {0, 0}}, {4, {-2, 5}, {0, 0}, {0, 0}}};
    map_segment segments[] = {{.first_cm = 0, .cm_count = 1, .complete = true, .start = {1, 2}, .end = {1, 2}},
                              {.code = "0111", .first_cm = 1, .cm_count = 2}};
    const tape_map map = {.cms = cms, .cm_count = 3, .segments = segments, .segment_count = 2};
    const char *path = output_path();
    tape_map found;
    error_text error;
    (void)state;
    assert_true(map_file_write(path, &map, &error));
    read_again(path, &found);
    expect_same_cms(&found, &map, false);
    expect_same_segments(&found, &map);
    assert_true(found.width_m == 0 && found.module_mm == 0 && found.segments[0].mount == MAP_MOUNT_UNKNOWN);
    expect_near(found.segments[1].start, (map_point){0.625, 2.5});
    tape_map_release(&found);
}

static void numbers_are_as_short_as_they_can_be(void **state)
{
    static const char expected[] =
        "{\n  \"format\": \"tapemark-map\",\n  \"version\": 1,\n  \"units\": \"m\",\n"
        "  \"plan\": {\"width_m\": 3.7, \"height_m\": 6.2},\n  \"module_mm\": 8.571429,\n  \"segments\": [\n"
        "    {\"on\": \"wall\", \"above_floor_m\": 0.03, \"start\": [-0.5, 0.000001], \"end\": [-0.5, -0.274285], "
        "\"direction_deg\": 270, \"cms\": [\n"
        "      {\"id\": -9, \"start\": [-0.5, 0.000001], \"end\": [-0.5, -0.274285], \"direction_deg\": 270}]}\n  "
        "]\n}\n";
    map_point start = {-0.5, 0.0000006}, end = {-0.5, -0.2742851};
    map_cm cm = {-9, {-0.5, -0.137}, start, end};
    map_segment segment = {
        .cm_count = 1, .complete = true, .start = start, .end = end, .mount = MAP_ON_WALL, .above_floor_m = 0.03};
    const tape_map map = {3.7, 6.2, 60.0 / 7, &cm, 1, &segment, 1};
    const char *path = output_path();
    char text[1000] = "";
    error_text error;
    (void)state;
    assert_true(map_file_write(path, &map, &error));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    unlink(path);
    assert_string_equal(text, expected);
}

/* ---- Failures ------------------------------------------------------------------------------------------------ */

static void maps_that_cannot_be_written_leave_nothing(void **state)
{
    const char *path = output_path();
    tape_map map;
    error_text error;
    (void)state;
    assert_true(make_planned_map(20, &map));
    assert_false(map_file_write("/dev/full", &map, &error));
    assert_non_null(strstr(error.text, "No space left on device"));
    assert_false(map_file_write_paper("/dev/full", &map, map_ids_bits, &error));
    assert_non_null(strstr(error.text, "No space left on device"));
    assert_false(map_file_write("/nonexistent/map.json", &map, &error));
    assert_non_null(strstr(error.text, "No such file"));

    static const double no_places[] = {NAN, INFINITY, 1e7};
    for (size_t i = 0; i < COUNT_OF(no_places); i++) {
        map.cms[7].centre.y_m = no_places[i];
        assert_false(map_file_write(path, &map, &error));
        assert_non_null(strstr(error.text, "places that are no places"));
        assert_false(map_file_write_paper(path, &map, map_ids_bits, &error));
    }
    map.cms[7].centre.y_m = 0;
    map.segments[1].above_floor_m = NAN;
    assert_false(map_file_write(path, &map, &error));
    map.segments[1].above_floor_m = 0;
    map.segments[1].cm_count = 1000;
    assert_false(map_file_write(path, &map, &error));
    map.segment_count = 0;
    assert_false(map_file_write(path, &map, &error));
    assert_non_null(strstr(error.text, "the map is empty"));
    assert_false(exists(path));
    tape_map_release(&map);
}

static void a_failure_keeps_what_was_there(void **state)
{
    const char *path = temporary_file(".map", "old", 3);
    map_segment segment = {0};
    const tape_map empty = {.segments = &segment, .segment_count = 1};
    error_text error;
    struct stat status;
    (void)state;
    assert_false(map_file_write(path, &empty, &error));
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_size, 3);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(own_format_keeps_everything),
        cmocka_unit_test(paper_format_keeps_ids_codes_and_centres),
        cmocka_unit_test(unknown_places_stay_unknown),
        cmocka_unit_test(numbers_are_as_short_as_they_can_be),
        cmocka_unit_test(maps_that_cannot_be_written_leave_nothing),
        cmocka_unit_test(a_failure_keeps_what_was_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
