/* Maps: good ones, and what is wrong with bad ones and where. */
#include "test_main.h"

#include "map_file.h"
#include "places.h"

/* ---- Reading ------------------------------------------------------------------------------------------------- */

static bool read_map(const char *text, places *loaded, error_text *error)
{
    const char *path = temporary_file(".json", text, strlen(text));
    error->text[0] = '\0';
    bool done = places_load(path, loaded, error);
    unlink(path);
    return done;
}

static void expect_error(const char *text, const char *reason)
{
    places loaded;
    error_text error;
    assert_false(read_map(text, &loaded, &error));
    assert_non_null(strstr(error.text, reason));
    assert_null(loaded.map.cms);
    assert_null(loaded.map.segments);
}

#define ZEROS_7 "0000000"
#define ZEROS_77 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7 ZEROS_7
#define ALONE(id, x, y) "{\"idcm_decimal\":" #id ",\"x\":" #x ",\"y\":" #y ",\"idtm\":\" \",\"n_tm\":\" \"}"
#define OF_TM(id, x, y, code, tm) \
    "{\"idcm_decimal\":" #id ",\"x\":" #x ",\"y\":" #y ",\"idtm\":\"" #code "\",\"n_tm\":\"" #tm "\"}"

/* Two TMs that read alike seen upside down, one that does not, one that is not wholly on the map, single CMs. */
static const char good_map[] =
    "[" ALONE(40, 9.5, -1) "," OF_TM(1, 1, 2, 100, a) "," OF_TM(-2, 2, 2, 100, a) "," OF_TM(-3, 3, 2, 100, a) ","
    OF_TM(-4, 1, 5, 001, b) "," OF_TM(-5, 2, 5, 001, b) "," OF_TM(6, 3, 5, 001, b) ","
    OF_TM(7, 4, 8, 1000, c) "," OF_TM(-8, 4, 9, 1000, c) "," OF_TM(-9, 4, 10, 1000, c) ","
    OF_TM(-10, 4, 11, 1000, c) "," OF_TM(11, 0, 0, 11110, d) "," ALONE(-40, 0, 0.25) "]\n";

static void good_map_is_sorted_by_ids(void **state)
{
    static const int32_t ids[] = {-40, -10, -9, -8, -5, -4, -3, -2, 1, 6, 7, 11, 40};
    places loaded;
    error_text error;
    tapemark_config config = {0};
    (void)state;
    assert_true(read_map(good_map, &loaded, &error));
    places_configure(&loaded, &config);
    assert_int_equal(config.known_id_count, COUNT_OF(ids));
    assert_memory_equal(config.known_ids, ids, sizeof ids);
    assert_int_equal(loaded.map.segment_count, 6);

    map_point point;
    assert_true(places_find_cm(&loaded, 40, &point));
    assert_true(point.x_m == 9.5 && point.y_m == -1);
    assert_true(places_find_cm(&loaded, -40, &point));
    assert_true(point.x_m == 0 && point.y_m == 0.25);
    assert_false(places_find_cm(&loaded, 2, &point));
    assert_false(places_find_cm(&loaded, 41, &point));
    assert_false(places_find_cm(NULL, 40, &point));
    places_release(&loaded);
}

static void words_and_checksums_are_compared(void **state)
{
    places loaded;
    error_text error;
    (void)state;
    assert_true(read_map("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"" ZEROS_77 "0\","
                         "\"checksum\":\"01000110\"}]", &loaded, &error));
    places_release(&loaded);
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"" ZEROS_77 "1\"}]",
                 "entry 1 (id 0): \"idcm\" or \"checksum\"");
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"checksum\":\"01000111\"}]", "belongs to another id");
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"000\"}]", "belongs to another id");
}

static void malformed_maps_name_the_place(void **state)
{
    (void)state;
    expect_error("", "ends too early at line 1, column 1");
    expect_error("[\n  {\"idcm_decimal\": 3,\n   \"x\": 1,,\n", "error near line 3, column 1");
    expect_error("[" ALONE(1, 0, 0), "ends too early at line 1");
    expect_error("[" ALONE(1, 0, 0) "] ]", "not valid JSON");
    expect_error("{}", "expected an array");
    expect_error("[]", "without code markers");
    expect_error("[3]", "entry 1: must be an object");
    expect_error("[" ALONE(1, 0, 0) ",{\"x\":1,\"y\":2}]", "entry 2: \"idcm_decimal\"");
    expect_error("[" ALONE(1.5, 0, 0) "]", "entry 1: \"idcm_decimal\"");
    expect_error("[" ALONE(1505583, 0, 0) "]", "entry 1: \"idcm_decimal\"");
    expect_error("[" ALONE(1e300, 0, 0) "]", "entry 1: \"idcm_decimal\"");
    expect_error("[" ALONE("1", 0, 0) "]", "entry 1: \"idcm_decimal\"");
    expect_error("[" ALONE(1, 0, 0) "," ALONE(-1505582, null, 0) "]", "entry 2 (id -1505582): \"x\" and \"y\"");
    expect_error("[" ALONE(1, 0, 1e999) "]", "entry 1 (id 1): \"x\" and \"y\"");
    expect_error("[" ALONE(1, 0, -2000000) "]", "entry 1 (id 1): \"x\" and \"y\"");
    expect_error("[" OF_TM(1, 0, 0, 12, a) "]", "entry 1 (id 1): \"idtm\" must be a code");
    expect_error("[" OF_TM(1, 0, 0, 100, ) "]", "entry 1 (id 1): \"idtm\" must be a code");
    expect_error("[" OF_TM(1, 0, 0, , 1) "]", "entry 1 (id 1): \"idtm\" must be a code");
}

