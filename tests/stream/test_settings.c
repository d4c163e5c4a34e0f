/* The command line and the configuration file: what they set, and what they say when something is wrong. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

#include "config_file.h"
#include "stream_options.h"

enum { WORDS_MAX = 20 };

static stream_settings settings;
static error_text error;
static char path[] = "/tmp/tapemark-settings-XXXXXX";

static int make_file(void **state)
{
    (void)state;
    const int file = mkstemp(path);
    return file >= 0 ? close(file) : -1;
}

static int remove_file(void **state)
{
    (void)state;
    return unlink(path);
}

static void write_file(const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static options_answer read_words(const char *const *words)
{
    char *copies[WORDS_MAX] = {NULL};
    command_line line = {0, copies};
    copies[line.count++] = strdup("tapemark-stream");
    for (; words[line.count - 1] != NULL; line.count++)
        copies[line.count] = strdup(words[line.count - 1]);
    error.text[0] = '\0';
    const options_answer answer = stream_options_read(line, &settings, &error);
    for (int i = 0; i < line.count; i++)
        free(copies[i]);
    return answer;
}

#define READ(...) read_words((const char *const[]){__VA_ARGS__, NULL})

static void expect_refusal(const char *const *words, const char *text)
{
    assert_int_equal(read_words(words), OPTIONS_WRONG);
    assert_string_equal(error.text, text);
}

#define REFUSES(text, ...) expect_refusal((const char *const[]){__VA_ARGS__, NULL}, text)

/* ---- The command line ---------------------------------------------------------------------------------------- */

static void options_set_what_they_name(void **state)
{
    (void)state;
    assert_int_equal(READ("--camera", "v4l2:/dev/video2", "--serial=/dev/ttyAMA0:115200", "--encoding", "cobs",
                          "--exposure", "500", "--gain", "2.5", "--rate", "60", "--roi", "640x200+0+100"),
                     OPTIONS_RUN);
    assert_string_equal(settings.camera, "v4l2:/dev/video2");
    assert_string_equal(settings.output, "serial:/dev/ttyAMA0:115200");
    assert_int_equal(settings.encoding, TAPEMARK_PACKETS);
    const camera_wishes wishes = settings_camera_wishes(&settings);
    assert_int_equal(wishes.exposure_us, 500);
    assert_true(wishes.gain == 2.5 && wishes.rate_hz == 60 && wishes.format == NULL);
    assert_int_equal(settings.roi.width_px, 640);
    assert_int_equal(settings.roi.y_px, 100);
    assert_int_equal(READ("--format", "GREY", "--size", "1280x720", "--rate", "max", "--exposure", "auto", "--output",
                          "udp:localhost:9000", "--inverted", "yes", "--roll", "90"), OPTIONS_RUN);
    assert_string_equal(settings.format, "GREY");
    assert_int_equal(settings.width_px, 1280);
    assert_true(settings.rate_hz == rate_unlimited_hz);
    assert_int_equal(settings.decoder.polarity, TAPEMARK_LIGHT_ON_DARK);
    assert_true(settings.decoder.roll_known && settings.decoder.roll_deg == 90);
}

static void options_that_ask_are_told_apart(void **state)
{
    (void)state;
    assert_int_equal(READ("--list"), OPTIONS_LIST);
    assert_int_equal(READ("--help"), OPTIONS_HELP);
    assert_int_equal(READ("--version"), OPTIONS_VERSION);
    assert_int_equal(READ(NULL), OPTIONS_RUN);
    assert_string_equal(settings.camera, "auto");
    assert_string_equal(settings.output, "-");
}

static void wrong_options_are_named(void **state)
{
    (void)state;
    REFUSES("expected an option, not \"walk.y4m\"; --help lists them", "walk.y4m");
    REFUSES("there is no option \"--speed\"; --help lists them", "--speed", "9");
    REFUSES("there is no option \"--a-name-that-is-far-too-long-for-any-option\"; --help lists them",
            "--a-name-that-is-far-too-long-for-any-option");
    REFUSES("--list takes no value", "--list=all");
    REFUSES("--camera: needs a value", "--camera");
    REFUSES("--map: has no value", "--map=");
    REFUSES("--camera: expected auto, v4l2:DEVICE, libcamera:NUMBER, file:PATH[@RATE] or raw:LAYOUT,PATH[@RATE], not "
            "\"/dev/video0\"", "--camera", "/dev/video0");
    REFUSES("--output: /dev/ttyS0 is no output: it takes serial:DEVICE:BAUD, -, file:PATH, pty:PATH or "
            "udp:HOST:PORT", "--output", "/dev/ttyS0");
    REFUSES("--output: udp:example.org:1 is no address and port, such as udp:192.168.4.1:5005", "--output",
            "udp:example.org:1");
    REFUSES("--serial: serial:/dev/ttyS0:fast has no rate of 300 to 4000000 baud after the last colon", "--serial",
            "/dev/ttyS0:fast");
    REFUSES("--preview: expected PORT or HOST:PORT, with a number such as 0.0.0.0 for HOST, not \"99999\"",
            "--preview", "99999");
    REFUSES("--rate: expected a number from 0.1 to 6553.5, not \"0x1p3\"", "--rate", "0x1p3");
    REFUSES("--encoding: expected nmea or cobs, not \"json\"", "--encoding", "json");
    REFUSES("--roi: expected WIDTHxHEIGHT+X+Y in pixels or full, not \"10x10+1\"", "--roi", "10x10+1");
    REFUSES("--roi: expected WIDTHxHEIGHT+X+Y in pixels or full, not \"0x10+1+1\"", "--roi", "0x10+1+1");
    REFUSES("--roi: expected WIDTHxHEIGHT+X+Y in pixels or full, not \"10x10+1+99999999999999999999\"", "--roi",
            "10x10+1+99999999999999999999");
    REFUSES("--exposure: expected 1 to 10000000 or auto, not \"0\"", "--exposure", "0");
    REFUSES("--exposure: expected 1 to 10000000 or auto, not \"1e3\"", "--exposure", "1e3");
    REFUSES("--gain: expected a number from 0.01 to 655.35, not \"nan\"", "--gain", "nan");
    REFUSES("--rate: expected a number from 0.1 to 6553.5, not \"inf\"", "--rate", "inf");
    REFUSES("--size: expected WIDTHxHEIGHT, both 1 to 65535, not \"640\"", "--size", "640");
    REFUSES("--markers: expected a whole number from 1 to 100, not \"101\"", "--markers", "101");
    REFUSES("--repeat: expected yes or no, not \"maybe\"", "--repeat", "maybe");
    REFUSES("gpio-trigger needs snapshots, the directory for the frames that it saves", "--gpio-trigger", "0:1");
    REFUSES("snapshots needs gpio-trigger, the line that saves frames into it", "--snapshots", "/tmp");
}

