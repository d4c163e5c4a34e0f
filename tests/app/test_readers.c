/* The readers of PGM, Y4M and headerless captures, on files typed in below. */
#include "test_main.h"

#include "gray.h"

#define LITERAL(text) (text), sizeof(text) - 1

typedef struct expected_frame {
    int32_t width_px;
    int32_t height_px;
    const uint8_t *gray;
} expected_frame;

/* Reads the next frame and compares it. */
static void expect_frame(frame_source *source, uint64_t number, const expected_frame *expected)
{
    gray_converter converter = {0};
    gray_view view;
    frame output;
    error_text error = {""};
    frame_status status = frame_source_next(source, &output, &error);
    assert_string_equal(error.text, "");
    assert_int_equal(status, FRAME_READY);
    assert_int_equal(output.sequence, number);
    assert_true(gray_from_frame(&converter, &output, &view, &error));
    assert_int_equal(view.width_px, expected->width_px);
    assert_int_equal(view.height_px, expected->height_px);
    for (int32_t y = 0; y < view.height_px; y++)
        assert_memory_equal(view.pixels + y * view.stride_bytes, expected->gray + y * view.width_px,
                            (size_t)view.width_px);
    gray_converter_release(&converter);
}

/* The frames, and then the end or, with a reason, a failure. */
static void expect_content(const void *bytes, size_t size, const frame_layout *raw, const expected_frame *frames,
                           size_t count, const char *reason)
{
    frame output;
    error_text error;
    frame_source *source = open_content(bytes, size, raw, &error);
    assert_string_equal(error.text, "");
    assert_non_null(source);
    for (size_t i = 0; i < count; i++)
        expect_frame(source, i, &frames[i]);
    frame_status status = frame_source_next(source, &output, &error);
    if (reason == NULL) {
        assert_int_equal(status, FRAME_END);
    } else {
        assert_int_equal(status, FRAME_FAILED);
        assert_non_null(strstr(error.text, reason));
    }
    frame_source_close(source);
}

static void expect_refusal(const void *bytes, size_t size, const frame_layout *raw, const char *reason)
{
    error_text error;
    assert_null(open_content(bytes, size, raw, &error));
    assert_non_null(strstr(error.text, reason));
}

/* A source that was cut after `size` bytes: whole frames come out as before; then comes the end, if the cut is
 * where one of them ends, else a failure with a text. Closes the source. */
static void expect_cut(frame_source *source, error_text *error, size_t size, const expected_frame *frames,
                       const size_t *frame_ends, size_t count)
{
    frame output;
    size_t whole = 0;
    while (whole < count && frame_ends[whole + 1] <= size)
        whole++;
    if (source == NULL) {
        assert_int_equal(whole, 0);
        assert_true(strlen(error->text) > 0);
        return;
    }
    for (size_t i = 0; i < whole; i++)
        expect_frame(source, i, &frames[i]);
    frame_status status = frame_source_next(source, &output, error);
    assert_int_equal(status, whole > 0 && size == frame_ends[whole] ? FRAME_END : FRAME_FAILED);
    if (status == FRAME_FAILED)
        assert_true(strlen(error->text) > 0);
    frame_source_close(source);
}

/* Cuts a good file, and a pipe with the same content, after every byte. `frame_ends` are the places where frames
 * end, the end of the header first. */
static void try_all_cuts(const uint8_t *bytes, const frame_layout *raw, const expected_frame *frames,
                         const size_t *frame_ends, size_t count)
{
    for (size_t size = 1; size <= frame_ends[count]; size++) {
        error_text error;
        expect_cut(open_content(bytes, size, raw, &error), &error, size, frames, frame_ends, count);
        expect_cut(open_piped_content(bytes, size, raw, &error), &error, size, frames, frame_ends, count);
    }
}

/* ---- PGM ----------------------------------------------------------------------------------------------------- */

static const uint8_t six[] = {0, 1, 2, 253, 254, 255};

static void pgm_of_8_bits(void **state)
{
    const expected_frame frames[] = {{3, 2, six}};
    (void)state;
    expect_content(LITERAL("P5\n3 2\n255\n\x00\x01\x02\xfd\xfe\xff"), NULL, frames, 1, NULL);
    expect_content(LITERAL("P5 3\t2\r255 \x00\x01\x02\xfd\xfe\xff\n"), NULL, frames, 1, NULL);
}

