/* Looking places up in a table of CMs and TMs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <math.h>

#include "tapemark.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* ---- A small map ------------------------------------------------------------------------------------------- */

/*
 * TMs, in the order of the table:  0: 001 = -4 -5 6,  1: 100 = 1 -2 -3,  2: 101 = 20 -21 22,  3: 0011, twice (4), of
 * which only 30 is on the map, and its slot is unknown,  5: 1000 = 7 -8 -9 -10. CM 40 and -40 stand alone.
 */
enum { TM_001, TM_100, TM_101, TM_0011, TM_0011_AGAIN, TM_1000, TM_COUNT };

static const int32_t small_ids[] = {-40, -21, -10, -9, -8, -5, -4, -3, -2, 1, 6, 7, 20, 22, 30, 40};

static const tapemark_map_cm small_cms[] = {
    {0, 0.25f, 0, 0, -1, -1},    {2, 9, 0, 1, TM_101, 1},  {4, 11, 0, 1, TM_1000, 3}, {4, 10, 0, 1, TM_1000, 2},
    {4, 9, 0, 1, TM_1000, 1},    {2, 5, 1, 0, TM_001, 1},  {1, 5, 1, 0, TM_001, 0},   {3, 2, 1, 0, TM_100, 2},
    {2, 2, 1, 0, TM_100, 1},     {1, 2, 1, 0, TM_100, 0},  {3, 5, 1, 0, TM_001, 2},   {4, 8, 0, 1, TM_1000, 0},
    {2, 8, 0, 1, TM_101, 0},     {2, 10, 0, 1, TM_101, 2}, {0, 0, 0, 0, TM_0011, -1}, {9.5f, -1, 0.6f, 0.8f, -1, -1}};

static const tapemark_map_tm small_tms[] = {
    [TM_001] = {1, 3, true, 2, 5, 1, 0},   [TM_100] = {4, 3, true, 2, 2, 1, 0},
    [TM_101] = {5, 3, true, 2, 9, 0, 1},   [TM_0011] = {3, 4, false, 0, 0, 0, 0},
    [TM_0011_AGAIN] = {3, 4, true, 7, 7, 0, 0}, [TM_1000] = {8, 4, true, 4, 9.5f, 0, 1}};

static const tapemark_map small = {small_ids, small_cms, COUNT_OF(small_ids), small_tms, TM_COUNT};

/* The example of tapemark.h. */
static void example_of_the_header_is_good(void **state)
{
    static const int32_t ids[] = {-2, -1, 0, 3};
    static const tapemark_map_cm cms[] = {
        {2.43f, 0.11f, 1, 0, 0, 2}, {2.21f, 0.11f, 1, 0, 0, 1}, {2, 0.11f, 1, 0, 0, 0}, {3.5f, 0.2f, 0, 0, -1, -1}};
    static const tapemark_map_tm tms[] = {{4, 3, true, 2.21f, 0.11f, 1, 0}};
    static const tapemark_map map = {ids, cms, 4, tms, 1};
    size_t index = 4711;
    (void)state;
    assert_int_equal(tapemark_map_check(&map, NULL), TAPEMARK_OK);
    assert_int_equal(tapemark_map_find_tm(&map, "100", true, &index), TAPEMARK_OK);
    assert_int_equal(index, 0);
    assert_int_equal(tapemark_map_find_cm(&map, 3, &index), TAPEMARK_OK);
    assert_int_equal(index, 3);
}

/* ---- Finding ----------------------------------------------------------------------------------------------- */

static void constant_tables_are_good(void **state)
{
    size_t index = 4711;
    (void)state;
    assert_int_equal(COUNT_OF(small_ids), COUNT_OF(small_cms));
    assert_int_equal(tapemark_map_check(&small, &index), TAPEMARK_OK);
    assert_int_equal(index, 4711);
}

