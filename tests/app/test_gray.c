/* Layouts of raw frames, and every pixel format to gray: bytes typed in after the descriptions of the formats in
 * the Linux kernel's media documentation. */
#include "test_main.h"

#include "gray.h"

static void expect_gray(pixel_format format, int32_t width_px, int32_t height_px, size_t stride_bytes,
                        const uint8_t *data, const uint8_t *expected)
{
    gray_converter converter = {0};
    gray_view view;
    error_text error;
    frame input = {{format, width_px, height_px, stride_bytes}, data, 0, FRAME_TIME_UNKNOWN};

    assert_true(gray_from_frame(&converter, &input, &view, &error));
    assert_int_equal(view.width_px, width_px);
    assert_int_equal(view.height_px, height_px);
    for (int32_t y = 0; y < height_px; y++)
        assert_memory_equal(view.pixels + y * view.stride_bytes, expected + y * width_px, (size_t)width_px);
    gray_converter_release(&converter);
}

/* ---- Formats whose luma is looked at in place ---------------------------------------------------------------- */

static void luma_planes_are_not_copied(void **state)
{
    static const pixel_format formats[] = {PIXEL_GREY, PIXEL_NV12, PIXEL_YU12};
    static const uint8_t data[64] = {1, 2, 3};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(formats); i++) {
        gray_converter converter = {0};
        gray_view view;
        error_text error;
        frame input = {{formats[i], 5, 4, 7}, data, 0, FRAME_TIME_UNKNOWN};
        assert_true(gray_from_frame(&converter, &input, &view, &error));
        assert_ptr_equal(view.pixels, data);
        assert_int_equal(view.stride_bytes, 7);
        assert_null(converter.pixels);
    }
}

/* ---- Deeper and packed samples ------------------------------------------------------------------------------- */

static void y10_keeps_the_upper_eight_of_ten_bits(void **state)
{
    /* 0, 3, 4, 512, 1023, and one beyond ten bits; two rows with one byte pair of padding. */
    static const uint8_t data[] = {0x00, 0x00, 0x03, 0x00, 0x04, 0x00, 0xaa, 0xaa,
                                   0x00, 0x02, 0xff, 0x03, 0x00, 0x04, 0xaa, 0xaa};
    static const uint8_t expected[] = {0, 0, 1, 128, 255, 255};
    (void)state;
    expect_gray(PIXEL_Y10, 3, 2, 8, data, expected);
}

static void y12_and_y16_keep_the_upper_eight_bits(void **state)
{
    static const uint8_t twelve[] = {0x0f, 0x00, 0x10, 0x00, 0xff, 0x0f, 0x00, 0x10};
    static const uint8_t sixteen[] = {0xff, 0x00, 0x00, 0x01, 0xff, 0xff, 0x34, 0x12};
    static const uint8_t from_twelve[] = {0, 1, 255, 255}, from_sixteen[] = {0, 1, 255, 0x12};
    (void)state;
    expect_gray(PIXEL_Y12, 4, 1, 8, twelve, from_twelve);
    expect_gray(PIXEL_Y16, 4, 1, 8, sixteen, from_sixteen);
}

static void y10p_skips_the_byte_of_low_bits(void **state)
{
    /* Six pixels in two groups of five bytes; the padding of the second group and of the row is 0xee. */
    static const uint8_t data[] = {10, 20, 30, 40, 0xff, 50, 60, 0xee, 0xee, 0xff, 0xee,
                                   11, 21, 31, 41, 0x00, 51, 61, 0xee, 0xee, 0x00, 0xee};
    static const uint8_t expected[] = {10, 20, 30, 40, 50, 60, 11, 21, 31, 41, 51, 61};
    (void)state;
    expect_gray(PIXEL_Y10P, 6, 2, 11, data, expected);
}

static void yuyv_and_uyvy_of_odd_width(void **state)
{
    static const uint8_t yuyv[] = {1, 91, 2, 92, 3, 93, 4, 94, 5, 91, 6, 92, 7, 93, 8, 94};
    static const uint8_t uyvy[] = {91, 1, 92, 2, 93, 3, 94, 4, 91, 5, 92, 6, 93, 7, 94, 8};
    static const uint8_t expected[] = {1, 2, 3, 5, 6, 7};
    (void)state;
    expect_gray(PIXEL_YUYV, 3, 2, 8, yuyv, expected);
    expect_gray(PIXEL_UYVY, 3, 2, 8, uyvy, expected);
}

