/* Lines, rows and summaries made of results that are typed in below. */
#include "test_main.h"

#include "map_table.h"
#include "marker_place.h"
#include "report.h"
#include "summary.h"

#include <cjson/cJSON.h>

#define SQUARE(x, y) {{(x), (y)}, {(x) + 10, (y)}, {(x) + 10, (y) + 5}, {(x), (y) + 5}}

static tapemark_cm cms[] = {
    {.id = 1505582, .corners = SQUARE(0.25f, 1), .confidence = 0.5f, .doubtful_cells = 3, .corrected_cells = 1,
     .tm = -1, .slot = -1},
    /* Not in the order of their slots. */
    {.id = -20, .corners = SQUARE(30, 1), .confidence = 1, .tm = 0, .slot = 3},
    {.id = 17, .corners = SQUARE(10, 1), .confidence = 1, .tm = 0, .slot = 0},
};

static tapemark_tm tms[] = {
    {.code = "1000", .length = 4, .directed = true, .vote = 0.75f, .confidence = 0.9f, .corners = SQUARE(5, 1)},
    {.code = "101", .length = 3, .directed = false, .vote = 1, .confidence = 1, .corners = SQUARE(50, 1)},
};

static frame_report make_report(tapemark_result *result)
{
    *result = (tapemark_result){.cms = cms, .cm_count = COUNT_OF(cms), .tms = tms, .tm_count = COUNT_OF(tms)};
    return (frame_report){"walk.mp4", 7, 640, 480, 1500000000, 812, result, NULL};
}

/* The names of an object's members, in order, with blanks between them. */
static const char *keys_of(const cJSON *object)
{
    static char keys[256];
    keys[0] = '\0';
    for (const cJSON *member = object->child; member != NULL; member = member->next) {
        strcat(keys, member->string);
        strcat(keys, member->next != NULL ? " " : "");
    }
    return keys;
}

static cJSON *parse_line(const frame_report *report)
{
    text_buffer line = {0};
    report_add_json(&line, report);
    assert_int_equal(line.text[line.length - 1], '\n');
    assert_ptr_equal(strchr(line.text, '\n'), line.text + line.length - 1);
    cJSON *object = cJSON_Parse(line.text);
    assert_non_null(object);
    text_buffer_release(&line);
    return object;
}

static double number_of(const cJSON *object, const char *key)
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(object, key);
    assert_true(cJSON_IsNumber(member));
    return member->valuedouble;
}

static double corner_of(const cJSON *marker, int corner, int axis)
{
    const cJSON *corners = cJSON_GetObjectItemCaseSensitive(marker, "corners");
    assert_int_equal(cJSON_GetArraySize(corners), 4);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetArrayItem(corners, corner)), 2);
    return cJSON_GetArrayItem(cJSON_GetArrayItem(corners, corner), axis)->valuedouble;
}

/* ---- JSON Lines ---------------------------------------------------------------------------------------------- */

static void frame_without_markers(void **state)
{
    text_buffer line = {0};
    tapemark_result result = {0};
    frame_report report = {"a.png", 0, 3, 2, FRAME_TIME_UNKNOWN, 5, &result, NULL};
    (void)state;
    report_add_json(&line, &report);
    assert_string_equal(line.text, "{\"source\":\"a.png\",\"frame\":0,\"width\":3,\"height\":2,\"decode_us\":5,"
                                   "\"markers\":[]}\n");
    text_buffer_release(&line);
}

static void frame_has_its_keys_in_order(void **state)
{
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    cJSON *object = parse_line(&report);
    assert_string_equal(keys_of(object), "source frame width height decode_us markers time_s");
    assert_string_equal(cJSON_GetObjectItem(object, "source")->valuestring, "walk.mp4");
    assert_true(number_of(object, "frame") == 7);
    assert_true(number_of(object, "width") == 640);
    assert_true(number_of(object, "height") == 480);
    assert_true(number_of(object, "decode_us") == 812);
    assert_true(number_of(object, "time_s") == 1.5);
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(object, "markers")), 5);
    cJSON_Delete(object);
}

