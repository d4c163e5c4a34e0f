/* Map files as the table in which the library looks places up. */
#include "test_main.h"

#include "map_ids.h"
#include "map_table.h"
#include "planned_map.h"

static void load_text(const char *text, map_table *table)
{
    error_text error;
    const char *path = temporary_file(".json", text, strlen(text));
    if (!map_table_load(path, table, &error))
        fail_msg("%s", error.text);
    unlink(path);
}

static void planned_maps_are_found_again(void **state)
{
    tape_map map;
    map_table table;
    error_text error;
    (void)state;
    assert_true(make_planned_map(2000, &map));
    assert_true(map_table_make(&map, &table, &error));
    assert_int_equal(tapemark_map_check(&table.map, NULL), TAPEMARK_OK);
    assert_int_equal(table.map.cm_count, 2000);
    size_t tm_count = 0;
    for (size_t i = 0; i < map.segment_count; i++) {
        const map_segment *segment = &map.segments[i];
        double angle = (double)i * 0.61;
        tm_count += segment->code[0] != '\0';
        for (size_t slot = 0; slot < segment->cm_count; slot++) {
            const map_cm *wanted = &map.cms[segment->first_cm + slot];
            size_t index, other;
            assert_int_equal(tapemark_map_find_cm(&table.map, wanted->id, &index), TAPEMARK_OK);
            const tapemark_map_cm *cm = &table.map.cms[index];
            assert_true(fabs((double)cm->x_m - wanted->centre.x_m) < 1e-4);
            assert_true(fabs((double)cm->y_m - wanted->centre.y_m) < 1e-4);
            assert_true(fabs((double)cm->dx - cos(angle)) < 1e-6 && fabs((double)cm->dy - sin(angle)) < 1e-6);
            assert_int_equal(cm->slot, segment->cm_count > 1 ? (int)slot : -1);
            assert_int_equal(tapemark_map_find_cm(&table.map, map.cms[segment->first_cm].id, &other), TAPEMARK_OK);
            assert_int_equal(cm->tm, table.map.cms[other].tm);
            if (segment->cm_count == 1)
                continue;
            const tapemark_map_tm *tm = &table.map.tms[cm->tm];
            assert_int_equal(tm->length, segment->cm_count);
            assert_true(tm->placed);
            assert_true(fabs((double)tm->x_m - (segment->start.x_m + segment->end.x_m) / 2) < 1e-4);
            assert_true(fabs((double)tm->dy - sin(angle)) < 1e-6);
        }
    }
    assert_int_equal(table.map.tm_count, tm_count);
    map_table_release(&table);
    tape_map_release(&map);
}

#define CM(id, x, y, code, tm) \
    "{\"idcm_decimal\":" #id ",\"x\":" #x ",\"y\":" #y ",\"idtm\":\"" #code "\",\"n_tm\":\"" #tm "\"}"

/* The inventors' format gives centres alone: a whole TM tells its direction, one that lacks CMs not even its middle.
 */
static void what_centres_tell(void **state)
{
    map_table table;
    size_t index;
    (void)state;
    load_text("[" CM(1, 5, 1, 100, a) "," CM(-2, 5, 2, 100, a) "," CM(-3, 5, 3, 100, a) "," CM(
                  7, 1, 1, 1110, b) "," CM(8, 2, 1, 1110, b) "," CM(9, 4, 4, , ) "]",
              &table);
    assert_int_equal(tapemark_map_check(&table.map, NULL), TAPEMARK_OK);
    const tapemark_map_tm *whole = &table.map.tms[0], *partial = &table.map.tms[1];
    assert_true(whole->code == 4 && whole->length == 3 && whole->placed && whole->x_m == 5 && whole->y_m == 2);
    assert_true(whole->dx == 0 && whole->dy == 1);
    assert_true(partial->code == 14 && partial->length == 4 && !partial->placed && partial->dx == 0 &&
                partial->dy == 0);

    assert_int_equal(tapemark_map_find_cm(&table.map, 7, &index), TAPEMARK_OK);
    assert_true(table.map.cms[index].tm == 1 && table.map.cms[index].slot == -1 && table.map.cms[index].dx == 0);
    assert_int_equal(tapemark_map_find_cm(&table.map, -3, &index), TAPEMARK_OK);
    assert_true(table.map.cms[index].tm == 0 && table.map.cms[index].slot == 2 && table.map.cms[index].dy == 1);
    assert_int_equal(tapemark_map_find_cm(&table.map, 9, &index), TAPEMARK_OK);
    assert_true(table.map.cms[index].tm == -1 && table.map.cms[index].dx == 0 && table.map.cms[index].dy == 0);
    map_table_release(&table);
}

static void same_codes_are_kept_apart(void **state)
{
    map_table table;
    size_t index;
    (void)state;
    load_text("[" CM(1, 1, 1, 111, a) "," CM(4, 4, 1, 111, b) "," CM(2, 2, 1, 111, a) "," CM(3, 3, 1, 111, a) "," CM(
                  5, 5, 1, 111, b) "," CM(6, 6, 1, 111, b) "]",
              &table);
    assert_int_equal(tapemark_map_check(&table.map, NULL), TAPEMARK_OK);
    assert_int_equal(table.map.tm_count, 2);
    assert_true(table.map.cms[0].tm == 0 && table.map.cms[3].tm == 1);
    assert_int_equal(tapemark_map_find_tm(&table.map, "111", true, &index), TAPEMARK_AMBIGUOUS);
    map_table_release(&table);
}

static void ids_configure_the_decoder(void **state)
{
    static const int32_t ids[] = {-3, -2, 1};
    map_table table;
    tapemark_config config = {0};
    (void)state;
    load_text("[" CM(1, 5, 1, 100, a) "," CM(-2, 5, 2, 100, a) "," CM(-3, 5, 3, 100, a) "]", &table);
    map_table_configure(&table, &config);
    assert_int_equal(config.known_id_count, COUNT_OF(ids));
    assert_memory_equal(config.known_ids, ids, sizeof ids);
    map_table_release(&table);
}

static void a_bad_map_leaves_no_table(void **state)
{
    map_table table;
    error_text error;
    (void)state;
    assert_false(map_table_load("/nonexistent/map.json", &table, &error));
    assert_non_null(strstr(error.text, "No such file"));
    assert_null(table.ids);
    assert_int_equal(table.map.cm_count, 0);
    map_table_release(&table);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planned_maps_are_found_again), cmocka_unit_test(what_centres_tell),
        cmocka_unit_test(same_codes_are_kept_apart),    cmocka_unit_test(ids_configure_the_decoder),
        cmocka_unit_test(a_bad_map_leaves_no_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
