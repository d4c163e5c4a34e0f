/* Maps of the marker's inventors: good ones, and what is wrong with bad ones and where. */
#include "test_main.h"

#include "map_file.h"
#include "map_ids.h"

/* ---- Reading ------------------------------------------------------------------------------------------------- */

static bool read_map(const char *text, tape_map *map, error_text *error)
{
    const char *path = temporary_file(".json", text, strlen(text));
    error->text[0] = '\0';
    bool done = map_file_read(path, map_ids_check, map, error);
    unlink(path);
    return done;
}

static void expect_error(const char *text, const char *reason)
{
    tape_map map;
    error_text error;
    assert_false(read_map(text, &map, &error));
    if (strstr(error.text, reason) == NULL)
        fail_msg("\"%s\" instead of \"%s\"", error.text, reason);
    assert_null(map.cms);
    assert_null(map.segments);
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

static void expect_segment(const tape_map *map, size_t index, const char *code, bool complete, double x_m, double y_m)
{
    const map_segment *segment = &map->segments[index];
    assert_string_equal(segment->code, code);
    assert_int_equal(segment->complete, complete);
    assert_true(segment->start.x_m == x_m && segment->start.y_m == y_m);
    assert_true(segment->end.x_m == x_m && segment->end.y_m == y_m);
    assert_int_equal(segment->mount, MAP_MOUNT_UNKNOWN);
}

static void segments_come_in_the_order_of_the_file(void **state)
{
    static const int32_t ids[] = {40, 1, -2, -3, -4, -5, 6, 7, -8, -9, -10, 11, -40};
    static const size_t first[] = {0, 1, 4, 7, 11, 12};
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map(good_map, &map, &error));
    assert_int_equal(map.cm_count, COUNT_OF(ids));
    for (size_t i = 0; i < COUNT_OF(ids); i++)
        assert_int_equal(map.cms[i].id, ids[i]);
    assert_int_equal(map.segment_count, COUNT_OF(first));
    for (size_t i = 0; i < COUNT_OF(first); i++)
        assert_int_equal(map.segments[i].first_cm, first[i]);
    expect_segment(&map, 0, "", true, 9.5, -1);
    expect_segment(&map, 1, "100", true, 2, 2);
    expect_segment(&map, 3, "1000", true, 4, 9.5);
    expect_segment(&map, 4, "11110", false, 0, 0);
    expect_segment(&map, 5, "", true, 0, 0.25);
    assert_true(map.width_m == 0 && map.module_mm == 0);
    assert_true(map.cms[12].centre.y_m == 0.25 && map.cms[12].start.y_m == 0.25 && map.cms[12].end.y_m == 0.25);
    tape_map_release(&map);
    assert_null(map.cms);
}

/* Entries in disorder are put in the order of the ids when that is what the code says. */
static void cms_of_a_tm_follow_its_code(void **state)
{
    static const int32_t ids[] = {-4, 5, -6};
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map("[" OF_TM(-6, 3, 0, 010, a) "," OF_TM(-4, 1, 0, 010, a) "," ALONE(7, 0, 0) ","
                         OF_TM(5, 2, 0, 010, a) "]", &map, &error));
    for (size_t i = 0; i < COUNT_OF(ids); i++)
        assert_int_equal(map.cms[i].id, ids[i]);
    assert_int_equal(map.segments[0].cm_count, 3);
    tape_map_release(&map);
}

static void size_of_the_plan(void **state)
{
#define SIZED(id, size) "{\"idcm_decimal\":" #id ",\"x\":1,\"y\":2" size "}"
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map("[" SIZED(1, ",\"largura\":3.5,\"altura\":2") "]", &map, &error));
    assert_true(map.width_m == 3.5 && map.height_m == 2);
    tape_map_release(&map);
    expect_error("[" SIZED(1, ",\"largura\":0.9,\"altura\":2") "]", "entry 1 (id 1): (1.000, 2.000) lies outside");
    expect_error("[" SIZED(1, ",\"largura\":3.5") "]", "entry 1: \"largura\" and \"altura\" must be metres");
    expect_error("[" SIZED(1, ",\"largura\":0,\"altura\":2") "]", "must be metres above 0");
    expect_error("[" SIZED(1, ",\"largura\":3,\"altura\":4") "," SIZED(2, ",\"largura\":3,\"altura\":5") "]",
                 "entry 2: \"largura\" or \"altura\" differs");
    expect_error("[" SIZED(1, "") "," SIZED(2, ",\"largura\":3,\"altura\":5") "]", "differs from that of entry 1");
}

static void words_and_checksums_are_compared(void **state)
{
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"" ZEROS_77 "0\","
                         "\"checksum\":\"01000110\"}]", &map, &error));
    tape_map_release(&map);
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"" ZEROS_77 "1\"}]",
                 "entry 1 (id 0): \"idcm\" or \"checksum\"");
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"checksum\":\"01000111\"}]", "belongs to another id");
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":\"000\"}]", "belongs to another id");
    expect_error("[{\"idcm_decimal\":0,\"x\":0,\"y\":0,\"idcm\":0}]", "belongs to another id");
}

