/* Whatever the plan: ids and codes are unique, pieces lie on their lines in order and without overlap. */
#include "make_test.h"

#include <math.h>

#include "layout_map.h"
#include "map_ids.h"

enum { PLANS = 120, LINES_MAX = 2000 };

static uint64_t random_state;

/* SplitMix64. */
static uint64_t random_bits(void)
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
}

static double random_real(double least, double most)
{
    return least + (most - least) * (double)(random_bits() >> 11) / 9007199254740992.0;
}

static unsigned random_whole(unsigned least, unsigned most)
{
    return least + (unsigned)(random_bits() % (most - least + 1));
}

/* Now and then as short as can be, or with a length that is just enough for something. */
static plan_line random_line(const plan *room)
{
    plan_line line;
    double least_m = PLAN_CM_MODULES * room->module_mm / 1000;
    do {
        line = (plan_line){.from = {random_real(0, room->width_m), random_real(0, room->height_m)},
                           .to = {random_real(0, room->width_m), random_real(0, room->height_m)},
                           .mount = random_whole(0, 1) == 0 ? PLAN_ON_WALL : PLAN_ON_FLOOR};
        double length_m = plan_line_length_m(&line);
        double wanted_m = least_m * random_whole(1, 12) / random_whole(1, 2);
        if (random_whole(0, 1) == 0 && wanted_m >= least_m && wanted_m < length_m) {
            line.to.x_m = line.from.x_m + (line.to.x_m - line.from.x_m) * wanted_m / length_m;
            line.to.y_m = line.from.y_m + (line.to.y_m - line.from.y_m) * wanted_m / length_m;
        }
    } while (plan_line_modules(room, &line) < PLAN_CM_MODULES);
    line.above_floor_m = line.mount == PLAN_ON_WALL ? random_real(0, 3) : 0;
    return line;
}

static plan random_plan(void)
{
    plan wanted = {.width_m = random_real(2, 60), .height_m = random_real(2, 60), .module_mm = random_real(1, 25),
                   .first_id = random_whole(0, 1) == 0 ? 0 : (int32_t)random_whole(0, 200000),
                   .tm_cms = random_whole(0, 1) == 0 ? PLAN_TM_CMS : random_whole(3, TAPEMARK_TM_MAX_CMS),
                   .camera_upright = random_whole(0, 3) == 0};
    wanted.tm_cms_max = random_whole(wanted.tm_cms, TAPEMARK_TM_MAX_CMS);
    wanted.line_count = random_whole(0, 3) > 0 ? random_whole(1, 40) : random_whole(1, LINES_MAX);
    wanted.lines = calloc(wanted.line_count, sizeof *wanted.lines);
    assert_non_null(wanted.lines);
    for (size_t i = 0; i < wanted.line_count; i++)
        wanted.lines[i] = random_line(&wanted);
    return wanted;
}

/* ---- Claims -------------------------------------------------------------------------------------------------- */

static void ids_count_up(const plan *wanted, const tape_layout *layout)
{
    for (size_t i = 0; i < layout->cm_count; i++)
        assert_int_equal(abs(layout->ids[i]), wanted->first_id + (int32_t)i);
    size_t cm_count = 0;
    for (size_t i = 0; i < layout->segment_count; i++) {
        assert_int_equal(layout->segments[i].first_cm, cm_count);
        cm_count += layout->segments[i].cm_count;
    }
    assert_int_equal(layout->cm_count, cm_count);
}

/* Pieces lie one behind the other, and none is missing at the end of a line. */
static void lines_are_full(const plan *wanted, const tape_layout *layout)
{
    size_t at = 0;
    for (size_t line = 0; line < wanted->line_count; line++) {
        uint32_t end = 0, length = plan_line_modules(wanted, &wanted->lines[line]);
        for (; at < layout->segment_count && layout->segments[at].line == line; at++) {
            const layout_segment *segment = &layout->segments[at];
            assert_int_equal(segment->bars, segment->cm_count >= TAPEMARK_TM_MIN_CMS);
            assert_true(segment->bars || segment->cm_count == 1);
            assert_true(segment->cm_count <= wanted->tm_cms_max);
            assert_int_equal(segment->start_modules, end + (segment->bars ? 2 : 1));
            end += segment->bars ? 25 * (uint32_t)segment->cm_count + 27 : 34;
            assert_true(segment->bars || layout->ids[segment->first_cm] >= 0);
        }
        assert_true(end <= length);
        assert_true(length - end < PLAN_CM_MODULES);
    }
    assert_int_equal(at, layout->segment_count);
}

typedef struct tm_text {
    char forwards[TAPEMARK_TM_MAX_CMS + 1], canonical[TAPEMARK_TM_MAX_CMS + 1];
} tm_text;

static int compare_canonical(const void *a, const void *b)
{
    return strcmp(((const tm_text *)a)->canonical, ((const tm_text *)b)->canonical);
}

