/* Maps in our own format: a good one, and what is wrong with others made of it, and where. */
#include "test_main.h"

#include "map_file.h"
#include "map_ids.h"

/* A TM on a wall, a CM on the floor, and two TMs that lack CMs: of one only centres are known. */
static const char good_map[] =
    "{\"format\":\"tapemark-map\",\"version\":1,\"units\":\"m\",\"plan\":{\"width_m\":4,\"height_m\":3},"
    "\"module_mm\":10,\"comment\":\"a test\",\"segments\":[\n"
    "{\"code\":\"100\",\"on\":\"wall\",\"above_floor_m\":0.03,\"start\":[0.5,0.1],\"end\":[1.48,0.1],"
    "\"direction_deg\":0,\"cms\":[\n"
    "{\"id\":1,\"start\":[0.58,0.1],\"end\":[0.9,0.1],\"direction_deg\":360},\n"
    "{\"id\":-2,\"start\":[0.83,0.1],\"end\":[1.15,0.1]},\n"
    "{\"id\":-3,\"start\":[1.08,0.1],\"end\":[1.4,0.1]}]},\n"
    "{\"on\":\"floor\",\"start\":[3,2],\"end\":[3,2.32],\"direction_deg\":90,\"cms\":[\n"
    "{\"id\":4,\"start\":[3,2],\"end\":[3,2.32],\"comment\":\"by the door\"}]},\n"
    "{\"code\":\"1110\",\"complete\":false,\"cms\":[{\"id\":5,\"centre\":[2,1]},{\"id\":-7,\"centre\":[2,1.5]}]},\n"
    "{\"code\":\"0110\",\"complete\":false,\"start\":[0.5,2.5],\"end\":[1.73,2.5],\"cms\":[\n"
    "{\"id\":9,\"start\":[0.83,2.5],\"end\":[1.15,2.5]},\n"
    "{\"id\":-11,\"start\":[1.33,2.5],\"end\":[1.65,2.5]}]}]}\n";

static bool read_map(const char *text, tape_map *map, error_text *error)
{
    const char *path = temporary_file(".json", text, strlen(text));
    error->text[0] = '\0';
    bool done = map_file_read(path, map_ids_check, map, error);
    unlink(path);
    return done;
}

static void expect_text_error(const char *text, const char *reason)
{
    tape_map map;
    error_text error;
    if (read_map(text, &map, &error))
        fail_msg("read without \"%s\"", reason);
    if (strstr(error.text, reason) == NULL || strchr(error.text, '\n') != NULL)
        fail_msg("\"%s\" instead of \"%s\"", error.text, reason);
    assert_null(map.cms);
    assert_null(map.segments);
}

/* The good map with its first `old` replaced. */
static const char *changed_map(const char *old, const char *new)
{
    static char text[sizeof good_map + 1000];
    const char *place = strstr(good_map, old);
    assert_non_null(place);
    assert_true(strlen(new) < 1000);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(place - good_map), good_map, new, place + strlen(old));
    return text;
}

static void expect_error(const char *old, const char *new, const char *reason)
{
    expect_text_error(changed_map(old, new), reason);
}

static void expect_good(const char *old, const char *new)
{
    tape_map map;
    error_text error;
    if (!read_map(changed_map(old, new), &map, &error))
        fail_msg("%s", error.text);
    tape_map_release(&map);
}

static void expect_points(map_point start, map_point end, double x0, double y0, double x1, double y1)
{
    assert_true(start.x_m == x0 && start.y_m == y0 && end.x_m == x1 && end.y_m == y1);
}

/* ---- A good map ---------------------------------------------------------------------------------------------- */