static void cms_take_28_bytes_and_tms_32(void **state)
{
    (void)state;
    assert_int_equal(sizeof(tapemark_map_cm) + sizeof(int32_t), 28);
    assert_int_equal(sizeof(tapemark_map_tm), 32);
    assert_true(100000 * 28 + 33334 * 32 < 4000000);
}

static void every_cm_is_found_and_no_other(void **state)
{
    (void)state;
    for (int32_t id = -60; id <= 60; id++) {
        size_t index = 4711, expected = 0;
        while (expected < small.cm_count && small_ids[expected] != id)
            expected++;
        bool there = expected < small.cm_count;
        assert_int_equal(tapemark_map_find_cm(&small, id, &index), there ? TAPEMARK_OK : TAPEMARK_NOTHING_FOUND);
        assert_int_equal(index, there ? expected : 4711);
    }
}

/* All numbers of ids up to some, with gaps of all kinds between them. */
static void tables_of_all_lengths(void **state)
{
    enum { MOST = 300 };
    static int32_t ids[MOST];
    static tapemark_map_cm cms[MOST];
    uint32_t random = 1;
    (void)state;
    for (size_t count = 0; count <= MOST; count++) {
        int32_t next = -(int32_t)(count / 2) * 3;
        for (size_t i = 0; i < count; i++) {
            random = random * 1664525 + 1013904223;
            cms[i] = (tapemark_map_cm){.tm = -1, .slot = -1};
            ids[i] = next += 1 + (int32_t)(random >> 30);
        }
        tapemark_map map = {ids, cms, count, NULL, 0};
        assert_int_equal(tapemark_map_check(&map, NULL), TAPEMARK_OK);
        size_t index = 0, at = 0;
        for (int32_t id = -1000; id <= next + 2; id++) {
            bool there = at < count && ids[at] == id;
            tapemark_status status = tapemark_map_find_cm(&map, id, &index);
            assert_int_equal(status, there ? TAPEMARK_OK : TAPEMARK_NOTHING_FOUND);
            assert_true(!there || index == at++);
        }
        assert_int_equal(at, count);
    }
}

static void expect_tm(const char *code, bool directed, tapemark_status status, size_t expected)
{
    size_t index = 4711;
    assert_int_equal(tapemark_map_find_tm(&small, code, directed, &index), status);
    assert_int_equal(index, status == TAPEMARK_OK ? expected : 4711);
}

static void tms_are_found_by_their_codes(void **state)
{
    (void)state;
    expect_tm("001", true, TAPEMARK_OK, TM_001);
    expect_tm("100", true, TAPEMARK_OK, TM_100);
    expect_tm("1000", true, TAPEMARK_OK, TM_1000);
    expect_tm("0001", true, TAPEMARK_NOTHING_FOUND, 0);
    expect_tm("011", true, TAPEMARK_NOTHING_FOUND, 0);
    expect_tm("10000", true, TAPEMARK_NOTHING_FOUND, 0);
    expect_tm("00001000", true, TAPEMARK_NOTHING_FOUND, 0);
    expect_tm("0011", true, TAPEMARK_AMBIGUOUS, 0);
    /* Undirected, 100 may be either of two; 101 reads the same both ways and is one. */
    expect_tm("100", false, TAPEMARK_AMBIGUOUS, 0);
    expect_tm("001", false, TAPEMARK_AMBIGUOUS, 0);
    expect_tm("101", false, TAPEMARK_OK, TM_101);
    expect_tm("1000", false, TAPEMARK_OK, TM_1000);
    expect_tm("0001", false, TAPEMARK_OK, TM_1000);
    expect_tm("1100", false, TAPEMARK_AMBIGUOUS, 0);
    expect_tm("1110", false, TAPEMARK_NOTHING_FOUND, 0);
}

