/* The command line: what is refused, with which words, and what becomes of what is not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "render_options.h"

enum { WORDS_MAX = 140 };

static render_options all;
static error_text error;

/* Up to the first NULL. */
static options_answer parse(const char *const *words)
{
    static char copies[WORDS_MAX][64];
    static char program[] = "tapemark-render";
    char *arguments[WORDS_MAX + 2] = {program};
    int count = 1;
    for (; words[count - 1] != NULL; count++) {
        snprintf(copies[count - 1], sizeof copies[0], "%s", words[count - 1]);
        arguments[count] = copies[count - 1];
    }
    error.text[0] = '\0';
    return render_options_parse(count, arguments, &all, &error);
}

static void assert_parsed(const char *const *words)
{
    if (parse(words) != OPTIONS_RUN)
        fail_msg("%s", error.text);
}

static void wrong_usage_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *told;
        const char *words[12];
    } cases[] = {
        {"'b.png' is left over", {"-o", "a.png", "b.png"}},
        {"a.gif: ends neither in", {"-o", "a.gif"}},
        {"--format: expected one of PGM", {"--format", "GIF", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "abc", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "nan", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "inf", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "1e999", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "361", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "12x", "-o", "a.png"}},
        {"--yaw: expected a number from -360 to 360", {"--yaw", "1 2", "-o", "a.png"}},
        {"--distance: expected a length in m, cm, mm or in from 0.001m to 10000m, not \"3\"",
         {"--distance", "3", "-o", "a.png"}},
        {"--distance: expected a length", {"--distance", "3ft", "-o", "a.png"}},
        {"--distance: expected a length", {"--distance", "0m", "-o", "a.png"}},
        {"--shutter: expected a time in s or ms from 0s to 10s", {"--shutter", "5m", "-o", "a.png"}},
        {"--frames: expected a whole number from 1 to 100000, not \"1.5\"", {"--frames", "1.5", "-o", "a.y4m"}},
        {"--frames", {"--frames", "0", "-o", "a.y4m"}},
        {"--jpeg: expected a whole number from 1 to 100", {"--jpeg", "0", "-o", "a.pgm"}},
        {"--jpeg: Y10 has more than 8 bits", {"--jpeg", "50", "--format", "Y10", "-o", "a.raw"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "640", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "0x480", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "640x", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "9000x10", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "640x480x3", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "-1x5", "-o", "a.pgm"}},
        {"--size: expected WIDTHxHEIGHT", {"--size", "x", "-o", "a.pgm"}},
        {"--size: NV12 comes in groups", {"--size", "641x480", "--format", "NV12", "-o", "a.raw"}},
        {"--stride: a row of 640 px of GREY is at least 640", {"--stride", "639", "--format", "GREY", "-o", "a.raw"}},
        {"--stride: a row of 640 px of PGM is 640", {"--stride", "700", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", ",", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "1,", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "1,,2", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "1505583", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "-1505583", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "99999999999999999999", "-o", "a.pgm"}},
        {"--ids: expected up to 64 ids", {"--ids", "one", "-o", "a.pgm"}},
        {"--background: expected one of plain", {"--background", "sky", "-o", "a.pgm"}},
        {"--wall: expected one of paint", {"--wall", "sky", "-o", "a.pgm"}},
        {"--bars: expected one of", {"--bars", "maybe", "-o", "a.pgm"}},
        {"--like: expected one of condition-a", {"--like", "me", "-o", "a.pgm"}},
        {"--cover: expected numbers X,Y,WIDTH,HEIGHT", {"--cover", "1,2,3", "-o", "a.pgm"}},
        {"--cover: expected a width", {"--cover", "1,2,0,5", "-o", "a.pgm"}},
        {"--covered: expected a number from 0 to 1", {"--covered", "30", "-o", "a.pgm"}},
        {"--picture: expected FILE:HEIGHT", {"--picture", "a.png", "-o", "a.pgm"}},
        {"--picture: expected FILE:HEIGHT", {"--picture", "a.png:7", "-o", "a.pgm"}},
        {"--picture: expected FILE:HEIGHT", {"--picture", ":60mm", "-o", "a.pgm"}},
        {"--at: comes after", {"--at", "1,2,3,4", "-o", "a.pgm"}},
        {"--at: expected numbers X,Y,HEIGHT,FACING", {"--ids", "1", "--at", "1,2,3", "-o", "a.pgm"}},
        {"--camera: expected numbers X,Y,HEIGHT,HEADING", {"--camera", "1,2,3", "-o", "a.pgm"}},
        {"--camera: the height is out of range", {"--camera", "1,2,0,3", "-o", "a.pgm"}},
        {"--box: expected sizes of 0.001 m or more", {"--box", "1,2,0,1,1", "-o", "a.pgm"}},
        {"need a --camera or a --path", {"--map", "given/map.json", "-o", "a.pgm"}},
        {"need things on a plan", {"--camera", "1,2,1,0", "-o", "a.pgm"}},
        {"needs an --at", {"--map", "given/map.json", "--camera", "1,2,1,0", "--ids", "5", "-o", "a.pgm"}},
        {"exclude each other",
         {"--map", "given/map.json", "--camera", "1.5,2,1,-90,-20", "--path", "given/way.csv", "-o", "a.y4m"}},
        {"exclude each other", {"--distance", "1m", "--px-per-module", "3", "-o", "a.pgm"}},
        {"for things in a row",
         {"--map", "given/map.json", "--camera", "1.5,2,1,-90,-20", "--distance", "1m", "-o", "a.pgm"}},
        {"turn and move a row",
         {"--map", "given/map.json", "--camera", "1.5,2,1,-90,-20", "--yaw", "10", "-o", "a.pgm"}},
        {"--shutter needs a --path", {"--shutter", "5ms", "-o", "a.pgm"}},
        {"--readout needs a --shutter",
         {"--map", "given/map.json", "--path", "given/way.csv", "--readout", "5ms", "-o", "a.y4m"}},
        {"--scene walk brings tapes", {"--scene", "walk", "--ids", "5", "-o", "a.y4m"}},
        {"--box and --furnished need a plan", {"--furnished", "yes", "-o", "a.pgm"}},
        {"same as the output", {"--truth", "a.pgm", "-o", "a.pgm"}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        options_answer answer = parse(cases[i].words);
        render_options_release(&all);
        if (answer != OPTIONS_WRONG || strstr(error.text, cases[i].told) == NULL)
            fail_msg("'%s' instead of '%s'", error.text, cases[i].told);
        assert_null(strchr(error.text, '\n'));
    }
}

static void there_are_not_too_many_things(void **state)
{
    (void)state;
    const char *words[WORDS_MAX + 1] = {"-o", "a.pgm"};
    for (size_t i = 0; i < 2 * RENDER_THINGS_MAX; i++)
        words[2 + i] = i % 2 == 0 ? "--ids" : "5";
    assert_parsed(words);
    assert_int_equal(all.thing_count, RENDER_THINGS_MAX);
    words[2 + 2 * RENDER_THINGS_MAX] = "--ids";
    words[3 + 2 * RENDER_THINGS_MAX] = "5";
    assert_int_equal(parse(words), OPTIONS_WRONG);
    assert_non_null(strstr(error.text, "more than 64 tapes and pictures"));
}

static void defaults_are_those_of_the_help(void **state)
{
    (void)state;
    assert_parsed((const char *const[]){"-o", "a.png", NULL});
    assert_int_equal(all.view.width_px, 640);
    assert_int_equal(all.view.height_px, 480);
    assert_true(all.view.camera.focal_px == 640);
    assert_int_equal(all.thing_count, 1);
    assert_int_equal(all.things[0].id_count, 3);
    assert_int_equal(all.things[0].ids[1], -8);
    assert_true(all.pose.px_per_module == 3);
    assert_int_equal(all.kind, RENDER_HEAD_ON);
    assert_string_equal(all.format->name, "PNG");
    assert_string_equal(all.output_path, "a.png");
    assert_parsed((const char *const[]){"a.y4m", NULL});
    assert_string_equal(all.format->name, "Y4M");
    assert_string_equal(all.output_path, "a.y4m");
}

static void distance_and_focal_length_give_the_size(void **state)
{
    (void)state;
    assert_parsed(
        (const char *const[]){"--distance", "2m", "--module", "10mm", "--focal", "800", "-o", "a.png", NULL});
    assert_true(all.pose.px_per_module > 3.999 && all.pose.px_per_module < 4.001);
    assert_parsed(
        (const char *const[]){"--distance", "50cm", "--module", "10mm", "--size", "320x240", "a.png", NULL});
    assert_true(all.pose.px_per_module > 6.399 && all.pose.px_per_module < 6.401);
}

static void pictures_have_names_with_colons(void **state)
{
    (void)state;
    assert_parsed((const char *const[]){"--picture", "a:b.png:60mm:7", "--picture", "12:6cm", "a.png", NULL});
    assert_string_equal(all.things[0].picture_path, "a:b.png");
    assert_true(all.things[0].height_m > 0.0599 && all.things[0].height_m < 0.0601);
    assert_true(all.things[0].modules == 7);
    assert_string_equal(all.things[1].picture_path, "12");
    assert_true(all.things[1].modules == 0);
    render_options_release(&all);
}

static void places_belong_to_what_is_before_them(void **state)
{
    (void)state;
    assert_parsed((const char *const[]){"--ids", "5", "--at", "1,2,0.5,90", "--ids", "6", "--at", "3,4,0,-90",
                                        "--camera", "1,2,1.5,45,-10,2", "a.png", NULL});
    assert_int_equal(all.kind, RENDER_ON_PLAN);
    assert_true(all.things[0].x_m == 1 && all.things[0].above_floor_m == 0.5 && all.things[0].facing_deg == 90);
    assert_true(all.things[1].y_m == 4 && all.things[1].above_floor_m == 0);
    assert_true(all.camera.heading_deg == 45 && all.camera.pitch_deg == -10 && all.camera.roll_deg == 2);
}

static void what_comes_behind_a_likeness_changes_it(void **state)
{
    (void)state;
    assert_parsed(
        (const char *const[]){"--like", "condition-a", "--defocus", "2", "--size", "1080x823", "a.png", NULL});
    assert_true(all.view.optics.defocus_px == 2);
    assert_true(all.view.sensor.shot_noise == 0);
    assert_true(all.focal_px > 1400 && all.focal_px < 1560);
}

static void help_and_version_win(void **state)
{
    (void)state;
    assert_int_equal(parse((const char *const[]){"--help", NULL}), OPTIONS_HELP);
    assert_int_equal(parse((const char *const[]){"--yaw", "5", "--version", NULL}), OPTIONS_VERSION);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_usage_is_told),
        cmocka_unit_test(there_are_not_too_many_things),
        cmocka_unit_test(defaults_are_those_of_the_help),
        cmocka_unit_test(distance_and_focal_length_give_the_size),
        cmocka_unit_test(pictures_have_names_with_colons),
        cmocka_unit_test(places_belong_to_what_is_before_them),
        cmocka_unit_test(what_comes_behind_a_likeness_changes_it),
        cmocka_unit_test(help_and_version_win),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
