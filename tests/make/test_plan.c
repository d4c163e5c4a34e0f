/* Plans: good ones, what is wrong with bad ones and where, and that the schema says the same as the reader. */
#include "make_test.h"

#include <cjson/cJSON.h>

#include "json_file.h"

static bool read_plan(const char *text, plan *wanted, error_text *error)
{
    const char *path = temporary_plan(text);
    error->text[0] = '\0';
    bool done = plan_read(path, wanted, error);
    unlink(path);
    return done;
}

static void expect_error(const char *text, const char *reason)
{
    plan wanted;
    error_text error;
    if (read_plan(text, &wanted, &error))
        fail_msg("read without an error: %s", text);
    if (strstr(error.text, reason) == NULL)
        fail_msg("'%s' instead of '%s': %s", error.text, reason, text);
    if (strchr(error.text, '\n') != NULL)
        fail_msg("more than one line: %s", error.text);
    assert_null(wanted.lines);
    assert_null(wanted.background_path);
}

#define LINES "\"lines\":[{\"from_m\":[0,0],\"to_m\":[3,0]}]"
#define TOP(members) "{\"room_m\":[4,3],\"module_mm\":8.5," members "}"
#define LINE(members) TOP("\"lines\":[{\"from_m\":[0,0],\"to_m\":[3,0]},{" members "}]")

static void whole_plans_are_read(void **state)
{
    plan wanted;
    error_text error;
    (void)state;
    assert_true(read_plan("{\"$schema\":\"plan.schema.json\",\"room_m\":[3.7,6.2],\"tape_height_mm\":60,"
                          "\"first_id\":100,\"tm_cms\":5,\"tm_cms_max\":7,\"camera_upright\":true,"
                          "\"background\":\"floor.png\",\"on\":\"floor\",\"lines\":["
                          "{\"from_m\":[0.12,0.11],\"to_m\":[3.6,0.11],\"on\":\"wall\",\"above_floor_m\":0.4},"
                          "{\"from_m\":[3.7,6.2],\"to_m\":[0,0]}]}", &wanted, &error));
    assert_true(wanted.width_m == 3.7 && wanted.height_m == 6.2 && wanted.module_mm == 60.0 / 7);
    assert_int_equal(wanted.first_id, 100);
    assert_int_equal(wanted.tm_cms, 5);
    assert_int_equal(wanted.tm_cms_max, 7);
    assert_true(wanted.tm_required && wanted.camera_upright);
    const char *folder = getenv("TMPDIR");
    size_t folder_length = strlen(folder != NULL ? folder : "/tmp");
    assert_string_equal(wanted.background_path + folder_length, "/floor.png");
    assert_int_equal(wanted.line_count, 2);
    assert_true(wanted.lines[0].from.x_m == 0.12 && wanted.lines[0].to.y_m == 0.11);
    assert_true(wanted.lines[0].mount == PLAN_ON_WALL && wanted.lines[0].above_floor_m == 0.4);
    assert_true(wanted.lines[1].mount == PLAN_ON_FLOOR && wanted.lines[1].above_floor_m == 0);
    plan_release(&wanted);
}

static void what_is_left_out_has_defaults(void **state)
{
    plan wanted;
    error_text error;
    (void)state;
    assert_true(read_plan(TOP("\"above_floor_m\":0.03,\"background\":\"/plans/floor.png\"," LINES), &wanted, &error));
    assert_int_equal(wanted.first_id, 0);
    assert_int_equal(wanted.tm_cms, 6);
    assert_int_equal(wanted.tm_cms_max, 32);
    assert_false(wanted.tm_required || wanted.camera_upright);
    assert_string_equal(wanted.background_path, "/plans/floor.png");
    assert_true(wanted.lines[0].mount == PLAN_ON_WALL && wanted.lines[0].above_floor_m == 0.03);
    plan_release(&wanted);
}

static void height_and_module_must_agree(void **state)
{
    plan wanted;
    error_text error;
    (void)state;
    assert_true(read_plan("{\"room_m\":[4,3],\"tape_height_mm\":60,\"module_mm\":8.571," LINES "}", &wanted, &error));
    assert_true(wanted.module_mm == 8.571);
    plan_release(&wanted);
    expect_error("{\"room_m\":[4,3],\"tape_height_mm\":60,\"module_mm\":8.6," LINES "}",
                 "tape_height_mm: 60 mm are not 7 modules of module_mm, 8.6 mm: those make 60.2 mm");
    expect_error("{\"room_m\":[4,3]," LINES "}", "tape_height_mm: is missing");
}