static void longest_codes(void **state)
{
    static const tapemark_map_tm tms[] = {{0, 64, true, 0, 0, 0, 0},
                                          {1, 64, true, 0, 0, 0, 0},
                                          {UINT64_MAX, 64, true, 0, 0, 0, 0}};
    const tapemark_map map = {NULL, NULL, 0, tms, COUNT_OF(tms)};
    char code[TAPEMARK_MAP_CODE_MAX + 2] = "";
    size_t index = 0;
    (void)state;
    assert_int_equal(tapemark_map_check(&map, NULL), TAPEMARK_OK);
    memset(code, '1', TAPEMARK_MAP_CODE_MAX);
    assert_int_equal(tapemark_map_find_tm(&map, code, true, &index), TAPEMARK_OK);
    assert_int_equal(index, 2);
    memset(code + 1, '0', TAPEMARK_MAP_CODE_MAX - 1);
    assert_int_equal(tapemark_map_find_tm(&map, code, true, &index), TAPEMARK_NOTHING_FOUND);
    assert_int_equal(tapemark_map_find_tm(&map, code, false, &index), TAPEMARK_OK);
    assert_int_equal(index, 1);
    code[TAPEMARK_MAP_CODE_MAX] = '0';
    assert_int_equal(tapemark_map_find_tm(&map, code, true, &index), TAPEMARK_BAD_CALL);
}

static void bad_calls_are_told_apart(void **state)
{
    static const tapemark_map no_ids = {NULL, small_cms, 1, NULL, 0}, no_cms = {small_ids, NULL, 1, NULL, 0},
                              no_tms = {small_ids, small_cms, 1, NULL, 1}, empty = {NULL, NULL, 0, NULL, 0};
    const tapemark_map *const bad[] = {NULL, &no_ids, &no_cms, &no_tms};
    size_t index = 4711;
    (void)state;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        assert_int_equal(tapemark_map_check(bad[i], &index), TAPEMARK_BAD_CALL);
        assert_int_equal(tapemark_map_find_cm(bad[i], 1, &index), TAPEMARK_BAD_CALL);
        assert_int_equal(tapemark_map_find_tm(bad[i], "100", true, &index), TAPEMARK_BAD_CALL);
    }
    assert_int_equal(tapemark_map_find_cm(&small, 1, NULL), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_map_find_tm(&small, "100", true, NULL), TAPEMARK_BAD_CALL);
    static const char *const codes[] = {NULL, "", "10", "102", "1 0", "abc"};
    for (size_t i = 0; i < COUNT_OF(codes); i++)
        assert_int_equal(tapemark_map_find_tm(&small, codes[i], true, &index), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_map_check(&empty, NULL), TAPEMARK_OK);
    assert_int_equal(tapemark_map_find_cm(&empty, 0, &index), TAPEMARK_NOTHING_FOUND);
    assert_int_equal(tapemark_map_find_tm(&empty, "100", false, &index), TAPEMARK_NOTHING_FOUND);
    assert_int_equal(index, 4711);
}

/* ---- Checking ---------------------------------------------------------------------------------------------- */

typedef struct flawed_map {
    int32_t ids[COUNT_OF(small_ids)];
    tapemark_map_cm cms[COUNT_OF(small_ids)];
    tapemark_map_tm tms[TM_COUNT];
    tapemark_map map;
} flawed_map;

static flawed_map *copy_small(void)
{
    static flawed_map copy;
    memcpy(copy.ids, small_ids, sizeof small_ids);
    memcpy(copy.cms, small_cms, sizeof small_cms);
    memcpy(copy.tms, small_tms, sizeof small_tms);
    copy.map = (tapemark_map){copy.ids, copy.cms, COUNT_OF(small_ids), copy.tms, TM_COUNT};
    return &copy;
}

static void expect_flaw(const flawed_map *flawed, size_t expected)
{
    size_t index = 4711;
    assert_int_equal(tapemark_map_check(&flawed->map, &index), TAPEMARK_BAD_MAP);
    assert_int_equal(index, expected);
    assert_int_equal(tapemark_map_check(&flawed->map, NULL), TAPEMARK_BAD_MAP);
}