static void cm_has_its_keys_in_order(void **state)
{
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    cJSON *object = parse_line(&report);
    const cJSON *lone = cJSON_GetArrayItem(cJSON_GetObjectItem(object, "markers"), 0);
    assert_string_equal(keys_of(lone), "type id corners confidence doubtful corrected");
    assert_string_equal(cJSON_GetObjectItem(lone, "type")->valuestring, "cm");
    assert_true(number_of(lone, "id") == 1505582);
    assert_true(number_of(lone, "confidence") == 0.5);
    assert_true(number_of(lone, "doubtful") == 3);
    assert_true(number_of(lone, "corrected") == 1);
    assert_true(corner_of(lone, 0, 0) == 0.25 && corner_of(lone, 0, 1) == 1);
    assert_true(corner_of(lone, 2, 0) == 10.25 && corner_of(lone, 2, 1) == 6);

    const cJSON *member = cJSON_GetArrayItem(cJSON_GetObjectItem(object, "markers"), 1);
    assert_string_equal(keys_of(member), "type id corners confidence doubtful corrected tm slot");
    assert_true(number_of(member, "tm") == 0);
    assert_true(number_of(member, "slot") == 3);
    cJSON_Delete(object);
}

static void tm_lists_its_cms_in_slot_order(void **state)
{
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    cJSON *object = parse_line(&report);
    const cJSON *tm = cJSON_GetArrayItem(cJSON_GetObjectItem(object, "markers"), 3);
    assert_string_equal(keys_of(tm), "type code directed corners confidence cms vote");
    assert_string_equal(cJSON_GetObjectItem(tm, "type")->valuestring, "tm");
    assert_string_equal(cJSON_GetObjectItem(tm, "code")->valuestring, "1000");
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(tm, "directed")));
    assert_true(number_of(tm, "vote") == 0.75);
    const cJSON *ids = cJSON_GetObjectItem(tm, "cms");
    assert_int_equal(cJSON_GetArraySize(ids), 2);
    assert_int_equal(cJSON_GetArrayItem(ids, 0)->valueint, 17);
    assert_int_equal(cJSON_GetArrayItem(ids, 1)->valueint, -20);

    const cJSON *second = cJSON_GetArrayItem(cJSON_GetObjectItem(object, "markers"), 4);
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(second, "directed")));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(second, "cms")), 0);
    cJSON_Delete(object);
}

static void limits_are_named(void **state)
{
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    result.stats.limits = TAPEMARK_LIMIT_WORK | TAPEMARK_LIMIT_LENGTH;
    cJSON *object = parse_line(&report);
    const cJSON *limits = cJSON_GetObjectItem(object, "limits");
    assert_int_equal(cJSON_GetArraySize(limits), 2);
    assert_string_equal(cJSON_GetArrayItem(limits, 0)->valuestring, "work");
    assert_string_equal(cJSON_GetArrayItem(limits, 1)->valuestring, "length");
    cJSON_Delete(object);
}

static void every_limit_has_a_name(void **state)
{
    const uint32_t all = TAPEMARK_LIMIT_SCAN | TAPEMARK_LIMIT_WORK | TAPEMARK_LIMIT_CANDIDATES | TAPEMARK_LIMIT_CMS |
                         TAPEMARK_LIMIT_TMS | TAPEMARK_LIMIT_LENGTH;
    (void)state;
    assert_int_equal(all, (1u << SUMMARY_LIMITS) - 1);
    for (unsigned bit = 0; bit < SUMMARY_LIMITS; bit++)
        assert_non_null(report_limit_name(bit));
    assert_null(report_limit_name(SUMMARY_LIMITS));
}

/* ---- CSV and text -------------------------------------------------------------------------------------------- */