static void pgm_with_comments(void **state)
{
    const expected_frame frames[] = {{3, 2, six}};
    (void)state;
    expect_content(LITERAL("P5# by hand\n# 9 9 9\n3# wide\n#\n 2 #high\n255#most\n\x00\x01\x02\xfd\xfe\xff"), NULL,
                   frames, 1, NULL);
}

static void pgm_is_scaled_from_its_maximum(void **state)
{
    static const uint8_t from_15[] = {0, 17, 136, 255, 255};
    static const uint8_t from_1023[] = {0, 128, 255, 64};
    static const uint8_t from_65535[] = {0, 1, 255};
    const expected_frame narrow[] = {{5, 1, from_15}}, ten[] = {{4, 1, from_1023}}, wide[] = {{3, 1, from_65535}};
    (void)state;
    expect_content(LITERAL("P5 5 1 15\n\x00\x01\x08\x0f\x10"), NULL, narrow, 1, NULL);
    /* Two bytes, the upper one first: 0, 512, 1023 and 256, of which 63.8 is left. */
    expect_content(LITERAL("P5 4 1 1023\n\x00\x00\x02\x00\x03\xff\x01\x00"), NULL, ten, 1, NULL);
    expect_content(LITERAL("P5 3 1 65535\n\x00\x00\x01\x01\xff\xff"), NULL, wide, 1, NULL);
}

static void plain_pgm(void **state)
{
    static const uint8_t values[] = {0, 51, 255, 255};
    const expected_frame frames[] = {{2, 2, values}};
    (void)state;
    expect_content(LITERAL("P2\n# plain\n2 2\n5\n0 1\n5 # last\n7"), NULL, frames, 1, NULL);
    expect_content(LITERAL("P2 2 2 5 0 1 5"), NULL, NULL, 0, "cut short");
    expect_content(LITERAL("P2 2 2 5 0 1 5 x"), NULL, NULL, 0, "damaged");
}

static void pgms_one_after_the_other(void **state)
{
    static const uint8_t first[] = {1, 2}, second[] = {3, 4, 5}, third[] = {255};
    const expected_frame frames[] = {{2, 1, first}, {1, 3, second}, {1, 1, third}};
    (void)state;
    expect_content(LITERAL("P5 2 1 255\n\x01\x02P5 1 3 255\n\x03\x04\x05\nP2 1 1 9 9\n"), NULL, frames, 3, NULL);
    expect_content(LITERAL("P5 2 1 255\n\x01\x02P6 1 1 255\nabc"), NULL, frames, 1, "no PGM");
    expect_content(LITERAL("P5 2 1 255\n\x01\x02\x01\x02"), NULL, frames, 1, "no PGM");
}

static void pgm_cut_anywhere(void **state)
{
    static const uint8_t bytes[] = "P5 2 1 255\n\x01\x02P5 1 2 1023\n\x03\xff\x00\x00";
    static const uint8_t first[] = {1, 2}, second[] = {255, 0};
    static const size_t frame_ends[] = {0, 13, 29};
    const expected_frame frames[] = {{2, 1, first}, {1, 2, second}};
    (void)state;
    assert_int_equal(sizeof bytes - 1, 29);
    try_all_cuts(bytes, NULL, frames, frame_ends, 2);
}

static void wrong_pgm_headers(void **state)
{
    (void)state;
    expect_content(LITERAL("P5 0 2 255\n"), NULL, NULL, 0, "side outside 1 to 65535");
    expect_content(LITERAL("P5 65536 2 255\n"), NULL, NULL, 0, "side outside 1 to 65535");
    expect_content(LITERAL("P5 3 4294967297 255\nabc"), NULL, NULL, 0, "side outside 1 to 65535");
    expect_content(LITERAL("P5 3 2 0\n123456"), NULL, NULL, 0, "maximum value outside 1 to 65535");
    expect_content(LITERAL("P5 3 2 65536\n123456"), NULL, NULL, 0, "maximum value outside 1 to 65535");
    expect_content(LITERAL("P5 -3 2 255\n123456"), NULL, NULL, 0, "header of frame 0 is damaged");
    expect_content(LITERAL("P5 3 2 255x123456"), NULL, NULL, 0, "header of frame 0 is damaged");
    /* Four gigabytes are claimed and three bytes are there. */
    expect_content(LITERAL("P5 65535 16384 255\nabc"), NULL, NULL, 0, "needs 1073725440 bytes, and 3 are left");
    expect_content(LITERAL("P5 65535 65535 255\nabc"), NULL, NULL, 0, "65535 x 65535 px, is too large: at most 1024");
}