/* ---- Bayer --------------------------------------------------------------------------------------------------- */

enum { SIDE_PX = 6 };

/* Colour of a pixel after the order of the first four in the format's name. */
static char bayer_colour(pixel_format format, int x, int y)
{
    return pixel_format_describe(format)->name[1 + 2 * (y % 2) + x % 2];
}

static void bayer_of_one_colour_is_flat_gray(void **state)
{
    static const pixel_format formats[] = {PIXEL_SRGGB8, PIXEL_SGRBG8, PIXEL_SGBRG8, PIXEL_SBGGR8};
    uint8_t data[SIDE_PX * SIDE_PX], expected[SIDE_PX * SIDE_PX];
    (void)state;
    memset(expected, (40 + 2 * 100 + 180) / 4, sizeof expected);
    for (size_t i = 0; i < COUNT_OF(formats); i++) {
        for (int y = 0; y < SIDE_PX; y++)
            for (int x = 0; x < SIDE_PX; x++) {
                char colour = bayer_colour(formats[i], x, y);
                data[y * SIDE_PX + x] = colour == 'R' ? 40 : colour == 'G' ? 100 : 180;
            }
        expect_gray(formats[i], SIDE_PX, SIDE_PX, SIDE_PX, data, expected);
    }
}

static void bayer_spreads_a_bright_pixel_over_nine(void **state)
{
    static const uint8_t inside[25] = {[12] = 160};
    static const uint8_t spread[25] = {0, 0,  0,  0,  0, 0, 10, 20, 10, 0, 0, 20, 40,
                                       20, 0, 0, 10, 20, 10, 0, 0, 0,  0,  0,  0};
    /* Beside the border the pixel counts a second time, mirrored. */
    static const uint8_t second[9] = {0, 0, 0, 0, 160, 0, 0, 0, 0};
    static const uint8_t mirrored[9] = {40, 40, 40, 40, 40, 40, 40, 40, 40};
    (void)state;
    expect_gray(PIXEL_SRGGB8, 5, 5, 5, inside, spread);
    expect_gray(PIXEL_SRGGB8, 3, 3, 3, second, mirrored);
}

static void bayer_of_a_single_row_or_column(void **state)
{
    static const uint8_t data[] = {80, 80, 80, 80};
    (void)state;
    expect_gray(PIXEL_SBGGR8, 4, 1, 4, data, data);
    expect_gray(PIXEL_SBGGR8, 1, 4, 1, data, data);
    expect_gray(PIXEL_SBGGR8, 1, 1, 1, data, data);
}

/* All pixels alike: (66 + 2) / 4 = 17, but (65 + 2) / 4 = 16; the low two bits are what tells them apart. */
static void bayer_of_ten_bits_rounds(void **state)
{
    static const uint8_t wide[] = {66, 0, 66, 0, 66, 0, 66, 0}, lower[] = {65, 0, 65, 0, 65, 0, 65, 0};
    static const uint8_t packed[] = {16, 16, 16, 16, 0xaa}, packed_lower[] = {16, 16, 16, 16, 0x55};
    static const uint8_t expected[] = {17, 17, 17, 17}, expected_lower[] = {16, 16, 16, 16};
    (void)state;
    expect_gray(PIXEL_SRGGB10, 4, 1, 8, wide, expected);
    expect_gray(PIXEL_SRGGB10, 4, 1, 8, lower, expected_lower);
    expect_gray(PIXEL_SRGGB10P, 4, 1, 5, packed, expected);
    expect_gray(PIXEL_SRGGB10P, 4, 1, 5, packed_lower, expected_lower);
}