static void mistaken_units_are_noticed(void **state)
{
    (void)state;
    expect_error("{\"room_m\":[3700,6200],\"module_mm\":8.5," LINES "}",
                 "room_m[0]: 3700 m is out of range, 0.1 to 2500 (millimetres? that would be 3.7 m)");
    expect_error("{\"room_m\":[4,6200],\"module_mm\":8.5," LINES "}", "room_m[1]: 6200 m is out of range");
    expect_error("{\"room_m\":[4,3],\"module_mm\":0.0085," LINES "}",
                 "module_mm: 0.0085 mm is out of range, 0.1 to 150 (metres? that would be 8.5 mm)");
    expect_error("{\"room_m\":[4,3],\"tape_height_mm\":0.06," LINES "}", "(metres? that would be 60 mm)");
    expect_error("{\"room_m\":[4,3],\"tape_height_mm\":60000," LINES "}", "tape_height_mm: 60000 mm is out of range");
    expect_error(LINE("\"from_m\":[120,110],\"to_m\":[3600,110]"),
                 "lines[1].from_m[0]: 120 m is outside of the room, 0 to 4 (millimetres? that would be 0.12 m)");
    expect_error(TOP("\"above_floor_m\":30," LINES), "above_floor_m: 30 m is out of range, 0 to 20 (millimetres?");
    expect_error(TOP("\"lines_mm\":[]"), "lines_mm: there is no such key; did you mean \"lines\"?");
    expect_error("{\"room_mm\":[4000,3000],\"module_mm\":8.5," LINES "}",
                 "room_mm: there is no such key; did you mean \"room_m\", in metres?");
    expect_error("{\"room_m\":[4,3],\"height_mm\":60," LINES "}",
                 "height_mm: there is no such key; did you mean \"tape_height_mm\", in millimetres?");
    expect_error(LINE("\"from_m\":[0,0],\"to\":[1,0]"), "lines[1].to: there is no such key; did you mean \"to_m\"");
    expect_error("{\"room_m\":[\"4 m\",3],\"module_mm\":8.5," LINES "}",
                 "room_m[0]: expected a number in m, without quotes");
}

static void keys_are_known_and_stand_there_once(void **state)
{
    (void)state;
    expect_error(TOP("\"colour\":\"red\"," LINES), "colour: there is no such key; expected $schema room_m tape_h");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,0],\"width\":3"),
                 "lines[1].width: there is no such key; expected from_m to_m on above_floor_m");
    expect_error(TOP("\"first_id\":1,\"first_id\":2," LINES), "the plan: the key \"first_id\" stands there twice");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,0],\"to_m\":[2,0]"),
                 "lines[1]: the key \"to_m\" stands there twice");
    expect_error(TOP("\"a key that is longer than any of those that are known to the reader\":1"), "no such key");
}

static void lines_must_hold_a_cm_within_the_room(void **state)
{
    (void)state;
    expect_error("{\"room_m\":[4,3],\"module_mm\":8.5}", "lines: is missing");
    expect_error(TOP("\"lines\":[]"), "lines: expected an array of 1 to 100000 lines");
    expect_error(TOP("\"lines\":{}"), "lines: expected an array");
    expect_error(TOP("\"lines\":[3]"), "lines[0]: must be an object");
    expect_error(LINE("\"to_m\":[1,0]"), "lines[1].from_m: is missing");
    expect_error(LINE("\"from_m\":[0,0]"), "lines[1].to_m: is missing");
    expect_error(LINE("\"from_m\":[0,0,0],\"to_m\":[1,0]"),
                 "lines[1].from_m: expected two numbers, [x, y], in metres");
    expect_error(LINE("\"from_m\":3,\"to_m\":[1,0]"), "lines[1].from_m: expected two numbers");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,3.1]"), "lines[1].to_m[1]: 3.1 m is outside of the room, 0 to 3");
    expect_error(LINE("\"from_m\":[-0.1,0],\"to_m\":[1,3]"),
                 "lines[1].from_m[0]: -0.1 m is outside of the room, 0 to 4");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1e999,3]"), "lines[1].to_m[0]: inf m is outside of the room");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,null]"), "lines[1].to_m[1]: expected a number in m");
    expect_error(LINE("\"from_m\":[1,1],\"to_m\":[1,1]"), "lines[1]: from_m and to_m are the same point");
    expect_error(LINE("\"from_m\":[1,1],\"to_m\":[1.2889,1]"),
                 "lines[1]: a line of 0.2889 m is shorter than a CM, which takes 0.289 m with its quiet zone "
                 "(34 modules of 8.5 mm)");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,0],\"on\":\"ceiling\""),
                 "lines[1].on: expected \"wall\" or \"floor\"");
    expect_error(LINE("\"from_m\":[0,0],\"to_m\":[1,0],\"on\":\"floor\",\"above_floor_m\":1"),
                 "lines[1].above_floor_m: must be 0 or left out for a tape on the floor");
}