static void good_map_is_read_as_it_stands(void **state)
{
    static const int32_t ids[] = {1, -2, -3, 4, 5, -7, 9, -11};
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map(good_map, &map, &error));
    assert_true(map.width_m == 4 && map.height_m == 3 && map.module_mm == 10);
    assert_int_equal(map.cm_count, COUNT_OF(ids));
    for (size_t i = 0; i < COUNT_OF(ids); i++)
        assert_int_equal(map.cms[i].id, ids[i]);
    assert_int_equal(map.segment_count, 4);

    const map_segment *tm = &map.segments[0], *lone = &map.segments[1], *placeless = &map.segments[2];
    assert_string_equal(tm->code, "100");
    assert_true(tm->complete && tm->mount == MAP_ON_WALL && tm->above_floor_m == 0.03);
    expect_points(tm->start, tm->end, 0.5, 0.1, 1.48, 0.1);
    expect_points(map.cms[1].start, map.cms[1].end, 0.83, 0.1, 1.15, 0.1);
    assert_true(map.cms[3].centre.x_m == 3 && map.cms[3].centre.y_m == 2.16);
    assert_string_equal(lone->code, "");
    assert_true(lone->complete && lone->mount == MAP_ON_FLOOR && lone->first_cm == 3 && lone->cm_count == 1);
    assert_true(!placeless->complete && placeless->mount == MAP_MOUNT_UNKNOWN && placeless->cm_count == 2);
    expect_points(placeless->start, placeless->end, 2, 1.25, 2, 1.25);
    expect_points(map.cms[5].start, map.cms[5].end, 2, 1.5, 2, 1.5);
    tape_map_release(&map);
}

static void optional_keys_may_be_left_out(void **state)
{
    (void)state;
    expect_good("\"plan\":{\"width_m\":4,\"height_m\":3},", "");
    expect_good("\"module_mm\":10,", "");
    expect_good("\"comment\":\"a test\",", "");
    expect_good("\"on\":\"wall\",\"above_floor_m\":0.03,", "");
    expect_good("\"direction_deg\":0,", "");
    expect_good("\"id\":1,", "\"id\":3,");
    expect_good("\"id\":1,", "\"id\":2,"); /* -2 and 2 are two ids */
}

/* ---- Wrong values -------------------------------------------------------------------------------------------- */

static void head_is_checked(void **state)
{
    (void)state;
    expect_error("tapemark-map", "tapemark-plan", "is no map: \"format\" must be \"tapemark-map\"");
    expect_error("\"format\":\"tapemark-map\",", "", "\"format\" must be");
    expect_error("\"format\":\"tapemark-map\"", "\"format\":7", "\"format\" must be");
    expect_error("\"version\":1", "\"version\":2", "\"version\" must be 1");
    expect_error("\"version\":1", "\"version\":\"1\"", "\"version\" must be 1");
    expect_error("\"units\":\"m\"", "\"units\":\"mm\"", "\"units\" must be \"m\"");
    expect_error("\"units\":\"m\",", "", "\"units\" must be \"m\"");
    expect_error("\"module_mm\":10", "\"module_mm\":0", "\"module_mm\" must be a number from 0.001");
    expect_error("\"module_mm\":10", "\"module_mm\":\"10\"", "\"module_mm\" must be a number");
    expect_error("\"module_mm\":10", "\"modul_mm\":10", "the key \"modul_mm\" is unknown");
    expect_error("\"module_mm\":10", "\"version\":1", "the key \"version\" stands there twice");
    expect_error("{\"width_m\":4,\"height_m\":3}", "[4,3]", "plan: must be an object");
    expect_error("\"width_m\":4", "\"width_m\":-4", "plan: \"width_m\" and \"height_m\" must be above 0");
    expect_error("\"width_m\":4", "\"width_m\":1e999", "plan: \"width_m\" and");
    expect_error("\"height_m\":3", "\"width_m\":3", "plan: the key \"width_m\" stands there twice");
    expect_error(",\"height_m\":3", "", "plan: \"width_m\" and \"height_m\" must be");
    expect_text_error("{}", "\"format\" must be");
    expect_text_error("{\"format\":\"tapemark-map\",\"version\":1,\"units\":\"m\",\"segments\":[]}",
                      "\"segments\" must be an array of one segment or more");
    expect_text_error("{\"format\":\"tapemark-map\",\"version\":1,\"units\":\"m\",\"segments\":{\"a\":1}}",
                      "\"segments\" must be an array");
    expect_text_error("{\"format\":\"tapemark-map\",\"version\":1,\"units\":\"m\"}", "\"segments\" must be an array");
}

