/* From what the decoder says to records: which markers, in which order, with which numbers and flags. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "frame_records.h"

static frame_reading reading;
static tapemark_cm cms[READER_CMS];
static tapemark_tm tms[READER_TMS];
static tapemark_finder finders[READER_FINDERS];
static frame_records output;
static frame_circumstances about;

static int begin(void **state)
{
    (void)state;
    memset(&output, 0, sizeof output);
    reading = (frame_reading){.view = {.width_px = 640, .height_px = 480},
                              .quality = {190, 0, 90, 90},
                              .result = {.cms = cms, .cm_capacity = READER_CMS, .tms = tms,
                                         .tm_capacity = READER_TMS, .finders = finders,
                                         .finder_capacity = READER_FINDERS}};
    about = (frame_circumstances){.seq = 7, .capture_ns = INT64_C(5000123456789), .markers_max = MARKERS_USUAL};
    return 0;
}

static void put_corners(tapemark_point corners[4], float x_px, float y_px, float length_px)
{
    const float height_px = length_px / 4;
    const tapemark_point all[4] = {{x_px, y_px}, {x_px + length_px, y_px}, {x_px + length_px, y_px + height_px},
                                   {x_px, y_px + height_px}};
    memcpy(corners, all, sizeof all);
}

static tapemark_cm *add_cm(int32_t id, float x_px, float length_px)
{
    tapemark_cm *cm = &cms[reading.result.cm_count++];
    *cm = (tapemark_cm){.id = id, .confidence = 0.976f, .tm = -1, .slot = -1};
    put_corners(cm->corners, x_px, 100, length_px);
    return cm;
}

static tapemark_tm *add_tm(const char *code, float x_px, float length_px)
{
    tapemark_tm *tm = &tms[reading.result.tm_count++];
    *tm = (tapemark_tm){.length = (uint8_t)strlen(code), .confidence = 1, .directed = true};
    strcpy(tm->code, code);
    put_corners(tm->corners, x_px, 100, length_px);
    return tm;
}

static void take(const tapemark_map *map)
{
    frame_records_of_reading(&reading, map, &about, &output);
}

static uint16_t frame_flags(void)
{
    take(NULL);
    return output.records[0].as.frame.flags;
}

/* ---- Markers ------------------------------------------------------------------------------------------------- */

static void markers_follow_their_frame(void **state)
{
    (void)state;
    add_tm("101", 100, 300);
    *add_cm(-17, 110, 60) = (tapemark_cm){.id = -17, .confidence = 0.976f, .tm = 0, .slot = 1,
                                          .corners = {{110, 100}, {170, 110}, {168, 130}, {108, 120}}};
    add_cm(500, 450, 80);
    take(NULL);
    assert_int_equal(output.count, 4);
    const tapemark_frame_record *head = &output.records[0].as.frame;
    assert_int_equal(head->seq, 7);
    assert_int_equal(head->records, 3);
    assert_int_equal(head->flags, TAPEMARK_FRAME_TIMED);
    assert_int_equal(head->capture_us, (uint32_t)UINT64_C(5000123456));
    assert_int_equal(head->width_px, 640);
    const tapemark_tm_record *tm = &output.records[1].as.tm;
    assert_int_equal(output.records[1].type, TAPEMARK_RECORD_TM);
    assert_int_equal(tm->code, 5);
    assert_int_equal(tm->length, 3);
    assert_int_equal(tm->flags, TAPEMARK_TM_DIRECTED);
    assert_int_equal(tm->cms_read, 1);
    assert_int_equal(tm->x_tenth_px, 2500);
    assert_int_equal(tm->size_tenth_px, 3000);
    const tapemark_cm_record *cm = &output.records[2].as.cm;
    assert_int_equal(cm->index, 1);
    assert_int_equal(cm->id, -17);
    assert_int_equal(cm->flags, TAPEMARK_CM_IN_TM);
    assert_int_equal(cm->tm, 0);
    assert_int_equal(cm->slot, 1);
    assert_int_equal(cm->x_tenth_px, 1390);
    assert_int_equal(cm->y_tenth_px, 1150);
    assert_int_equal(cm->size_tenth_px, 608);
    assert_int_equal(cm->angle_tenth_deg, 95);
    assert_int_equal(cm->confidence_percent, 98);
    assert_int_equal(output.records[3].as.cm.id, 500);
    assert_int_equal(output.records[3].as.cm.flags, 0);
}

static void angles_go_round(void **state)
{
    (void)state;
    tapemark_cm *cm = add_cm(1, 0, 0);
    const tapemark_point up[4] = {{100, 300}, {99.99f, 200}, {120, 200}, {120, 300}};
    memcpy(cm->corners, up, sizeof up);
    take(NULL);
    assert_int_equal(output.records[1].as.cm.angle_tenth_deg, 2700);
    const tapemark_point just_below_0[4] = {{100, 100}, {200, 99.99f}, {200, 119.99f}, {100, 120}};
    memcpy(cm->corners, just_below_0, sizeof just_below_0);
    take(NULL);
    assert_int_equal(output.records[1].as.cm.angle_tenth_deg, 0);
}