static size_t count_fields(const char *row)
{
    size_t fields = 1;
    bool quoted = false;
    for (; *row != '\n'; row++) {
        quoted ^= *row == '"';
        fields += *row == ',' && !quoted;
    }
    return fields;
}

static void csv_has_a_row_a_marker(void **state)
{
    static const char expected[] =
        "walk.mp4,7,640,480,812,cm,1505582,,,0.25,1.00,10.25,1.00,10.25,6.00,0.25,6.00,0.500,,,,,,\n"
        "walk.mp4,7,640,480,812,cm,-20,,,30.00,1.00,40.00,1.00,40.00,6.00,30.00,6.00,1.000,,,,,,\n"
        "walk.mp4,7,640,480,812,cm,17,,,10.00,1.00,20.00,1.00,20.00,6.00,10.00,6.00,1.000,,,,,,\n"
        "walk.mp4,7,640,480,812,tm,,1000,1,5.00,1.00,15.00,1.00,15.00,6.00,5.00,6.00,0.900,17 -20,,,,,\n"
        "walk.mp4,7,640,480,812,tm,,101,0,50.00,1.00,60.00,1.00,60.00,6.00,50.00,6.00,1.000,,,,,,\n";
    text_buffer rows = {0}, header = {0};
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    report_add_csv(&rows, &report);
    assert_string_equal(rows.text, expected);
    report_add_csv_header(&header);
    assert_int_equal(count_fields(header.text), 24);
    for (const char *row = rows.text; *row != '\0'; row = strchr(row, '\n') + 1)
        assert_int_equal(count_fields(row), 24);
    text_buffer_release(&rows);
    text_buffer_release(&header);
}

static void text_has_a_line_a_marker(void **state)
{
    static const char expected[] =
        "walk.mp4 frame 7: CM 1505582 at (5, 4), confidence 0.50\n"
        "walk.mp4 frame 7: CM -20 at (35, 4), confidence 1.00\n"
        "walk.mp4 frame 7: CM 17 at (15, 4), confidence 1.00\n"
        "walk.mp4 frame 7: TM 1000 at (10, 4), confidence 0.90, CMs 17 -20\n"
        "walk.mp4 frame 7: TM 101 (or backwards) at (55, 4), confidence 1.00\n";
    text_buffer lines = {0};
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    report_add_text(&lines, &report);
    assert_string_equal(lines.text, expected);
    text_buffer_release(&lines);
}

/* The TM of the first result at (1.5 … 4.5, 2), and CM 1505582 alone. */
static const char table_map[] =
    "[{\"idcm_decimal\":17,\"x\":4.5,\"y\":2,\"idtm\":\"1000\",\"n_tm\":1},"
    "{\"idcm_decimal\":-18,\"x\":3.5,\"y\":2,\"idtm\":\"1000\",\"n_tm\":1},"
    "{\"idcm_decimal\":-19,\"x\":2.5,\"y\":2,\"idtm\":\"1000\",\"n_tm\":1},"
    "{\"idcm_decimal\":-20,\"x\":1.5,\"y\":2,\"idtm\":\"1000\",\"n_tm\":1},"
    "{\"idcm_decimal\":1505582,\"x\":7,\"y\":8}]";

static void load_table(map_table *table)
{
    error_text error;
    assert_true(map_table_load(temporary_file(".json", table_map, sizeof table_map - 1), table, &error));
    unlink(temporary_file(".json", "", 0));
}