static void bayer_samples_beyond_ten_bits_are_white(void **state)
{
    /* 0x0fff in the middle of nothing: 4 * 1023 / 64. */
    static const uint8_t data[18] = {[8] = 0xff, [9] = 0x0f};
    static const uint8_t expected[9] = {64, 64, 64, 64, 64, 64, 64, 64, 64};
    (void)state;
    expect_gray(PIXEL_SGBRG10, 3, 3, 6, data, expected);
}

/* The packed form is put together here as the kernel's documentation draws it: four bytes of upper bits, then a
 * byte with the lower bits, the first pixel's in bits 1 and 0. */
static void packed_bayer_equals_unpacked(void **state)
{
    enum { WIDTH_PX = 7, HEIGHT_PX = 5, PACKED_STRIDE = 10 };
    uint8_t wide[WIDTH_PX * HEIGHT_PX * 2], packed[PACKED_STRIDE * HEIGHT_PX] = {0};
    gray_converter converter = {0};
    gray_view view;
    error_text error;
    unsigned random = 12345;
    (void)state;
    for (unsigned y = 0; y < HEIGHT_PX; y++)
        for (unsigned x = 0; x < WIDTH_PX; x++) {
            random = random * 1103515245u + 12345u;
            unsigned sample = random >> 16 & 1023u;
            uint8_t *group = packed + y * PACKED_STRIDE + x / 4 * 5;
            wide[2 * (y * WIDTH_PX + x)] = (uint8_t)(sample & 0xff);
            wide[2 * (y * WIDTH_PX + x) + 1] = (uint8_t)(sample >> 8);
            group[x % 4] = (uint8_t)(sample >> 2);
            group[4] |= (uint8_t)((sample & 3u) << (2 * (x % 4)));
        }
    frame unpacked = {{PIXEL_SGRBG10, WIDTH_PX, HEIGHT_PX, 2 * WIDTH_PX}, wide, 0, FRAME_TIME_UNKNOWN};
    assert_true(gray_from_frame(&converter, &unpacked, &view, &error));
    expect_gray(PIXEL_SGRBG10P, WIDTH_PX, HEIGHT_PX, PACKED_STRIDE, packed, view.pixels);
    gray_converter_release(&converter);
}

static void converter_serves_frames_of_any_size_in_turn(void **state)
{
    static const int32_t sides[] = {3, 40, 2, 17};
    gray_converter converter = {0};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(sides); i++) {
        size_t size = (size_t)(4 * sides[i] * sides[i]);
        uint8_t *data = malloc(size);
        gray_view view;
        error_text error;
        memset(data, (int)i + 1, size);
        frame yuyv = {{PIXEL_YUYV, sides[i], sides[i], (size_t)(4 * sides[i])}, data, 0, FRAME_TIME_UNKNOWN};
        frame bayer = {{PIXEL_SRGGB8, sides[i], sides[i], (size_t)sides[i]}, data, 0, FRAME_TIME_UNKNOWN};
        assert_true(gray_from_frame(&converter, &yuyv, &view, &error));
        assert_int_equal(view.pixels[sides[i] * sides[i] - 1], i + 1);
        assert_true(gray_from_frame(&converter, &bayer, &view, &error));
        assert_int_equal(view.pixels[sides[i] * sides[i] - 1], i + 1);
        free(data);
    }
    gray_converter_release(&converter);
}

/* ---- Layouts ------------------------------------------------------------------------------------------------- */