/* With one member of a fresh copy of the small map changed, the check names the entry. */
#define EXPECT_FLAW(index, member, value)     \
    do {                                      \
        flawed_map *flawed = copy_small();    \
        flawed->member = (value);             \
        expect_flaw(flawed, (index));         \
    } while (0)

static void flaws_of_cms_are_found(void **state)
{
    (void)state;
    EXPECT_FLAW(0, ids[0], -TAPEMARK_MAX_ID - 1);
    EXPECT_FLAW(15, ids[15], TAPEMARK_MAX_ID + 1);
    EXPECT_FLAW(0, ids[0], INT32_MIN);
    EXPECT_FLAW(3, ids[3], -10);
    EXPECT_FLAW(4, ids[4], -20);
    EXPECT_FLAW(0, cms[0].x_m, NAN);
    EXPECT_FLAW(7, cms[7].y_m, INFINITY);
    EXPECT_FLAW(15, cms[15].dx, 0.5f);
    EXPECT_FLAW(15, cms[15].dy, NAN);
    EXPECT_FLAW(0, cms[0].tm, TM_COUNT);
    EXPECT_FLAW(1, cms[1].tm, TM_COUNT);
    EXPECT_FLAW(1, cms[1].tm, -2);
    EXPECT_FLAW(0, cms[0].tm, -2);
    EXPECT_FLAW(0, cms[0].slot, 0);      /* of no TM */
    EXPECT_FLAW(5, cms[5].slot, 3);      /* of three */
    EXPECT_FLAW(5, cms[5].slot, -2);
    EXPECT_FLAW(5, cms[5].slot, 2);      /* a dark CM where the code has a light one */
    EXPECT_FLAW(9, cms[9].slot, 1);      /* and the other way round */
}

static void flaws_of_tms_are_found(void **state)
{
    enum { TMS = COUNT_OF(small_ids) };
    (void)state;
    EXPECT_FLAW(TMS, tms[TM_001].length, 2);
    EXPECT_FLAW(TMS + TM_1000, tms[TM_1000].length, 65);
    EXPECT_FLAW(TMS + TM_1000, tms[TM_1000].code, 16);
    EXPECT_FLAW(TMS + TM_100, tms[TM_100].code, 0);  /* out of order */
    EXPECT_FLAW(TMS + TM_100, tms[TM_001].length, 4);
    EXPECT_FLAW(TMS + TM_001, tms[TM_001].x_m, NAN);
    EXPECT_FLAW(TMS + TM_001, tms[TM_001].y_m, -INFINITY);
    EXPECT_FLAW(TMS + TM_101, tms[TM_101].dx, 1);
    /* What has no place may hold anything there. */
    flawed_map *placeless = copy_small();
    placeless->tms[TM_0011].x_m = NAN;
    assert_int_equal(tapemark_map_check(&placeless->map, NULL), TAPEMARK_OK);
}

/* ---- A TM and its CMs -------------------------------------------------------------------------------------- */

typedef struct reading {
    int32_t id;
    int16_t slot;
} reading;

/* Locates a TM in which up to three CMs were read; a CM of no TM and one of another stand beside it. */
static tapemark_tm_place locate(const char *code, bool directed, size_t count, const reading cms_read[3])
{
    tapemark_cm cms[5] = {{.id = -40, .tm = -1, .slot = -1}, {.id = 7, .tm = 0, .slot = 0}};
    tapemark_tm tms[2] = {{.code = "1000", .length = 4}, {.length = (uint8_t)strlen(code), .directed = directed}};
    tapemark_result result = {.cms = cms, .cm_count = count + 2, .tms = tms, .tm_count = 2};
    tapemark_tm_place place;
    memcpy(tms[1].code, code, strlen(code) + 1);
    for (size_t i = 0; i < count; i++)
        cms[i + 2] = (tapemark_cm){.id = cms_read[i].id, .tm = 1, .slot = cms_read[i].slot};
    tapemark_status status = tapemark_map_locate_tm(&small, &result, 1, &place);
    assert_int_equal(status, place.tm >= 0                                  ? TAPEMARK_OK
                             : place.agreement == TAPEMARK_CODE_AMBIGUOUS ? TAPEMARK_AMBIGUOUS
                                                                          : TAPEMARK_NOTHING_FOUND);
    return place;
}