static void values_that_are_too_long_are_refused(void **state)
{
    (void)state;
    char text[2000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    REFUSES("--map: is longer than 511 characters", "--map", text);
    REFUSES("--serial: is longer than 511 characters", "--serial", text);
    memcpy(text, "file:", 5);
    REFUSES("--output: is longer than 511 characters", "--output", text);
}

/* ---- The file ------------------------------------------------------------------------------------------------ */

static void expect_config(const char *text)
{
    write_file(text, strlen(text));
    assert_int_equal(READ("--config", path), OPTIONS_RUN);
    assert_string_equal(error.text, "");
}

static void expect_bad_bytes(const void *bytes, size_t size, const char *reason)
{
    char expected[600];
    write_file(bytes, size);
    assert_int_equal(READ("--config", path), OPTIONS_BAD_CONFIG);
    snprintf(expected, sizeof expected, "%s%s", path, reason);
    assert_string_equal(error.text, expected);
}

static void expect_bad_config(const char *text, const char *reason)
{
    expect_bad_bytes(text, strlen(text), reason);
}

static void file_sets_what_it_names(void **state)
{
    (void)state;
    expect_config("# where it is\r\n\r\n  camera =\tlibcamera:0  \r\nserial = /dev/ttyAMA0:921600\nencoding=cobs");
    assert_string_equal(settings.camera, "libcamera:0");
    assert_string_equal(settings.output, "serial:/dev/ttyAMA0:921600");
    assert_int_equal(settings.encoding, TAPEMARK_PACKETS);
    expect_config("");
    assert_string_equal(settings.camera, "auto");
}

static void command_line_goes_before_the_file(void **state)
{
    (void)state;
    const char *text = "rate = 30\nexposure = 500\n";
    write_file(text, strlen(text));
    assert_int_equal(READ("--rate", "60", "--config", path), OPTIONS_RUN);
    assert_true(settings.rate_hz == 60);
    assert_int_equal(settings.exposure_us, 500);
}

static void wrong_lines_are_named(void **state)
{
    (void)state;
    expect_bad_config("rate = 30\n\nencoding = morse\n", ": line 3: encoding: expected nmea or cobs, not \"morse\"");
    expect_bad_config("speed = 9\n", ": line 1: speed: there is no setting of this name; --help lists them");
    expect_bad_config("config = x\n", ": line 1: config: there is no setting of this name; --help lists them");
    expect_bad_config("rate 30\n", ": line 1: expected \"name = value\", not \"rate 30\"");
    expect_bad_config("rate =\n", ": line 1: rate: has no value");
    expect_bad_config("rate = 30\nrate = 60\n", ": line 2: rate: was set in line 1 already");
    expect_bad_config("output = -\nserial = /dev/ttyS0\n", ": line 2: serial: was set in line 1 already");
    expect_bad_bytes("rate\0= 30\n", 10, ": is no text: it holds bytes of 0");
    expect_bad_config("gpio-trigger = 0:5\n",
                      ": gpio-trigger needs snapshots, the directory for the frames that it saves");
}

static void file_that_cannot_be_read_is_named(void **state)
{
    (void)state;
    assert_int_equal(READ("--config", "/nowhere/stream.conf"), OPTIONS_BAD_CONFIG);
    assert_string_equal(error.text, "/nowhere/stream.conf: cannot be opened: No such file or directory");
    const size_t size = 2000000;
    char *large = malloc(size);
    assert_non_null(large);
    memset(large, '\n', size);
    expect_bad_bytes(large, size, ": is larger than 1 MB");
    free(large);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_set_what_they_name),
        cmocka_unit_test(options_that_ask_are_told_apart),
        cmocka_unit_test(wrong_options_are_named),
        cmocka_unit_test(values_that_are_too_long_are_refused),
        cmocka_unit_test(file_sets_what_it_names),
        cmocka_unit_test(command_line_goes_before_the_file),
        cmocka_unit_test(wrong_lines_are_named),
        cmocka_unit_test(file_that_cannot_be_read_is_named),
    };
    return cmocka_run_group_tests(tests, make_file, remove_file);
}