static void json_has_places_and_agreement(void **state)
{
    map_table table;
    tapemark_result result;
    frame_report report = make_report(&result);
    (void)state;
    load_table(&table);
    report.map = &table.map;
    cJSON *object = parse_line(&report);
    const cJSON *markers = cJSON_GetObjectItem(object, "markers");
    const cJSON *lone = cJSON_GetArrayItem(markers, 0), *member = cJSON_GetArrayItem(markers, 1);
    const cJSON *tm = cJSON_GetArrayItem(markers, 3), *unknown = cJSON_GetArrayItem(markers, 4);
    assert_string_equal(keys_of(lone), "type id corners confidence doubtful corrected x y");
    assert_true(number_of(lone, "x") == 7 && number_of(lone, "y") == 8);
    assert_string_equal(keys_of(member), "type id corners confidence doubtful corrected tm slot x y direction_deg");
    assert_true(number_of(member, "x") == 1.5 && number_of(member, "y") == 2);
    assert_true(number_of(member, "direction_deg") == 180);
    assert_string_equal(keys_of(tm), "type code directed corners confidence cms vote x y direction_deg agrees");
    assert_true(number_of(tm, "x") == 3 && number_of(tm, "direction_deg") == 180);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(tm, "agrees")));
    assert_string_equal(keys_of(unknown), "type code directed corners confidence cms vote agrees reason");
    assert_true(cJSON_IsFalse(cJSON_GetObjectItem(unknown, "agrees")));
    assert_string_equal(cJSON_GetObjectItem(unknown, "reason")->valuestring, "unknown_code");
    cJSON_Delete(object);
    map_table_release(&table);
}

/* A TM alone in its frame, without CMs or with -20 in some slot. */
static const cJSON *report_tm(const tapemark_map *map, const char *code, bool directed, int slot)
{
    static cJSON *object;
    tapemark_cm cm = {.id = -20, .tm = 0, .slot = (int16_t)slot};
    tapemark_tm tm = {.length = (uint8_t)strlen(code), .directed = directed};
    tapemark_result result = {.cms = &cm, .cm_count = slot >= 0, .tms = &tm, .tm_count = 1};
    frame_report report = {"a", 0, 1, 1, FRAME_TIME_UNKNOWN, 1, &result, map};
    memcpy(tm.code, code, strlen(code) + 1);
    cJSON_Delete(object);
    object = code[0] != '\0' ? parse_line(&report) : NULL;
    return cJSON_GetArrayItem(cJSON_GetObjectItem(object, "markers"), slot >= 0);
}

static void json_tells_why_a_tm_does_not_agree(void **state)
{
    map_table table;
    (void)state;
    load_table(&table);
    const cJSON *tm = report_tm(&table.map, "0001", false, -1);
    assert_string_equal(keys_of(tm), "type code directed corners confidence cms vote x y direction_deg agrees reason "
                                     "read_backwards");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(tm, "agrees")));
    assert_string_equal(cJSON_GetObjectItem(tm, "reason")->valuestring, "no_cms");
    tm = report_tm(&table.map, "1000", true, 1);
    assert_string_equal(keys_of(tm), "type code directed corners confidence cms vote agrees reason");
    assert_string_equal(cJSON_GetObjectItem(tm, "reason")->valuestring, "other_slot");
    tm = report_tm(&table.map, "0001", true, 0);
    assert_string_equal(cJSON_GetObjectItem(tm, "reason")->valuestring, "backwards");
    tm = report_tm(&table.map, "0001", false, 0);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(tm, "agrees")));
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(tm, "read_backwards")));
    report_tm(NULL, "", false, -1);
    map_table_release(&table);
}

static void csv_and_text_have_places_and_agreement(void **state)
{
    map_table table;
    tapemark_result result;
    frame_report report = make_report(&result);
    text_buffer rows = {0}, lines = {0};
    (void)state;
    load_table(&table);
    report.map = &table.map;
    report_add_csv(&rows, &report);
    assert_non_null(strstr(rows.text, ",0.500,,7.0000,8.0000,,,\n"));
    assert_non_null(strstr(rows.text, ",1.000,,1.5000,2.0000,180.00,,\n"));
    assert_non_null(strstr(rows.text, ",17 -20,3.0000,2.0000,180.00,true,\n"));
    assert_non_null(strstr(rows.text, ",1.000,,,,,false,unknown_code\n"));
    for (const char *row = rows.text; *row != '\0'; row = strchr(row, '\n') + 1)
        assert_int_equal(count_fields(row), 24);
    report_add_text(&lines, &report);
    assert_non_null(strstr(lines.text, "CM 1505582 at (5, 4), confidence 0.50, on the plan at (7.00 m, 8.00 m)\n"));
    assert_non_null(strstr(lines.text, "CMs 17 -20, on the plan at (3.00 m, 2.00 m) reading towards 180 deg, its CMs "
                                       "agree\n"));
    assert_non_null(strstr(lines.text, "confidence 1.00, no place: its code is not on the map\n"));
    text_buffer_release(&rows);
    text_buffer_release(&lines);
    map_table_release(&table);
}