static void largest_are_sent_when_there_are_too_many(void **state)
{
    (void)state;
    about.markers_max = 3;
    add_tm("100", 0, 500);
    for (int i = 0; i < 5; i++)
        add_cm(i, (float)i * 40, 20 + (float)i)->tm = 0;
    take(NULL);
    assert_int_equal(output.count, 4);
    assert_true(output.records[0].as.frame.flags & TAPEMARK_FRAME_MARKERS_LEFT_OUT);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(output.records[1 + i].as.cm.id, 2 + i);
        assert_int_equal(output.records[1 + i].as.cm.index, i);
        assert_int_equal(output.records[1 + i].as.cm.flags, 0);
    }
}

static void id_in_two_places_is_in_neither(void **state)
{
    (void)state;
    add_cm(4, 0, 100);
    add_cm(9, 200, 100);
    add_cm(4, 400, 100);
    take(NULL);
    assert_int_equal(output.count, 2);
    assert_int_equal(output.records[1].as.cm.id, 9);
    assert_true(output.records[0].as.frame.flags & TAPEMARK_FRAME_AMBIGUOUS);
}

static void most_that_can_be_read_can_be_written(void **state)
{
    (void)state;
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    about.markers_max = MARKERS_MAX;
    for (int i = 0; i < READER_TMS; i++)
        add_tm("11111111111111111111111111111111", 0, 639);
    for (int i = 0; i < READER_CMS; i++)
        add_cm(i - 100, 0, (float)i);
    take(NULL);
    assert_int_equal(output.count, 1 + MARKERS_MAX);
    frame_records_stamp(&output, about.capture_ns, UINT32_MAX);
    for (size_t i = 0; i < output.count; i++)
        for (int encoding = 0; encoding < 2; encoding++)
            assert_true(tapemark_record_write(&output.records[i], (tapemark_encoding)encoding, bytes,
                                              sizeof bytes) > 0);
}

/* ---- Places -------------------------------------------------------------------------------------------------- */

static const int32_t map_ids[] = {-2, -1, 0, 3};
static const tapemark_map_cm map_cms[] = {{2.43f, 0.11f, 1, 0, 0, 2}, {2.21f, 0.11f, 1, 0, 0, 1},
                                          {2, -0.11f, 0, -1, 0, 0}, {3.5f, 0.2f, 0, 0, -1, -1}};
static const tapemark_map_tm map_tms[] = {{4, 3, true, 2.21f, 0.11f, 1, 0}};
static const tapemark_map map = {map_ids, map_cms, 4, map_tms, 1};

static void places_follow_their_markers(void **state)
{
    (void)state;
    add_tm("100", 100, 300);
    tapemark_cm *cm = add_cm(0, 110, 90);
    cm->tm = 0;
    cm->slot = 0;
    add_cm(3, 500, 90);
    take(&map);
    assert_int_equal(output.count, 7);
    assert_int_equal(output.records[1].as.tm.flags, TAPEMARK_TM_DIRECTED | TAPEMARK_TM_PLACED | TAPEMARK_TM_AGREES);
    assert_int_equal(output.records[2].type, TAPEMARK_RECORD_PLACE);
    assert_int_equal(output.records[2].as.place.index, 0);
    assert_int_equal(output.records[2].as.place.x_mm, 2210);
    assert_int_equal(output.records[3].as.cm.flags, TAPEMARK_CM_IN_TM | TAPEMARK_CM_PLACED);
    assert_int_equal(output.records[4].as.place.index, 1);
    assert_int_equal(output.records[4].as.place.y_mm, -110);
    assert_int_equal(output.records[4].as.place.flags, TAPEMARK_PLACE_HEADED);
    assert_int_equal(output.records[4].as.place.heading_tenth_deg, 2700);
    assert_int_equal(output.records[6].as.place.x_mm, 3500);
    assert_int_equal(output.records[6].as.place.flags, 0);
    assert_int_equal(output.records[0].as.frame.records, 6);
}

static void tm_against_the_map_places_nothing(void **state)
{
    (void)state;
    add_tm("101", 100, 300);
    tapemark_cm *cm = add_cm(0, 110, 90);
    cm->tm = 0;
    cm->slot = 0;
    take(&map);
    assert_int_equal(output.count, 3);
    assert_int_equal(output.records[1].as.tm.flags, TAPEMARK_TM_DIRECTED | TAPEMARK_TM_CONTRADICTS);
    assert_int_equal(output.records[2].as.cm.flags, TAPEMARK_CM_IN_TM);
}

/* ---- Flags --------------------------------------------------------------------------------------------------- */