static void malformed_maps_name_the_place(void **state)
{
    (void)state;
    expect_error("", "ends too early at line 1, column 1");
    expect_error("[\n  {\"idcm_decimal\": 3,\n   \"x\": 1,,\n", "error near line 3, column 1");
    expect_error("[" ALONE(1, 0, 0), "ends too early at line 1");
    expect_error("[" ALONE(1, 0, 0) "] ]", "not valid JSON");
    expect_error("3", "is no map: expected an object");
    expect_error("null", "is no map: expected an object");
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
    expect_error("[" OF_TM(1, 0, 0, 10, a) "]", "entry 1 (id 1): \"idtm\" must be a code of 3 to 64 0 and 1");
    expect_error("[" OF_TM(1, 0, 0, 100, ) "]", "entry 1 (id 1): \"idtm\" must be a code");
    expect_error("[" OF_TM(1, 0, 0, , 1) "]", "entry 1 (id 1): \"idtm\" must be a code");
    expect_error("[{\"idcm_decimal\":1,\"x\":0,\"y\":0,\"idtm\":100}]", "entry 1 (id 1): \"idtm\" must be a code");
    expect_error("[{\"idcm_decimal\":1,\"x\":0,\"x\":5,\"y\":0}]", "entry 1: the key \"x\" stands there twice");
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
    expect_error("[" OF_TM(-1, 0, 0, 100, a) "," OF_TM(2, 0, 0, 100, a) "," OF_TM(-3, 0, 0, 100, a) "]",
                 "which the signs of its ids follow neither");
    expect_error("[" OF_TM(-1, 0, 0, 100, a) "," OF_TM(2, 0, 0, 100, a) "]", "follow neither");
}

/* What a parser would lose or choke on. */
static void texts_that_are_no_json(void **state)
{
    static const char zero[] = "[{\"idcm_decimal\":1,\n\"x\":0,\"y\":0}]\0 ";
    static char deep[70], *many;
    tape_map map;
    error_text error;
    (void)state;
    assert_false(map_file_read(temporary_file(".json", zero, sizeof zero - 1), map_ids_check, &map, &error));
    assert_non_null(strstr(error.text, "line 2, column 14: a zero byte"));
    expect_error("[{\"idcm_decimal\":1,\"x\\u0000\":0}]", "line 1, column 22: \\u0000 is not allowed");
    /* Punctuation in texts does not count, nor does a quotation mark behind a backslash end them. */
    static const char quoted[] = "[{\"idcm_decimal\":1,\"x\":0,\"y\":0,\"a\":\"\\\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["
                                 "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\"}]";
    assert_true(read_map(quoted, &map, &error));
    tape_map_release(&map);
    memset(deep, '[', sizeof deep - 1);
    expect_error(deep, "line 1, column 65: nested too deeply");
    size_t size = 2 * 8000001;
    many = malloc(size + 1);
    for (size_t i = 0; i < size; i++)
        many[i] = i % 2 == 0 ? '0' : ',';
    many[0] = '[';
    many[size] = '\0';
    expect_error(many, "more than 8000000 values");
    memset(many, '0', size);
    expect_error(many, "is no map");
    free(many);
    unlink(temporary_file(".json", "", 0));
}

static void files_that_are_no_maps(void **state)
{
    tape_map map;
    error_text error;
    (void)state;
    assert_false(map_file_read("/nonexistent/map.json", map_ids_check, &map, &error));
    assert_non_null(strstr(error.text, "No such file"));
    assert_false(map_file_read("/", map_ids_check, &map, &error));
    assert_non_null(strstr(error.text, "is a directory"));
}

static void numbers_of_tms_may_be_numbers(void **state)
{
    tape_map map;
    error_text error;
    (void)state;
    assert_true(read_map("[{\"idcm_decimal\":1,\"x\":0,\"y\":0,\"idtm\":\"111\",\"n_tm\":7},"
                         "{\"idcm_decimal\":2,\"x\":0,\"y\":0,\"idtm\":\"111\",\"n_tm\":8}]", &map, &error));
    assert_int_equal(map.segment_count, 2);
    tape_map_release(&map);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(segments_come_in_the_order_of_the_file),
        cmocka_unit_test(cms_of_a_tm_follow_its_code),
        cmocka_unit_test(size_of_the_plan),
        cmocka_unit_test(words_and_checksums_are_compared),
        cmocka_unit_test(malformed_maps_name_the_place),
        cmocka_unit_test(every_cut_of_a_map_is_an_error),
        cmocka_unit_test(contradictions_name_the_entries),
        cmocka_unit_test(texts_that_are_no_json),
        cmocka_unit_test(files_that_are_no_maps),
        cmocka_unit_test(numbers_of_tms_may_be_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
