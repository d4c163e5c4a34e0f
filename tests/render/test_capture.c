/* Files and camera formats, byte by byte. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "capture.h"
#include "opencv_media.h"

static const uint16_t four_by_two[8] = {0x3ff, 0x201, 0x102, 0x003, 10, 20, 30, 40};
static const uint16_t bytes_four_by_two[8] = {1, 2, 3, 4, 250, 6, 7, 8};

static uint8_t written[256];

/* What is written for one frame of 4 x 2 pixels, header included; how many bytes. */
static size_t capture_at(double fps, const char *name, const uint16_t *samples, size_t stride_bytes)
{
    const capture_format *format = capture_format_find(name);
    assert_non_null(format);
    FILE *file = tmpfile();
    assert_non_null(file);
    capture_write_header(file, format, 4, 2, fps);
    assert_true(capture_write_frame(file, format, samples, 4, 2, stride_bytes));
    rewind(file);
    size_t size = fread(written, 1, sizeof written, file);
    fclose(file);
    return size;
}

static size_t capture(const char *name, const uint16_t *samples, size_t stride_bytes)
{
    return capture_at(12, name, samples, stride_bytes);
}

static void assert_written(size_t size, const uint8_t *expected, size_t expected_size)
{
    assert_int_equal(size, expected_size);
    assert_memory_equal(written, expected, expected_size);
}

static void files_have_their_headers(void **state)
{
    (void)state;
    static const char pgm[] = "P5\n4 2\n255\n\1\2\3\4\372\6\7\10";
    static const char y4m[] = "YUV4MPEG2 W4 H2 F12:1 Ip A1:1 Cmono\nFRAME\n\1\2\3\4\372\6\7\10";
    assert_written(capture("pgm", bytes_four_by_two, 4), (const uint8_t *)pgm, sizeof pgm - 1);
    assert_written(capture("y4m", bytes_four_by_two, 4), (const uint8_t *)y4m, sizeof y4m - 1);
    static const char ntsc[] = "YUV4MPEG2 W4 H2 F29970:1000 Ip A1:1 Cmono\nFRAME\n\1\2\3\4\372\6\7\10";
    assert_written(capture_at(29.97, "y4m", bytes_four_by_two, 4), (const uint8_t *)ntsc, sizeof ntsc - 1);
}

static void a_png_comes_back_as_it_was(void **state)
{
    (void)state;
    gray_picture picture;
    error_text error;
    size_t size = capture("png", bytes_four_by_two, 4);
    assert_true(opencv_decode_still(written, size, &picture, &error));
    assert_int_equal(picture.width_px, 4);
    assert_int_equal(picture.height_px, 2);
    for (size_t i = 0; i < 8; i++)
        assert_int_equal(picture.pixels[i], bytes_four_by_two[i]);
    free(picture.pixels);
}

static void rows_are_as_long_as_the_stride(void **state)
{
    (void)state;
    static const uint8_t grey[] = {1, 2, 3, 4, 0, 0, 250, 6, 7, 8, 0, 0};
    assert_written(capture("GREY", bytes_four_by_two, 6), grey, sizeof grey);
}

static void ten_bits_lie_in_two_bytes_or_packed_in_five(void **state)
{
    (void)state;
    static const uint8_t loose[] = {0xff, 3, 1, 2, 2, 1, 3, 0, 10, 0, 20, 0, 30, 0, 40, 0};
    /* 0x3ff, 0x201, 0x102, 0x003: the low bits are 3, 1, 2, 3. */
    static const uint8_t packed[] = {0xff, 0x80, 0x40, 0x00, 0xe7, 0, 2, 5, 7, 10, 0x22, 0};
    assert_written(capture("Y10", four_by_two, 8), loose, sizeof loose);
    assert_written(capture("Y10P", four_by_two, 6), packed, sizeof packed);
}