#define READ(...) (sizeof((reading[]){__VA_ARGS__}) / sizeof(reading)), (reading[3]){__VA_ARGS__}
#define NONE_READ 0, NULL

static void expect_place(tapemark_tm_place place, tapemark_agreement agreement, int32_t tm, bool backwards)
{
    assert_int_equal(place.agreement, agreement);
    assert_int_equal(place.tm, tm);
    assert_int_equal(place.backwards, backwards);
}

static void tm_without_cms_is_located_by_its_code(void **state)
{
    (void)state;
    expect_place(locate("100", true, NONE_READ), TAPEMARK_CODE_ALONE, TM_100, false);
    expect_place(locate("0001", false, NONE_READ), TAPEMARK_CODE_ALONE, TM_1000, true);
    expect_place(locate("101", false, NONE_READ), TAPEMARK_CODE_ALONE, TM_101, false);
    expect_place(locate("100", false, NONE_READ), TAPEMARK_CODE_AMBIGUOUS, -1, false);
    expect_place(locate("0011", true, NONE_READ), TAPEMARK_CODE_AMBIGUOUS, -1, false);
    expect_place(locate("0001", true, NONE_READ), TAPEMARK_CODE_UNKNOWN, -1, false);
}

static void tm_with_unknown_cms_has_no_place(void **state)
{
    (void)state;
    tapemark_cm own = {.id = 1, .tm = 0, .slot = 0};
    tapemark_tm tm = {.code = "100", .length = 3, .directed = true, .unknown_cms = 1};
    tapemark_result result = {.cms = &own, .cm_count = 1, .tms = &tm, .tm_count = 1};
    for (; result.cm_count <= 1; result.cm_count--) {
        tapemark_tm_place place;
        assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, &place), TAPEMARK_NOTHING_FOUND);
        expect_place(place, TAPEMARK_CM_UNKNOWN, -1, false);
    }
}

static void tm_agrees_with_its_cms(void **state)
{
    (void)state;
    expect_place(locate("100", true, READ({1, 0}, {-2, 1}, {-3, 2})), TAPEMARK_AGREES, TM_100, false);
    expect_place(locate("100", true, READ({-3, 2})), TAPEMARK_AGREES, TM_100, false);
    /* CMs decide where the code alone could not. */
    expect_place(locate("100", false, READ({-3, 2})), TAPEMARK_AGREES, TM_100, false);
    expect_place(locate("100", false, READ({-5, 1})), TAPEMARK_AGREES, TM_001, true);
    expect_place(locate("100", false, READ({6, 0}, {-4, 2})), TAPEMARK_AGREES, TM_001, true);
    expect_place(locate("101", false, READ({22, 0}, {-21, 1})), TAPEMARK_AGREES, TM_101, true);
    /* Where the map does not tell the slot, any will do. */
    expect_place(locate("0011", true, READ({30, 0})), TAPEMARK_AGREES, TM_0011, false);
}