static void a_line_of_just_one_cm_is_long_enough(void **state)
{
    plan wanted;
    error_text error;
    (void)state;
    assert_true(read_plan(LINE("\"from_m\":[1,1],\"to_m\":[1.289,1]"), &wanted, &error));
    plan_release(&wanted);
}

static void files_that_are_no_plans(void **state)
{
    plan wanted;
    error_text error;
    (void)state;
    assert_false(plan_read("/nowhere/plan.json", &wanted, &error));
    assert_string_equal(error.text, "cannot be opened: No such file or directory");
    expect_error("", "is not valid JSON: it ends too early at line 1, column 1");
    expect_error("[]", "the plan: must be an object");
    expect_error("{\"room_m\":[4,3],\n\"module_mm\":8.5,,}", "is not valid JSON: error near line 2");
    expect_error(TOP(LINES) "]", "is not valid JSON");
    expect_error("[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[", "nested too deeply");
    expect_error(TOP("\"background\":\"\"," LINES), "background: expected the name of a picture file");
    expect_error(TOP("\"background\":3," LINES), "background: expected the name");
    expect_error(TOP("\"camera_upright\":1," LINES), "camera_upright: expected true or false");
    expect_error(TOP("\"$schema\":1," LINES), "$schema: expected");
    expect_error(TOP("\"tm_cms\":8,\"tm_cms_max\":7," LINES), "tm_cms_max: 7 is out of range, 8 to 32");
}

/* ---- The schema ---------------------------------------------------------------------------------------------- */

static cJSON *schema;

/* Follows a reference. */
static const cJSON *resolved(const cJSON *rule)
{
    const char *reference = json_get_text(rule, "$ref");
    if (reference == NULL)
        return rule;
    const cJSON *definitions = cJSON_GetObjectItem(schema, "$defs");
    return cJSON_GetObjectItem(definitions, strrchr(reference, '/') + 1);
}

/* A plan in which the member under `key`, of the plan or of its only line, has another value. */
static void expect_member(bool of_line, const char *key, cJSON *value, bool right)
{
    plan wanted;
    error_text error;
    cJSON *root = cJSON_Parse("{\"room_m\":[2500,2500],\"lines\":[{\"from_m\":[0,0],\"to_m\":[200,0]}]}");
    cJSON *object = of_line ? cJSON_GetObjectItem(root, "lines")->child : root;
    cJSON_DeleteItemFromObject(object, key);
    cJSON_AddItemToObject(object, key, value);
    /* With the smallest of rooms, lines must be short and modules small. */
    const cJSON *room = cJSON_GetObjectItem(root, "room_m");
    if (cJSON_GetArraySize(room) == 2 && cJSON_GetNumberValue(room->child) < 1)
        cJSON_ReplaceItemInObject(root, "lines", cJSON_Parse("[{\"from_m\":[0,0],\"to_m\":[0.09,0]}]"));
    if (strcmp(key, "tm_cms_max") == 0)
        cJSON_AddNumberToObject(root, "tm_cms", 3);
    if (strcmp(key, "module_mm") != 0 && strcmp(key, "tape_height_mm") != 0)
        cJSON_AddNumberToObject(root, "module_mm", 1);
    char *text = cJSON_PrintUnformatted(root);
    bool read = read_plan(text, &wanted, &error);
    if (read != right)
        fail_msg("%s: %s", read ? "read" : error.text, text);
    if (!read && strstr(error.text, key) == NULL && strstr(error.text, of_line ? "lines[0]" : "the plan") == NULL)
        fail_msg("the message does not name the place: %s: %s", error.text, text);
    plan_release(&wanted);
    cJSON_free(text);
    cJSON_Delete(root);
}