static void segments_are_checked(void **state)
{
    (void)state;
    expect_error("{\"code\":\"100\"", "7,{\"code\":\"100\"", "segments[0]: must be an object");
    expect_error("\"on\":\"wall\"", "\"onto\":\"wall\"", "segments[0]: the key \"onto\" is unknown");
    expect_error("\"on\":\"floor\"", "\"on\":\"ceiling\"", "segments[1]: \"on\" must be \"wall\" or \"floor\"");
    expect_error("\"on\":\"floor\"", "\"on\":0", "segments[1]: \"on\" must be");
    expect_error("\"on\":\"floor\"", "\"on\":\"floor\",\"above_floor_m\":1", "segments[1]: is on the floor, so");
    expect_error("\"above_floor_m\":0.03", "\"above_floor_m\":-1", "segments[0]: \"above_floor_m\" must be");
    expect_error("\"above_floor_m\":0.03", "\"above_floor_m\":1001", "segments[0]: \"above_floor_m\" must be");
    expect_error("\"above_floor_m\":0.03", "\"above_floor_m\":null", "segments[0]: \"above_floor_m\" must be");
    expect_error("\"code\":\"100\"", "\"code\":\"1O0\"", "segments[0]: \"code\" must be 3 to 64 characters");
    expect_error("\"code\":\"100\"", "\"code\":\"10\"", "segments[0]: \"code\" must be 3 to 64 characters");
    expect_error("\"code\":\"100\"", "\"code\":100", "segments[0]: \"code\" must be 3 to 64 characters");
    expect_error("\"code\":\"100\"", "\"code\":\"1000\"",
                 "segments[0]: \"cms\" has 3 code markers, but the code 1000 has 4");
    expect_error("\"code\":\"100\",", "",
                 "segments[0]: \"cms\" has 3 code markers, but a segment without \"code\" has 1");
    expect_error("\"complete\":false", "\"complete\":true", "segments[2]: \"cms\" has 2 code markers");
    expect_error("{\"id\":5,\"centre\":[2,1]},{\"id\":-7,\"centre\":[2,1.5]}", "",
                 "segments[2]: is not \"complete\", so \"cms\" needs 1 to 3 code markers, not 0");
    expect_error("\"code\":\"100\",", "\"code\":\"100\",\"complete\":false,",
                 "segments[0]: is not \"complete\", so \"cms\" needs 1 to 2 code markers, not 3");
    expect_error("\"code\":\"1110\",", "", "segments[2]: has no \"code\", so it cannot be incomplete");
    expect_error("\"complete\":false", "\"complete\":0", "segments[2]: \"complete\" must be true or false");
    expect_error("\"code\":\"1110\"", "\"code\":\"1111\"", "segments[2].cms[1]: the id -7 is dark");
    expect_error("\"direction_deg\":90", "\"direction_deg\":270",
                 "segments[1]: \"direction_deg\" is 270.00, but from \"start\" "
                 "to \"end\" it is 90.00");
    expect_error("\"direction_deg\":90", "\"direction_deg\":\"south\"",
                 "segments[1]: \"direction_deg\" must be a number");
    expect_error("\"direction_deg\":0", "\"direction_deg\":91", "segments[0]: \"direction_deg\" is 91.00");
    expect_error("\"end\":[3,2.32],\"direction_deg\"", "\"direction_deg\"",
                 "segments[1]: has \"start\", but no \"end\"");
    expect_error("\"start\":[3,2],\"end\":[3,2.32],\"dir", "\"dir",
                 "segments[1]: has \"direction_deg\", but no \"start\"");
    expect_error("\"start\":[3,2],\"end\":[3,2.32],\"dir", "\"end\":[3,2.32],\"dir",
                 "segments[1]: has \"end\", but no");
    expect_error("\"start\":[3,2],\"end\":[3,2.32]", "\"start\":[3,2.32],\"end\":[3,2]",
                 "segments[1]: \"direction_deg\" is 90.00, but from \"start\" to \"end\" it is 270.00");
    expect_error("\"start\":[3,2]", "\"start\":[3,2.32]", "segments[1]: \"start\" and \"end\" are the same place");
    expect_error("\"start\":[3,2]", "\"start\":[3]", "segments[1]: \"start\" must be a place on the plan in metres");
    expect_error("\"start\":[3,2]", "\"start\":[3,2,1]", "segments[1]: \"start\" must be a place");
    expect_error("\"start\":[3,2]", "\"start\":{\"x\":3,\"y\":2}", "segments[1]: \"start\" must be a place");
    expect_error("\"start\":[3,2]", "\"start\":[3,1e999]", "segments[1]: \"start\" must be a place");
    expect_error("\"start\":[3,2]", "\"start\":[1e999,2]", "segments[1]: \"start\" must be a place");
    expect_error("\"start\":[3,2]", "\"start\":[3,\"2\"]", "segments[1]: \"start\" must be a place");
    expect_error("\"start\":[3,2],\"end\":[3,2.32]", "\"start\":[3,3],\"end\":[3,3.32]",
                 "segments[1]: \"end\", [3.000, 3.320], lies outside of the plan, 4.000 m x 3.000 m");
    expect_error("\"cms\":[\n{\"id\":4", "\"cms\":{},\"comment\":[\n{\"id\":4",
                 "segments[1]: \"cms\" must be an array");
}