static void tm_and_cms_that_contradict_each_other(void **state)
{
    (void)state;
    expect_place(locate("100", true, READ({1, 0}, {2, 1})), TAPEMARK_CM_UNKNOWN, -1, false);
    expect_place(locate("100", true, READ({40, 0})), TAPEMARK_CM_WITHOUT_TM, -1, false);
    expect_place(locate("100", true, READ({1, 0}, {-5, 1})), TAPEMARK_CMS_OF_SEVERAL_TMS, -1, false);
    expect_place(locate("110", true, READ({1, 0})), TAPEMARK_CODE_OF_OTHER_TM, -1, false);
    expect_place(locate("1000", true, READ({1, 0})), TAPEMARK_CODE_OF_OTHER_TM, -1, false);
    expect_place(locate("100", true, READ({1, 0}, {-2, 2})), TAPEMARK_CM_IN_OTHER_SLOT, -1, false);
    expect_place(locate("100", false, READ({-2, 2})), TAPEMARK_CM_IN_OTHER_SLOT, -1, false);
    expect_place(locate("100", false, READ({-5, 0})), TAPEMARK_CM_IN_OTHER_SLOT, -1, false);
    expect_place(locate("100", true, READ({-4, 2}, {6, 0})), TAPEMARK_RUNS_BACKWARDS, -1, false);
    expect_place(locate("101", true, READ({22, 0})), TAPEMARK_RUNS_BACKWARDS, -1, false);
}

/* What tapemark_map_check() would have found leads to no memory outside of the table. */
static void a_tm_that_is_not_there_is_none(void **state)
{
    static const int32_t id = 1;
    static const int32_t wrong[] = {1, 2, INT32_MAX, -2, INT32_MIN};
    static const tapemark_map_tm mapped = {.code = 4, .length = 3};
    tapemark_cm cm = {.id = 1, .tm = 0, .slot = 0};
    tapemark_tm tm = {.code = "100", .length = 3, .directed = true};
    tapemark_result result = {.cms = &cm, .cm_count = 1, .tms = &tm, .tm_count = 1};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(wrong); i++) {
        tapemark_map_cm entry = {.tm = wrong[i], .slot = 0};
        tapemark_map map = {&id, &entry, 1, &mapped, 1};
        tapemark_tm_place place;
        assert_int_equal(tapemark_map_locate_tm(&map, &result, 0, &place), TAPEMARK_NOTHING_FOUND);
        expect_place(place, TAPEMARK_CM_WITHOUT_TM, -1, false);
    }
}

static void bad_calls_of_locate(void **state)
{
    tapemark_tm tm = {.code = "100", .length = 3, .directed = true};
    tapemark_result result = {.tms = &tm, .tm_count = 1};
    tapemark_tm_place place;
    (void)state;
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, &place), TAPEMARK_OK);
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 1, &place), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_map_locate_tm(NULL, &result, 0, &place), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_map_locate_tm(&small, NULL, 0, &place), TAPEMARK_BAD_CALL);
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, NULL), TAPEMARK_BAD_CALL);
    tm.code[0] = '\0';
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, &place), TAPEMARK_BAD_CALL);
    tm.code[0] = 'x';
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, &place), TAPEMARK_BAD_CALL);
    tm.code[0] = '1';
    result.cm_count = 1;
    assert_int_equal(tapemark_map_locate_tm(&small, &result, 0, &place), TAPEMARK_BAD_CALL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_the_header_is_good),
        cmocka_unit_test(constant_tables_are_good),
        cmocka_unit_test(cms_take_28_bytes_and_tms_32),
        cmocka_unit_test(every_cm_is_found_and_no_other),
        cmocka_unit_test(tables_of_all_lengths),
        cmocka_unit_test(tms_are_found_by_their_codes),
        cmocka_unit_test(longest_codes),
        cmocka_unit_test(bad_calls_are_told_apart),
        cmocka_unit_test(flaws_of_cms_are_found),
        cmocka_unit_test(flaws_of_tms_are_found),
        cmocka_unit_test(tm_without_cms_is_located_by_its_code),
        cmocka_unit_test(tm_with_unknown_cms_has_no_place),
        cmocka_unit_test(tm_agrees_with_its_cms),
        cmocka_unit_test(tm_and_cms_that_contradict_each_other),
        cmocka_unit_test(a_tm_that_is_not_there_is_none),
        cmocka_unit_test(bad_calls_of_locate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