/* ---- Y4M ----------------------------------------------------------------------------------------------------- */

static void y4m_of_each_chroma_scheme(void **state)
{
    /* 3 x 3 px of luma, then as much chroma as the scheme has: 2 x 2 twice, 2 x 3 twice, … */
    static const struct {
        const char *colour;
        size_t chroma_bytes;
    } cases[] = {
        {"", 8}, {" C420", 8}, {" C420jpeg", 8}, {" C420mpeg2", 8}, {" C420paldv", 8}, {" Cmono", 0},
        {" C422", 12}, {" C444", 18}, {" C444alpha", 27}, {" C411", 6},
    };
    static const uint8_t luma[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    const expected_frame frames[] = {{3, 3, luma}, {3, 3, luma}};
    (void)state;
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        uint8_t bytes[256];
        size_t size = (size_t)snprintf((char *)bytes, sizeof bytes, "YUV4MPEG2 W3 H3 F25:1 Ip A1:1%s XNOTE=1\n",
                                       cases[i].colour);
        for (int k = 0; k < 2; k++) {
            memcpy(bytes + size, k == 0 ? "FRAME\n" : "FRAME Xq\n", k == 0 ? 6 : 9);
            size += k == 0 ? 6 : 9;
            memcpy(bytes + size, luma, sizeof luma);
            memset(bytes + size + sizeof luma, 0xcc, cases[i].chroma_bytes);
            size += sizeof luma + cases[i].chroma_bytes;
        }
        expect_content(bytes, size, NULL, frames, 2, NULL);
        expect_content(bytes, size - 1, NULL, frames, 1, "cut short");
    }
}

static void y4m_of_more_bits(void **state)
{
    static const uint8_t from_10[] = {128, 255}, from_12[] = {128, 1}, from_16[] = {128, 1};
    const expected_frame ten[] = {{2, 1, from_10}}, twelve[] = {{2, 1, from_12}}, sixteen[] = {{2, 1, from_16}};
    (void)state;
    expect_content(LITERAL("YUV4MPEG2 W2 H1 C420p10\nFRAME\n\x00\x02\xff\x03****"), NULL, ten, 1, NULL);
    expect_content(LITERAL("YUV4MPEG2 W2 H1 Cmono10\nFRAME\n\x00\x02\xff\x03"), NULL, ten, 1, NULL);
    expect_content(LITERAL("YUV4MPEG2 W2 H1 C422p12\nFRAME\n\x00\x08\x10\x00****"), NULL, twelve, 1, NULL);
    expect_content(LITERAL("YUV4MPEG2 W2 H1 Cmono16\nFRAME\n\x00\x80\x00\x01"), NULL, sixteen, 1, NULL);
}

/* Larger than what is read ahead, so that the reader jumps. */
static void y4m_with_large_chroma(void **state)
{
    enum { SIDE_PX = 400, LUMA_BYTES = SIDE_PX * SIDE_PX, FRAME_BYTES = 3 * LUMA_BYTES };
    static const char header[] = "YUV4MPEG2 W400 H400 C444\n";
    static uint8_t bytes[sizeof header - 1 + 2 * (6 + FRAME_BYTES)];
    uint8_t *frame_header = bytes + sizeof header - 1;
    (void)state;
    memcpy(bytes, header, sizeof header - 1);
    for (int i = 0; i < 2; i++, frame_header += 6 + FRAME_BYTES) {
        memcpy(frame_header, "FRAME\n", 6);
        memset(frame_header + 6, 10 + i, LUMA_BYTES);
        memset(frame_header + 6 + LUMA_BYTES, 99, FRAME_BYTES - LUMA_BYTES);
    }
    const uint8_t *luma = bytes + sizeof header - 1 + 6;
    const expected_frame frames[] = {{SIDE_PX, SIDE_PX, luma}, {SIDE_PX, SIDE_PX, luma + FRAME_BYTES + 6}};
    expect_content(bytes, sizeof bytes, NULL, frames, 2, NULL);
    expect_content(bytes, sizeof bytes - 1, NULL, frames, 1, "frame 1 needs 480000 bytes, and 479999 are left");
}