static void every_agreement_has_its_words(void **state)
{
    (void)state;
    for (int a = TAPEMARK_AGREES; a <= TAPEMARK_RUNS_BACKWARDS; a++) {
        assert_true(strlen(agreement_phrase((tapemark_agreement)a)) > 0);
        for (int b = TAPEMARK_AGREES; b < a; b++) {
            assert_string_not_equal(agreement_name((tapemark_agreement)a), agreement_name((tapemark_agreement)b));
            assert_string_not_equal(agreement_phrase((tapemark_agreement)a), agreement_phrase((tapemark_agreement)b));
        }
    }
}

/* ---- Summary ------------------------------------------------------------------------------------------------- */

static void summary_counts_frames_ids_and_times(void **state)
{
    static const uint32_t times_us[] = {900, 100, 5000};
    char text[512] = "";
    summary total;
    error_text error;
    tapemark_result result, nothing = {0};
    make_report(&result);
    (void)state;
    assert_true(summary_init(&total, &error));
    result.stats.limits = TAPEMARK_LIMIT_WORK;
    nothing.stats.limits = TAPEMARK_LIMIT_WORK | TAPEMARK_LIMIT_SCAN;
    for (size_t i = 0; i < COUNT_OF(times_us); i++)
        assert_true(summary_add(&total, i == 1 ? &nothing : &result, times_us[i], &error));
    FILE *stream = fmemopen(text, sizeof text, "w");
    summary_print(&total, stream);
    fclose(stream);
    assert_string_equal(text, "3 frames, 2 with a marker read: 6 CMs (3 distinct ids), 4 TMs; decoding took 0.90 ms "
                              "in the median, 5.00 ms at most\nlimits hit: scan in 1 frame, work in 3 frames\n");
    summary_release(&total);
}

static void summary_tells_the_outermost_ids_apart(void **state)
{
    tapemark_cm outermost[] = {{.id = TAPEMARK_MAX_ID}, {.id = -TAPEMARK_MAX_ID}, {.id = 0}, {.id = -1}, {.id = 1}};
    tapemark_result result = {.cms = outermost, .cm_count = COUNT_OF(outermost)};
    summary total;
    error_text error;
    (void)state;
    assert_true(summary_init(&total, &error));
    for (int i = 0; i < 3000; i++)
        assert_true(summary_add(&total, &result, 1, &error));
    assert_int_equal(total.distinct_ids, COUNT_OF(outermost));
    assert_int_equal(total.frames, 3000);
    summary_release(&total);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frame_without_markers),
        cmocka_unit_test(frame_has_its_keys_in_order),
        cmocka_unit_test(cm_has_its_keys_in_order),
        cmocka_unit_test(tm_lists_its_cms_in_slot_order),
        cmocka_unit_test(limits_are_named),
        cmocka_unit_test(every_limit_has_a_name),
        cmocka_unit_test(csv_has_a_row_a_marker),
        cmocka_unit_test(text_has_a_line_a_marker),
        cmocka_unit_test(json_has_places_and_agreement),
        cmocka_unit_test(json_tells_why_a_tm_does_not_agree),
        cmocka_unit_test(csv_and_text_have_places_and_agreement),
        cmocka_unit_test(every_agreement_has_its_words),
        cmocka_unit_test(summary_counts_frames_ids_and_times),
        cmocka_unit_test(summary_tells_the_outermost_ids_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