static void cms_are_checked(void **state)
{
    (void)state;
    expect_error("{\"id\":1,", "1,{\"id\":1,", "segments[0]: \"cms\" has 4 code markers");
    expect_error("{\"id\":5,\"centre\":[2,1]}", "5", "segments[2].cms[0]: must be an object");
    expect_error("\"id\":4", "\"id\":4,\"id\":4", "segments[1].cms[0]: the key \"id\" stands there twice");
    expect_error("\"id\":4", "\"id\":4,\"Id\":4", "segments[1].cms[0]: the key \"Id\" is unknown");
    expect_error("\"id\":4", "\"id\":1505583", "segments[1].cms[0]: \"id\" must be the id of a code marker");
    expect_error("\"id\":4", "\"id\":4.5", "segments[1].cms[0]: \"id\" must be");
    expect_error("\"id\":4", "\"id\":1e300", "segments[1].cms[0]: \"id\" must be");
    expect_error("\"id\":4", "\"id\":\"4\"", "segments[1].cms[0]: \"id\" must be");
    expect_error("\"id\":4,", "", "segments[1].cms[0]: \"id\" must be");
    expect_error("\"id\":-2", "\"id\":2", "segments[0].cms[1]: the id 2 is light, which does not fit the code 100");
    expect_error("\"id\":1,", "\"id\":-1,", "segments[0].cms[0]: the id -1 is dark");
    expect_error("{\"id\":-2,\"start\":[0.83,0.1],\"end\":[1.15,0.1]}", "{\"id\":-2}",
                 "segments[0].cms[1]: needs either \"start\" and \"end\" or \"centre\"");
    expect_error("{\"id\":-2,\"start\":[0.83,0.1],\"end\":[1.15,0.1]}", "{\"id\":-2,\"centre\":[0.99,0.1]}",
                 "segments[0].cms[1]: must have \"start\" and \"end\" if and only if its segment has them");
    expect_error("\"centre\":[2,1]", "\"centre\":[2,1],\"start\":[2,1],\"end\":[2,2]",
                 "segments[2].cms[0]: needs either");
    expect_error("\"centre\":[2,1]", "\"centre\":[2,-1]",
                 "segments[2].cms[0]: \"centre\", [2.000, -1.000], lies outside");
    expect_error("\"direction_deg\":360", "\"direction_deg\":180", "segments[0].cms[0]: \"direction_deg\" is 180.00");
    expect_error("\"id\":4", "\"id\":-11", "segments[1].cms[0] and segments[3].cms[1] both have the id -11");
}

/* ---- Places that contradict each other ----------------------------------------------------------------------- */