static cJSON *value_with_number(const cJSON *rule, double number)
{
    if (cJSON_GetObjectItem(rule, "items") == NULL)
        return cJSON_CreateNumber(number);
    const double both[] = {number, number};
    return cJSON_CreateDoubleArray(both, 2);
}

static void check_numbers(bool of_line, const char *key, const cJSON *rule)
{
    const cJSON *limits = cJSON_GetObjectItem(rule, "items") != NULL ? cJSON_GetObjectItem(rule, "items") : rule;
    double least, most, step = strcmp(json_get_text(limits, "type"), "integer") == 0 ? 1 : 1e-6;
    assert_true(json_get_number(limits, "minimum", &least));
    if (strcmp(json_get_text(rule, "type"), "array") != 0 || cJSON_GetObjectItem(limits, "maximum") != NULL)
        expect_member(of_line, key, value_with_number(rule, least), true);
    expect_member(of_line, key, value_with_number(rule, least - step), false);
    if (json_get_number(limits, "maximum", &most)) {
        expect_member(of_line, key, value_with_number(rule, most), true);
        expect_member(of_line, key, value_with_number(rule, most + step), false);
    }
    if (step == 1)
        expect_member(of_line, key, cJSON_CreateNumber(least + 0.5), false);
    expect_member(of_line, key, cJSON_CreateString("1"), false);
}

static void check_words(bool of_line, const char *key, const cJSON *words)
{
    const cJSON *word;
    cJSON_ArrayForEach(word, words)
        expect_member(of_line, key, cJSON_Duplicate(word, true), true);
    expect_member(of_line, key, cJSON_CreateString("elsewhere"), false);
    expect_member(of_line, key, cJSON_CreateNumber(0), false);
}

/* Each property is tried at its limits and beyond, and with a value of another type. Returns how many. */
static int check_properties(bool of_line, const cJSON *object_rule)
{
    const cJSON *property;
    int count = 0;
    cJSON_ArrayForEach(property, cJSON_GetObjectItem(object_rule, "properties")) {
        const cJSON *rule = resolved(property), *words = cJSON_GetObjectItem(rule, "enum");
        const char *key = property->string, *type = json_get_text(rule, "type");
        count++;
        if (strcmp(key, "lines") == 0)
            continue;
        if (words != NULL)
            check_words(of_line, key, words);
        else if (strcmp(type, "boolean") == 0 || strcmp(type, "string") == 0) {
            bool text = strcmp(type, "string") == 0;
            expect_member(of_line, key, cJSON_CreateString("text"), text);
            expect_member(of_line, key, cJSON_CreateBool(true), !text);
        } else {
            check_numbers(of_line, key, rule);
        }
    }
    return count;
}

static void the_schema_says_the_same(void **state)
{
    error_text error;
    (void)state;
    schema = json_file_read(PLAN_SCHEMA, &error);
    if (schema == NULL)
        fail_msg("%s", error.text);
    const cJSON *lines = cJSON_GetObjectItem(cJSON_GetObjectItem(schema, "properties"), "lines");
    assert_int_equal(check_properties(false, schema), 12);
    assert_int_equal(check_properties(true, cJSON_GetObjectItem(lines, "items")), 4);
    double most;
    assert_true(json_get_number(lines, "maxItems", &most));
    assert_true(most == PLAN_LINES_MAX);
    cJSON_Delete(schema);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_plans_are_read),
        cmocka_unit_test(what_is_left_out_has_defaults),
        cmocka_unit_test(height_and_module_must_agree),
        cmocka_unit_test(mistaken_units_are_noticed),
        cmocka_unit_test(keys_are_known_and_stand_there_once),
        cmocka_unit_test(lines_must_hold_a_cm_within_the_room),
        cmocka_unit_test(a_line_of_just_one_cm_is_long_enough),
        cmocka_unit_test(files_that_are_no_plans),
        cmocka_unit_test(the_schema_says_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