static void y4m_cut_anywhere(void **state)
{
    static const uint8_t bytes[] = "YUV4MPEG2 W2 H2 C420\nFRAME\nabcduvFRAME\nefghuv";
    static const size_t frame_ends[] = {21, 33, 45};
    const expected_frame frames[] = {{2, 2, (const uint8_t *)"abcd"}, {2, 2, (const uint8_t *)"efgh"}};
    (void)state;
    assert_int_equal(sizeof bytes - 1, 45);
    try_all_cuts(bytes, NULL, frames, frame_ends, 2);
}

static void y4m_frames_have_times(void **state)
{
    static const uint8_t bytes[] = "YUV4MPEG2 W1 H1 F30000:1001 Cmono\nFRAME\naFRAME\nbFRAME\nc";
    frame output;
    error_text error;
    (void)state;
    frame_source *source = open_content(bytes, sizeof bytes - 1, NULL, &error);
    assert_non_null(source);
    for (int64_t i = 0; i < 3; i++) {
        assert_int_equal(frame_source_next(source, &output, &error), FRAME_READY);
        assert_int_equal(output.time_ns, (i * 100100000 + 1) / 3);
    }
    frame_source_close(source);

    source = open_content(LITERAL("YUV4MPEG2 W1 H1 F0:0 Cmono\nFRAME\na"), NULL, &error);
    assert_int_equal(frame_source_next(source, &output, &error), FRAME_READY);
    assert_true(output.time_ns == FRAME_TIME_UNKNOWN);
    frame_source_close(source);
}

static void y4m_that_cannot_be_read(void **state)
{
    char endless[2000];
    (void)state;
    expect_refusal(LITERAL("YUV4MPEG2 W2 H2 It\nFRAME\nabcduv"), NULL, "interlaced");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H2 Im\nFRAME\nabcduv"), NULL, "interlaced");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H2 C410\nFRAME\nabcduv"), NULL, "colour space '410'");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H2 C420p9\nFRAME\nabcduv"), NULL, "colour space '420p9'");
    expect_refusal(LITERAL("YUV4MPEG2 H2\nFRAME\nabcduv"), NULL, "lacks the width");
    expect_refusal(LITERAL("YUV4MPEG2 W2\nFRAME\nabcduv"), NULL, "lacks the width (W) or the height");
    expect_refusal(LITERAL("YUV4MPEG2 W0 H2\n"), NULL, "side of '0'");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H65536\n"), NULL, "side of '65536'");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H-2\n"), NULL, "side of '-2'");
    expect_refusal(LITERAL("YUV4MPEG2 W2 H2"), NULL, "header is damaged or cut short");
    memset(endless, 'X', sizeof endless);
    memcpy(endless, "YUV4MPEG2 ", 10);
    expect_refusal(endless, sizeof endless, NULL, "header is damaged");
    expect_content(LITERAL("YUV4MPEG2 W2 H2\nFRAMED\nabcduv"), NULL, NULL, 0, "header of frame 0 is damaged");
    expect_content(LITERAL("YUV4MPEG2 W65535 H16384\nFRAME\nabcduv"), NULL, NULL, 0, "cut short: frame 0 needs");
    expect_refusal(LITERAL("YUV4MPEG2 W65535 H65535\nFRAME\nabcduv"), NULL, "too large: at most 1024 MiB");
}

/* ---- Headerless captures ------------------------------------------------------------------------------------- */

static void raw_frames_with_a_stride(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, 2, 2, 3};
    static const uint8_t first[] = {1, 2, 3, 4}, second[] = {5, 6, 7, 8};
    const expected_frame frames[] = {{2, 2, first}, {2, 2, second}};
    (void)state;
    expect_content(LITERAL("\x01\x02-\x03\x04-\x05\x06-\x07\x08-"), &layout, frames, 2, NULL);
}