static void places_of_cms_are_compared_with_their_segment(void **state)
{
    (void)state;
    expect_error(
        "\"module_mm\":10", "\"module_mm\":10.1",
        "segments[0]: is 0.9800 m long from \"start\" to \"end\", but its code markers take 0.9898 m at 10.1 mm");
    expect_error("\"end\":[1.48,0.1]", "\"end\":[1.5,0.1]", "segments[0]: is 1.0000 m long");
    expect_error(
        "\"start\":[0.83,0.1]", "\"start\":[0.84,0.1]",
        "segments[0].cms[1]: \"start\", [0.8400, 0.1000], is 10.0 mm off: code marker 1 of this segment has it at "
        "[0.8300, 0.1000]");
    expect_error("\"end\":[1.15,0.1]", "\"end\":[1.15,0.11]",
                 "segments[0].cms[1]: \"end\", [1.1500, 0.1100], is 10.0 mm off");
    expect_good("\"start\":[0.83,0.1]", "\"start\":[0.8303,0.1]");
    /* Two CMs in each other's places; without a module size the segment tells it. */
    expect_error(
        "{\"id\":-2,\"start\":[0.83,0.1],\"end\":[1.15,0.1]},\n{\"id\":-3,\"start\":[1.08,0.1],\"end\":[1.4,0.1]}",
        "{\"id\":-3,\"start\":[1.08,0.1],\"end\":[1.4,0.1]},\n{\"id\":-2,\"start\":[0.83,0.1],\"end\":[1.15,0.1]}",
        "segments[0].cms[1]: \"start\", [1.0800, 0.1000], is 250.0 mm off");
    expect_text_error(
        "{\"format\":\"tapemark-map\",\"version\":1,\"units\":\"m\",\"segments\":[{\"start\":[0,0],\"end\":[0,1],"
        "\"cms\":[{\"id\":4,\"start\":[0,0.1],\"end\":[0,1]}]}]}",
        "segments[0].cms[0]: \"start\", [0.0000, 0.1000]");
}

static void cms_of_incomplete_tms_stand_in_slots(void **state)
{
    (void)state;
    /* Slot 3 of 0110 is dark, and so is slot 0; CMs read from left to right. */
    expect_error("\"id\":-11", "\"id\":11", "segments[3].cms[1]: the id 11 is light");
    expect_error("\"start\":[1.33,2.5],\"end\":[1.65,2.5]", "\"start\":[1.36,2.5],\"end\":[1.68,2.5]",
                 "segments[3].cms[1]: \"start\", [1.3600, 2.5000], is 30.0 mm off");
    expect_error("\"start\":[1.33,2.5],\"end\":[1.65,2.5]", "\"start\":[0.58,2.5],\"end\":[0.9,2.5]",
                 "segments[3].cms[1]: lies outside of its tape marker or out of order");
    expect_error("\"start\":[0.83,2.5],\"end\":[1.15,2.5]", "\"start\":[1.58,2.5],\"end\":[1.9,2.5]",
                 "segments[3].cms[0]: lies outside of its tape marker or out of order");
}

/* ---- Damage -------------------------------------------------------------------------------------------------- */

static void every_cut_of_a_map_is_an_error(void **state)
{
    char text[sizeof good_map];
    (void)state;
    for (size_t size = 0; size < sizeof good_map - 2; size++) {
        memcpy(text, good_map, size);
        text[size] = '\0';
        expect_text_error(text, "is not valid JSON");
    }
}

static void trailing_text_is_an_error(void **state)
{
    (void)state;
    expect_error("2.5]}]}]}\n", "2.5]}]}]}\n{}", "is not valid JSON: error near line");
    expect_error("\"module_mm\":10", "\"module_mm\":NaN", "is not valid JSON: error near line 1");
}

/* Whatever byte stands in its place, the map is read or refused with one line. */
static void no_damaged_byte_does_harm(void **state)
{
    static const char bytes[] = "\"\\{}[],:0-9eE.tfn \n\x01\xff";
    static char text[sizeof good_map];
    tape_map map;
    error_text error;
    (void)state;
    memcpy(text, good_map, sizeof good_map);
    for (size_t i = 0; i < sizeof good_map - 1; i++) {
        text[i] = bytes[i * 7 % (sizeof bytes - 1)];
        if (read_map(text, &map, &error))
            tape_map_release(&map);
        else
            assert_true(error.text[0] != '\0' && strchr(error.text, '\n') == NULL);
        text[i] = good_map[i];
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_map_is_read_as_it_stands),
        cmocka_unit_test(optional_keys_may_be_left_out),
        cmocka_unit_test(head_is_checked),
        cmocka_unit_test(segments_are_checked),
        cmocka_unit_test(cms_are_checked),
        cmocka_unit_test(places_of_cms_are_compared_with_their_segment),
        cmocka_unit_test(cms_of_incomplete_tms_stand_in_slots),
        cmocka_unit_test(every_cut_of_a_map_is_an_error),
        cmocka_unit_test(trailing_text_is_an_error),
        cmocka_unit_test(no_damaged_byte_does_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