/* No code twice; and unless cameras know which way is up, read from either end. */
static void codes_differ(const plan *wanted, const tape_map *map)
{
    tm_text *texts = calloc(map->segment_count + 1, sizeof *texts);
    size_t count = 0;
    assert_non_null(texts);
    for (size_t i = 0; i < map->segment_count; i++) {
        size_t length = strlen(map->segments[i].code);
        if (length == 0)
            continue;
        tm_text *text = &texts[count++];
        char backwards[TAPEMARK_TM_MAX_CMS + 1] = "";
        memcpy(text->forwards, map->segments[i].code, length);
        for (size_t j = 0; j < length; j++)
            backwards[j] = text->forwards[length - 1 - j];
        bool turned = !wanted->camera_upright && strcmp(backwards, text->forwards) < 0;
        assert_true(wanted->camera_upright || strcmp(backwards, text->forwards) != 0);
        memcpy(text->canonical, turned ? backwards : text->forwards, sizeof backwards);
    }
    qsort(texts, count, sizeof *texts, compare_canonical);
    for (size_t i = 1; i < count; i++)
        assert_string_not_equal(texts[i - 1].canonical, texts[i].canonical);
    free(texts);
}

/* How far along its line a point lies, in modules; it must lie on it. */
static double modules_along(const plan *wanted, const plan_line *line, map_point point)
{
    double length_m = plan_line_length_m(line);
    double along_x = (line->to.x_m - line->from.x_m) / length_m, along_y = (line->to.y_m - line->from.y_m) / length_m;
    double dx = point.x_m - line->from.x_m, dy = point.y_m - line->from.y_m;
    assert_true(fabs(dx * along_y - dy * along_x) < 1e-5);
    return (dx * along_x + dy * along_y) * 1000 / wanted->module_mm;
}

static void map_is_where_the_layout_is(const plan *wanted, const tape_layout *layout, const tape_map *map)
{
    double tolerance_modules = 0.01 / wanted->module_mm;
    assert_int_equal(map->cm_count, layout->cm_count);
    assert_int_equal(map->segment_count, layout->segment_count);
    for (size_t i = 0; i < map->segment_count; i++) {
        const map_segment *placed = &map->segments[i];
        const layout_segment *segment = &layout->segments[i];
        const plan_line *line = &wanted->lines[segment->line];
        double start = modules_along(wanted, line, placed->start), end = modules_along(wanted, line, placed->end);
        assert_int_equal(placed->first_cm, segment->first_cm);
        assert_int_equal(placed->cm_count, segment->cm_count);
        assert_true(placed->complete && strlen(placed->code) == (segment->bars ? segment->cm_count : 0));
        assert_true(fabs(start - segment->start_modules) < tolerance_modules);
        assert_int_equal(placed->mount == MAP_ON_FLOOR, line->mount == PLAN_ON_FLOOR);
        assert_true(placed->above_floor_m == line->above_floor_m);
        double bars = segment->bars ? TAPEMARK_BAR_MODULES : 0, before = start + bars;
        for (size_t slot = 0; slot < segment->cm_count; slot++) {
            const map_cm *cm = &map->cms[placed->first_cm + slot];
            assert_int_equal(cm->id, layout->ids[segment->first_cm + slot]);
            assert_true(!segment->bars || (cm->id >= 0) == (placed->code[slot] == '1'));
            assert_true(fabs(modules_along(wanted, line, cm->start) - before) < tolerance_modules);
            assert_true(fabs(modules_along(wanted, line, cm->centre) - before - 16) < tolerance_modules);
            assert_true(fabs(modules_along(wanted, line, cm->end) - before - 32) < tolerance_modules);
            before += TAPEMARK_CM_PITCH_MODULES;
        }
        assert_true(fabs(end - before - 7 - bars) < tolerance_modules);
    }
}

static void assert_near(map_point a, map_point b)
{
    assert_true(fabs(a.x_m - b.x_m) < 1e-5 && fabs(a.y_m - b.y_m) < 1e-5);
}

/* The reader of maps, which looks for contradictions, finds none, and what was written. */
static void map_is_read_again(const tape_map *map, unsigned seed)
{
    tape_map again;
    error_text error = {""};
    const char *path = temporary_plan("");
    if (!map_file_write(path, map, &error) || !map_file_read(path, map_ids_check, &again, &error))
        fail_msg("seed %u: %s", seed, error.text);
    unlink(path);
    assert_int_equal(again.cm_count, map->cm_count);
    assert_int_equal(again.segment_count, map->segment_count);
    for (size_t i = 0; i < map->cm_count; i++) {
        assert_int_equal(again.cms[i].id, map->cms[i].id);
        assert_near(again.cms[i].start, map->cms[i].start);
        assert_near(again.cms[i].end, map->cms[i].end);
    }
    for (size_t i = 0; i < map->segment_count; i++)
        assert_string_equal(again.segments[i].code, map->segments[i].code);
    tape_map_release(&again);
}

static void any_plan_keeps_the_promises(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= PLANS; seed++) {
        tape_layout layout;
        tape_map map;
        error_text error = {""};
        random_state = seed;
        plan wanted = random_plan();
        if (!layout_make(&wanted, &layout, &error) || !layout_map(&wanted, &layout, &map, &error))
            fail_msg("seed %u: %s", (unsigned)seed, error.text);
        ids_count_up(&wanted, &layout);
        lines_are_full(&wanted, &layout);
        codes_differ(&wanted, &map);
        map_is_where_the_layout_is(&wanted, &layout, &map);
        if (seed % 4 == 0)
            map_is_read_again(&map, (unsigned)seed);
        tape_map_release(&map);
        layout_release(&layout);
        plan_release(&wanted);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_plan_keeps_the_promises),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