static void luma_is_first_or_second_in_its_pair(void **state)
{
    (void)state;
    static const uint8_t yuyv[] = {1, 117, 2, 138, 3, 117, 4, 138, 250, 117, 6, 138, 7, 117, 8, 138};
    static const uint8_t uyvy[] = {117, 1, 138, 2, 117, 3, 138, 4, 117, 250, 138, 6, 117, 7, 138, 8};
    assert_written(capture("YUYV", bytes_four_by_two, 8), yuyv, sizeof yuyv);
    assert_written(capture("UYVY", bytes_four_by_two, 8), uyvy, sizeof uyvy);
}

static void chroma_follows_in_one_plane_or_two(void **state)
{
    (void)state;
    static const uint8_t nv12[] = {1, 2, 3, 4, 250, 6, 7, 8, 117, 138, 117, 138};
    static const uint8_t yu12[] = {1, 2, 3, 4, 250, 6, 7, 8, 117, 117, 138, 138};
    assert_written(capture("NV12", bytes_four_by_two, 4), nv12, sizeof nv12);
    assert_written(capture("YU12", bytes_four_by_two, 4), yu12, sizeof yu12);
}

static void bayer_colours_are_out_of_balance(void **state)
{
    (void)state;
    static const uint16_t gray[8] = {200, 200, 200, 200, 200, 200, 200, 200};
    static const uint8_t rggb[] = {117, 200, 117, 200, 200, 92, 200, 92};
    assert_written(capture("SRGGB8", gray, 4), rggb, sizeof rggb);
    static const uint8_t loose[] = {117, 0, 200, 0, 117, 0, 200, 0, 200, 0, 92, 0, 200, 0, 92, 0};
    assert_written(capture("SRGGB10", gray, 8), loose, sizeof loose);
    static const uint8_t packed[] = {29, 50, 29, 50, 0x11, 50, 23, 50, 23, 0};
    assert_written(capture("SRGGB10P", gray, 5), packed, sizeof packed);
}

static void every_named_format_is_known_and_no_other(void **state)
{
    (void)state;
    char names[256];
    size_t count = 0;
    strcpy(names, capture_format_names());
    for (char *name = strtok(names, " "); name != NULL; name = strtok(NULL, " "), count++)
        assert_string_equal(capture_format_find(name)->name, name);
    assert_int_equal(count, 13);
    assert_null(capture_format_find("Y10PP"));
    assert_null(capture_format_find("Y1"));
    assert_null(capture_format_find(""));
}

static void sizes_must_suit_the_format(void **state)
{
    (void)state;
    assert_true(capture_fits(capture_format_find("PGM"), 5, 3));
    assert_true(capture_fits(capture_format_find("Y10"), 5, 3));
    assert_false(capture_fits(capture_format_find("Y10P"), 6, 2));
    assert_true(capture_fits(capture_format_find("Y10P"), 8, 3));
    assert_false(capture_fits(capture_format_find("YUYV"), 5, 2));
    assert_true(capture_fits(capture_format_find("YUYV"), 6, 3));
    assert_false(capture_fits(capture_format_find("NV12"), 6, 3));
    assert_false(capture_fits(capture_format_find("SRGGB8"), 5, 2));
    assert_int_equal(capture_least_stride(capture_format_find("Y10P"), 8), 10);
    assert_int_equal(capture_least_stride(capture_format_find("YUYV"), 8), 16);
    assert_int_equal(capture_least_stride(capture_format_find("NV12"), 8), 8);
    assert_int_equal(capture_bits(capture_format_find("SRGGB10P")), 10);
    assert_int_equal(capture_bits(capture_format_find("NV12")), 8);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_have_their_headers),
        cmocka_unit_test(a_png_comes_back_as_it_was),
        cmocka_unit_test(rows_are_as_long_as_the_stride),
        cmocka_unit_test(ten_bits_lie_in_two_bytes_or_packed_in_five),
        cmocka_unit_test(luma_is_first_or_second_in_its_pair),
        cmocka_unit_test(chroma_follows_in_one_plane_or_two),
        cmocka_unit_test(bayer_colours_are_out_of_balance),
        cmocka_unit_test(every_named_format_is_known_and_no_other),
        cmocka_unit_test(sizes_must_suit_the_format),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