static void layouts_are_understood(void **state)
{
    static const struct {
        const char *text;
        frame_layout layout;
        size_t size_bytes;
    } cases[] = {
        {"GREY:640x480", {PIXEL_GREY, 640, 480, 640}, 307200},
        {"grey:640X480:704", {PIXEL_GREY, 640, 480, 704}, 337920},
        {"Y10:3x2", {PIXEL_Y10, 3, 2, 6}, 12},
        {"Y10P:5x2", {PIXEL_Y10P, 5, 2, 10}, 20},
        {"YUYV:3x2", {PIXEL_YUYV, 3, 2, 8}, 16},
        {"NV12:4x4", {PIXEL_NV12, 4, 4, 4}, 24},
        {"NV12:5x3", {PIXEL_NV12, 5, 3, 5}, 15 + 2 * 6},
        {"YU12:5x3", {PIXEL_YU12, 5, 3, 5}, 15 + 2 * 2 * 3},
        {"YU12:4x2:8", {PIXEL_YU12, 4, 2, 8}, 16 + 2 * 4},
        {"SGBRG10P:8x1:16", {PIXEL_SGBRG10P, 8, 1, 16}, 16},
        {"SBGGR8:32768x32768", {PIXEL_SBGGR8, 32768, 32768, 32768}, 1 << 30},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        frame_layout layout;
        error_text error;
        assert_true(frame_layout_parse(cases[i].text, &layout, &error));
        assert_int_equal(layout.format, cases[i].layout.format);
        assert_int_equal(layout.width_px, cases[i].layout.width_px);
        assert_int_equal(layout.height_px, cases[i].layout.height_px);
        assert_int_equal(layout.stride_bytes, cases[i].layout.stride_bytes);
        assert_int_equal(frame_layout_size_bytes(&layout), cases[i].size_bytes);
    }
}

static void wrong_layouts_are_refused(void **state)
{
    static const struct {
        const char *text;
        const char *reason;
    } cases[] = {
        {"", "unknown pixel format ''"},
        {"GREYISH:4x4", "unknown pixel format 'GREYISH'"},
        {"Y8:4x4", "Y10P"},  /* the formats there are get listed */
        {"GREY", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY:640", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY:640x480x3", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY:-640x480", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY: 640x480", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY:0x480", "1 to 65535"},
        {"GREY:65536x480", "1 to 65535"},
        {"GREY:4x99999999999999999999", "expected FORMAT:WIDTHxHEIGHT"},
        {"GREY:640x480:639", "from 640 to"},
        {"Y10P:640x480:799", "from 800 to"},
        {"GREY:640x480:", "from 640 to"},
        {"GREY:640x480:99999999", "from 640 to"},
        {"GREY:640x480:700b", "from 640 to"},
        {"GREY:32768x32769", "too large: at most 1024 MiB"},
        {"NV12:32768x32768", "too large: at most 1024 MiB"},
        {"SBGGR8:65535x65535", "too large: at most 1024 MiB"},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        frame_layout layout;
        error_text error = {""};
        assert_false(frame_layout_parse(cases[i].text, &layout, &error));
        assert_non_null(strstr(error.text, cases[i].reason));
    }
}

static void impossible_layouts_have_no_size(void **state)
{
    static const frame_layout layouts[] = {
        {PIXEL_GREY, 0, 1, 1},
        {PIXEL_GREY, 1, 0, 1},
        {PIXEL_GREY, 65536, 1, 65536},
        {PIXEL_GREY, 4, 4, 3},
        {PIXEL_Y16, 4, 4, 7},
        {PIXEL_GREY, 4, 4, SIZE_MAX},
        {PIXEL_Y16, 65535, 8193, 131070},
        {PIXEL_FORMAT_COUNT, 4, 4, 4},
    };
    (void)state;
    for (size_t i = 0; i < COUNT_OF(layouts); i++)
        assert_int_equal(frame_layout_size_bytes(&layouts[i]), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(luma_planes_are_not_copied),
        cmocka_unit_test(y10_keeps_the_upper_eight_of_ten_bits),
        cmocka_unit_test(y12_and_y16_keep_the_upper_eight_bits),
        cmocka_unit_test(y10p_skips_the_byte_of_low_bits),
        cmocka_unit_test(yuyv_and_uyvy_of_odd_width),
        cmocka_unit_test(bayer_of_one_colour_is_flat_gray),
        cmocka_unit_test(bayer_spreads_a_bright_pixel_over_nine),
        cmocka_unit_test(bayer_of_a_single_row_or_column),
        cmocka_unit_test(bayer_of_ten_bits_rounds),
        cmocka_unit_test(bayer_samples_beyond_ten_bits_are_white),
        cmocka_unit_test(packed_bayer_equals_unpacked),
        cmocka_unit_test(converter_serves_frames_of_any_size_in_turn),
        cmocka_unit_test(layouts_are_understood),
        cmocka_unit_test(wrong_layouts_are_refused),
        cmocka_unit_test(impossible_layouts_have_no_size),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