/* What begins like another kind of file is raw all the same when it is said to be. */
static void raw_frames_of_any_content(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, 2, 1, 2};
    const expected_frame frames[] = {{2, 1, (const uint8_t *)"P5"}, {2, 1, (const uint8_t *)" 9"}};
    (void)state;
    expect_content(LITERAL("P5 9"), &layout, frames, 2, NULL);
}

static void raw_frames_with_chroma(void **state)
{
    static const frame_layout nv12 = {PIXEL_NV12, 3, 3, 3}, yuyv = {PIXEL_YUYV, 2, 1, 4};
    const expected_frame frames[] = {{3, 3, (const uint8_t *)"abcdefghi"}, {3, 3, (const uint8_t *)"jklmnopqr"}};
    const expected_frame packed[] = {{2, 1, (const uint8_t *)"ab"}, {2, 1, (const uint8_t *)"cd"}};
    (void)state;
    expect_content(LITERAL("abcdefghi--------jklmnopqr--------"), &nv12, frames, 2, NULL);
    expect_content(LITERAL("a-b-c-d-"), &yuyv, packed, 2, NULL);
}

static void raw_cut_anywhere(void **state)
{
    static const frame_layout layout = {PIXEL_YU12, 2, 2, 2};
    static const size_t frame_ends[] = {0, 6, 12};
    const expected_frame frames[] = {{2, 2, (const uint8_t *)"abcd"}, {2, 2, (const uint8_t *)"efgh"}};
    (void)state;
    try_all_cuts((const uint8_t *)"abcduvefghuv", &layout, frames, frame_ends, 2);
}

static void raw_of_a_wrong_size(void **state)
{
    static const frame_layout layout = {PIXEL_GREY, 4, 1, 4}, huge = {PIXEL_GREY, 65535, 16384, 65535};
    const expected_frame frames[] = {{4, 1, (const uint8_t *)"abcd"}};
    (void)state;
    expect_content(LITERAL("abcdef"), &layout, frames, 1, "2 bytes are left after 1 whole frames of 4 bytes");
    expect_refusal(LITERAL("abc"), &layout, "not GREY:4x1:4: 3 bytes are left after 0 whole frames");
    expect_refusal(LITERAL("abc"), &huge, "frames of 1073725440 bytes");
    expect_refusal(LITERAL(""), &layout, "is empty");
}

/* ---- Any file ------------------------------------------------------------------------------------------------ */

static void files_that_cannot_be_opened(void **state)
{
    error_text error;
    (void)state;
    expect_refusal(LITERAL(""), NULL, "is empty");
    expect_refusal(LITERAL("{\"frames\": []}\n"), NULL, "no picture or video");
    expect_refusal(LITERAL("P5"), NULL, "no picture or video");
    expect_refusal(LITERAL("P9 1 1 255 a"), NULL, "no picture or video");
    assert_null(frame_source_open_file("/nonexistent/frames.pgm", NULL, &error));
    assert_non_null(strstr(error.text, "No such file"));
    assert_null(frame_source_open_file("/", NULL, &error));
    assert_non_null(strstr(error.text, "is a directory"));
    frame_source_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pgm_of_8_bits),
        cmocka_unit_test(pgm_with_comments),
        cmocka_unit_test(pgm_is_scaled_from_its_maximum),
        cmocka_unit_test(plain_pgm),
        cmocka_unit_test(pgms_one_after_the_other),
        cmocka_unit_test(pgm_cut_anywhere),
        cmocka_unit_test(wrong_pgm_headers),
        cmocka_unit_test(y4m_of_each_chroma_scheme),
        cmocka_unit_test(y4m_of_more_bits),
        cmocka_unit_test(y4m_with_large_chroma),
        cmocka_unit_test(y4m_cut_anywhere),
        cmocka_unit_test(y4m_frames_have_times),
        cmocka_unit_test(y4m_that_cannot_be_read),
        cmocka_unit_test(raw_frames_with_a_stride),
        cmocka_unit_test(raw_frames_of_any_content),
        cmocka_unit_test(raw_frames_with_chroma),
        cmocka_unit_test(raw_cut_anywhere),
        cmocka_unit_test(raw_of_a_wrong_size),
        cmocka_unit_test(files_that_cannot_be_opened),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
