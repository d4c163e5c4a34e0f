/* Ways of a camera: what is read, what is refused, and where the camera is between waypoints. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "camera_path.h"

static camera_path way;
static error_text error;

static bool read_text(const char *text, size_t size)
{
    char path[] = "/tmp/tapemark-path-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, text, size), size);
    close(file);
    error.text[0] = '\0';
    bool done = camera_path_read(path, &way, &error);
    unlink(path);
    return done;
}

static void assert_refused(const char *text, const char *reason)
{
    assert_false(read_text(text, strlen(text)));
    assert_null(way.waypoints);
    if (strstr(error.text, reason) == NULL)
        fail_msg("'%s' instead of '%s'", error.text, reason);
}

static void assert_near(double value, double expected)
{
    if (!(value > expected - 1e-9 && value < expected + 1e-9))
        fail_msg("%.12g instead of %.12g", value, expected);
}

static void columns_come_in_any_order(void **state)
{
    (void)state;
    static const char text[] = "# a way\n\nheading_deg, time_s,x_m , y_m,height_m,roll_deg\r\n"
                               " 90, 1.5 ,2,3,1.4,-5\r\n# on\n91,2,2.5,3,1.4,0";
    assert_true(read_text(text, sizeof text - 1));
    assert_int_equal(way.count, 2);
    const camera_waypoint *first = &way.waypoints[0];
    assert_near(first->time_s, 1.5);
    assert_near(first->x_m, 2);
    assert_near(first->y_m, 3);
    assert_near(first->height_m, 1.4);
    assert_near(first->heading_deg, 90);
    assert_near(first->pitch_deg, 0);
    assert_near(first->roll_deg, -5);
    assert_near(way.waypoints[1].x_m, 2.5);
    camera_path_release(&way);
}

#define HEAD "time_s,x_m,y_m,height_m,heading_deg\n"

static void what_is_wrong_is_told_with_its_line(void **state)
{
    (void)state;
    assert_refused("", "is empty");
    assert_refused("# nothing\n\n", "is empty");
    assert_refused(HEAD, "has no waypoint");
    assert_refused("time_s,x_m,y_m,height_m\n", "line 1: there is no column heading_deg");
    assert_refused("time_s,x_m,y_m,z_m,heading_deg\n", "line 1: column \"z_m\" is none of");
    assert_refused("time_s,x_m,x_m,height_m,heading_deg\n", "line 1: column x_m is there twice");
    assert_refused(HEAD "0,1,2,1\n", "line 2: heading_deg: expected a number, not \"\"");
    assert_refused(HEAD "0,1,2,1,5,6\n", "line 2: there are more cells");
    assert_refused(HEAD "\n0,1,two,1,5\n", "line 3: y_m: expected a number, not \"two\"");
    assert_refused(HEAD "0,1,nan,1,5\n", "line 2: y_m: expected a number");
    assert_refused(HEAD "0,1,1e999,1,5\n", "line 2: y_m: expected a number");
    assert_refused(HEAD "0,1e9,1,1,5\n", "line 2: the place is out of range");
    assert_refused(HEAD "0,1,1,0,5\n", "line 2: the height is out of range");
    assert_refused(HEAD "0,1,1,1,1e5\n", "line 2: the heading is out of range");
    assert_refused(HEAD "1e7,1,1,1,1\n", "line 2: the time is out of range");
    assert_refused(HEAD "0,1,1,1,5\n0,1,1,1,5\n", "line 3: time_s does not ascend: 0 after 0");
    assert_refused("time_s,x_m,y_m,height_m,heading_deg,pitch_deg\n0,1,1,1,1,100\n",
                   "line 2: the pitch is out of range");
}

static void zero_bytes_and_missing_files_are_refused(void **state)
{
    (void)state;
    assert_false(read_text(HEAD "0,1,2\0,1,5\n", sizeof HEAD + 10));
    assert_non_null(strstr(error.text, "zero byte"));
    assert_false(camera_path_read("/nonexistent/way.csv", &way, &error));
    assert_false(camera_path_read("/", &way, &error));
}

static void the_camera_goes_straight_and_evenly(void **state)
{
    (void)state;
    static const char text[] = "time_s,x_m,y_m,height_m,heading_deg,pitch_deg,roll_deg\n"
                               "1,0,10,1,0,-10,170\n3,4,10,2,90,-20,-170\n4,4,12,2,90,-20,-170\n";
    assert_true(read_text(text, sizeof text - 1));
    camera_waypoint place = camera_path_at(&way, 1.5);
    assert_near(place.x_m, 1);
    assert_near(place.y_m, 10);
    assert_near(place.height_m, 1.25);
    assert_near(place.heading_deg, 22.5);
    assert_near(place.pitch_deg, -12.5);
    assert_near(place.roll_deg, 175);  /* through 180, not through 0 */
    assert_near(camera_path_at(&way, 3).x_m, 4);
    assert_near(camera_path_at(&way, 3.5).y_m, 11);
    assert_near(camera_path_at(&way, 0).x_m, 0);
    assert_near(camera_path_at(&way, 0).time_s, 0);
    assert_near(camera_path_at(&way, 9).y_m, 12);
    camera_path_release(&way);
}

static void headings_turn_the_short_way(void **state)
{
    (void)state;
    static const char text[] = HEAD "0,0,0,1,350\n1,0,0,1,10\n2,0,0,1,-60\n";
    assert_true(read_text(text, sizeof text - 1));
    assert_near(camera_path_at(&way, 0.25).heading_deg, 355);
    assert_near(camera_path_at(&way, 1.5).heading_deg, -25);
    camera_path_release(&way);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_come_in_any_order),
        cmocka_unit_test(what_is_wrong_is_told_with_its_line),
        cmocka_unit_test(zero_bytes_and_missing_files_are_refused),
        cmocka_unit_test(the_camera_goes_straight_and_evenly),
        cmocka_unit_test(headings_turn_the_short_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