static void flags_tell_what_the_decoder_met(void **state)
{
    (void)state;
    const uint16_t timed = TAPEMARK_FRAME_TIMED;
    reading.status = TAPEMARK_NOTHING_FOUND;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_NOTHING_SEEN);
    reading.status = TAPEMARK_UNFINISHED;
    reading.result.stats.limits = TAPEMARK_LIMIT_WORK;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_UNFINISHED);
    reading.status = TAPEMARK_NO_ROOM;
    reading.result.stats.limits = TAPEMARK_LIMIT_TMS;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_MARKERS_LEFT_OUT);
    reading.result.stats.limits = 0;
    reading.result.stats.rejects[TAPEMARK_REJECT_CONFLICT] = 1;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_AMBIGUOUS);
    reading.result.stats.rejects[TAPEMARK_REJECT_CONFLICT] = 0;
    reading.result.stats.rejects[TAPEMARK_REJECT_BARS] = 1;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_PARTIAL);
}

static void flags_tell_of_the_picture(void **state)
{
    (void)state;
    const uint16_t timed = TAPEMARK_FRAME_TIMED;
    reading.quality.light = 30;
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_TOO_DARK);
    reading.quality = (image_quality){255, 60, 90, 90};
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_TOO_BRIGHT);
    reading.quality = (image_quality){190, 0, 90, 20};
    assert_int_equal(frame_flags(), timed | TAPEMARK_FRAME_BLURRED);
    reading.quality = (image_quality){190, 0, SHARPNESS_UNKNOWN, SHARPNESS_UNKNOWN};
    assert_int_equal(frame_flags(), timed);
}

static void flags_tell_the_circumstances(void **state)
{
    (void)state;
    about.replayed = about.map_broken = true;
    about.capture_ns = FRAME_TIME_UNKNOWN;
    assert_int_equal(frame_flags(), TAPEMARK_FRAME_REPLAYED | TAPEMARK_FRAME_MAP_BROKEN);
}

static void finder_without_marker_is_partial(void **state)
{
    (void)state;
    add_cm(5, 100, 128);
    finders[0].centre = (tapemark_point){114, 114};
    reading.result.finder_count = 1;
    assert_false(frame_flags() & TAPEMARK_FRAME_PARTIAL);
    finders[1].centre = (tapemark_point){300, 114};
    reading.result.finder_count = 2;
    assert_true(frame_flags() & TAPEMARK_FRAME_PARTIAL);
}

static void cm_of_an_unread_tm_is_partial(void **state)
{
    (void)state;
    add_cm(3, 100, 128);
    take(&map);
    assert_false(output.records[0].as.frame.flags & TAPEMARK_FRAME_PARTIAL);
    add_cm(-1, 300, 128);
    take(&map);
    assert_true(output.records[0].as.frame.flags & TAPEMARK_FRAME_PARTIAL);
}

/* ---- Time, and loss ------------------------------------------------------------------------------------------ */

static void stamp_tells_age_and_what_was_left_out(void **state)
{
    (void)state;
    tapemark_frame_record *head = &output.records[0].as.frame;
    take(NULL);
    frame_records_stamp(&output, about.capture_ns + 12345678, 3);
    assert_int_equal(head->age_10us, 1234);
    assert_int_equal(head->dropped, 3);
    assert_true(head->flags & TAPEMARK_FRAME_FRAMES_DROPPED);
    frame_records_stamp(&output, about.capture_ns + INT64_C(700000000), 0);
    assert_int_equal(head->age_10us, 65535);
    assert_false(head->flags & TAPEMARK_FRAME_FRAMES_DROPPED);
    frame_records_stamp(&output, about.capture_ns - 1000000, 256);
    assert_int_equal(head->age_10us, 0);
    assert_int_equal(head->dropped, 255);
}

static void loss_has_no_picture(void **state)
{
    (void)state;
    frame_records_of_loss(&about, &output);
    frame_records_stamp(&output, about.capture_ns + 1000000, 0);
    assert_int_equal(output.count, 1);
    assert_int_equal(output.records[0].as.frame.flags, TAPEMARK_FRAME_CAMERA_LOST);
    assert_int_equal(output.records[0].as.frame.width_px, 0);
    assert_int_equal(output.records[0].as.frame.age_10us, 0);
    assert_int_equal(output.records[0].as.frame.seq, 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(markers_follow_their_frame, begin),
        cmocka_unit_test_setup(angles_go_round, begin),
        cmocka_unit_test_setup(largest_are_sent_when_there_are_too_many, begin),
        cmocka_unit_test_setup(id_in_two_places_is_in_neither, begin),
        cmocka_unit_test_setup(most_that_can_be_read_can_be_written, begin),
        cmocka_unit_test_setup(places_follow_their_markers, begin),
        cmocka_unit_test_setup(tm_against_the_map_places_nothing, begin),
        cmocka_unit_test_setup(flags_tell_what_the_decoder_met, begin),
        cmocka_unit_test_setup(flags_tell_of_the_picture, begin),
        cmocka_unit_test_setup(flags_tell_the_circumstances, begin),
        cmocka_unit_test_setup(finder_without_marker_is_partial, begin),
        cmocka_unit_test_setup(cm_of_an_unread_tm_is_partial, begin),
        cmocka_unit_test_setup(stamp_tells_age_and_what_was_left_out, begin),
        cmocka_unit_test_setup(loss_has_no_picture, begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