static void every_cut_of_a_map_is_an_error(void **state)
{
    char text[sizeof good_map];
    (void)state;
    for (size_t size = 0; size < sizeof good_map - 2; size++) {
        memcpy(text, good_map, size);
        text[size] = '\0';
        expect_error(text, "is not valid JSON");
    }
}

static void contradictions_name_the_entries(void **state)
{
    (void)state;
    expect_error("[" ALONE(1, 0, 0) "," ALONE(2, 0, 0) "," ALONE(1, 5, 0) "]", "entries 1 and 3 both have the id 1");
    expect_error("[" OF_TM(1, 0, 0, 100, a) "," OF_TM(-2, 0, 0, 110, a) "]", "tape marker a has the code 1");
    expect_error("[" OF_TM(1, 0, 0, 100, a) "," OF_TM(2, 0, 0, 100, a) "]", "2 light and 0 dark");
    expect_error("[" OF_TM(1, 0, 0, 100, a) "," OF_TM(-2, 0, 0, 100, a) "," OF_TM(-3, 0, 0, 100, a) ","
                 OF_TM(-4, 0, 0, 100, a) "]", "1 light and 3 dark");
}

static void files_that_are_no_maps(void **state)
{
    places loaded;
    error_text error;
    (void)state;
    assert_false(places_load("/nonexistent/map.json", &loaded, &error));
    assert_non_null(strstr(error.text, "No such file"));
    assert_false(places_load("/", &loaded, &error));
    assert_non_null(strstr(error.text, "is a directory"));
}

static void numbers_of_tms_may_be_numbers(void **state)
{
    places loaded;
    error_text error;
    (void)state;
    assert_true(read_map("[{\"idcm_decimal\":1,\"x\":0,\"y\":0,\"idtm\":\"111\",\"n_tm\":7},"
                         "{\"idcm_decimal\":2,\"x\":0,\"y\":0,\"idtm\":\"111\",\"n_tm\":8}]", &loaded, &error));
    assert_int_equal(loaded.map.segment_count, 2);
    places_release(&loaded);
}

/* ---- Where a TM is ------------------------------------------------------------------------------------------- */

/* Looks up a TM in which CMs with these ids were read. */
static bool find_tm(const char *code, bool directed, const int32_t *ids, size_t id_count, map_point *point)
{
    places loaded;
    error_text error;
    tapemark_cm cms[8] = {{.id = -40, .tm = -1}};
    tapemark_tm tms[2] = {{.code = "111", .length = 3}, {.length = (uint8_t)strlen(code), .directed = directed}};
    tapemark_result result = {.cms = cms, .cm_count = id_count + 1, .tms = tms, .tm_count = 2};
    memcpy(tms[1].code, code, strlen(code) + 1);
    for (size_t i = 0; i < id_count; i++)
        cms[i + 1] = (tapemark_cm){.id = ids[i], .tm = 1, .slot = (int16_t)i};
    assert_true(read_map(good_map, &loaded, &error));
    bool found = places_find_tm(&loaded, &result, 1, point);
    places_release(&loaded);
    return found;
}

static void tm_is_found_by_its_code(void **state)
{
    map_point point;
    (void)state;
    assert_true(find_tm("100", true, NULL, 0, &point));
    assert_true(point.x_m == 2 && point.y_m == 2);
    assert_true(find_tm("001", true, NULL, 0, &point));
    assert_true(point.x_m == 2 && point.y_m == 5);
    /* Undirected, it may be either of the two. */
    assert_false(find_tm("100", false, NULL, 0, &point));
    assert_true(find_tm("1000", false, NULL, 0, &point));
    assert_true(point.x_m == 4 && point.y_m == 9.5);
    assert_true(find_tm("0001", false, NULL, 0, &point));
    assert_true(point.x_m == 4 && point.y_m == 9.5);
    assert_false(find_tm("0001", true, NULL, 0, &point));
    assert_false(find_tm("111", true, NULL, 0, &point));
}

static void tm_is_found_by_its_cms(void **state)
{
    static const int32_t of_a[] = {-2, -3}, of_two[] = {-2, -4}, alone[] = {40}, unknown_and_b[] = {12, 6};
    map_point point;
    (void)state;
    assert_true(find_tm("100", false, of_a, 2, &point));
    assert_true(point.x_m == 2 && point.y_m == 2);
    assert_true(find_tm("11111", true, unknown_and_b, 2, &point));
    assert_true(point.x_m == 2 && point.y_m == 5);
    /* CMs that belong to two TMs, or to none, speak against the code too. */
    assert_false(find_tm("1000", true, of_two, 2, &point));
    assert_false(find_tm("1000", true, alone, 1, &point));
}

static void tm_that_is_not_wholly_on_the_map_has_no_middle(void **state)
{
    static const int32_t ids[] = {11};
    map_point point;
    (void)state;
    assert_false(find_tm("11110", true, NULL, 0, &point));
    assert_false(find_tm("11110", true, ids, 1, &point));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_map_is_sorted_by_ids),
        cmocka_unit_test(words_and_checksums_are_compared),
        cmocka_unit_test(malformed_maps_name_the_place),
        cmocka_unit_test(every_cut_of_a_map_is_an_error),
        cmocka_unit_test(contradictions_name_the_entries),
        cmocka_unit_test(files_that_are_no_maps),
        cmocka_unit_test(numbers_of_tms_may_be_numbers),
        cmocka_unit_test(tm_is_found_by_its_code),
        cmocka_unit_test(tm_is_found_by_its_cms),
        cmocka_unit_test(tm_that_is_not_wholly_on_the_map_has_no_middle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
