/* Stills and videos that OpenCV writes come back through the readers; and OpenCV as the second opinion on the
 * conversions to gray. */
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

/* Last: cmocka's macros have names that the standard library uses. */
extern "C" {
#include "test_main.h"

#include "gray.h"
}

namespace {

using bytes = std::vector<uint8_t>;

cv::Mat ramp(int width, int height, int type = CV_8UC1)
{
    cv::Mat picture(height, width, type);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            picture.at<uint8_t>(y, x) = static_cast<uint8_t>(40 + 3 * x + 2 * y);
    return picture;
}

cv::Mat noise(int width, int height, int type)
{
    cv::Mat picture(height, width, type);
    cv::RNG random(7);
    random.fill(picture, cv::RNG::UNIFORM, 0, 256);
    return picture;
}

bytes encode(const char *ending, const cv::Mat &picture)
{
    bytes encoded;
    assert_true(cv::imencode(ending, picture, encoded));
    return encoded;
}

bytes operator+(bytes left, const bytes &right)
{
    left.insert(left.end(), right.begin(), right.end());
    return left;
}

bytes content_of(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

cv::Mat to_gray(const frame &input)
{
    gray_converter converter{};
    gray_view view;
    error_text error;
    assert_true(gray_from_frame(&converter, &input, &view, &error));
    cv::Mat gray = cv::Mat(view.height_px, view.width_px, CV_8UC1, const_cast<uint8_t *>(view.pixels),
                           static_cast<size_t>(view.stride_bytes)).clone();
    gray_converter_release(&converter);
    return gray;
}

struct reading {
    std::vector<cv::Mat> frames;
    std::vector<int64_t> times_ns;
    std::string error;  /* empty when the source ended well */
};

reading read_path(const std::string &path)
{
    reading result;
    error_text error{};
    frame_source *source = frame_source_open_file(path.c_str(), nullptr, &error);
    frame output;
    frame_status status = FRAME_FAILED;
    while (source != nullptr && (status = frame_source_next(source, &output, &error)) == FRAME_READY) {
        assert_int_equal(output.sequence, result.frames.size());
        result.frames.push_back(to_gray(output));
        result.times_ns.push_back(output.time_ns);
    }
    frame_source_close(source);
    if (status == FRAME_FAILED) {
        result.error = error.text;
        assert_false(result.error.empty());
    }
    return result;
}

reading read_bytes(const bytes &content)
{
    std::string path = temporary_file("", content.data(), content.size());
    reading got = read_path(path);
    unlink(path.c_str());
    return got;
}

double largest_difference(const cv::Mat &left, const cv::Mat &right)
{
    assert_int_equal(left.cols, right.cols);
    assert_int_equal(left.rows, right.rows);
    return cv::norm(left, right, cv::NORM_INF);
}

void expect_still(const bytes &content, const cv::Mat &expected, double tolerance)
{
    reading got = read_bytes(content);
    assert_string_equal(got.error.c_str(), "");
    assert_int_equal(got.frames.size(), 1);
    assert_true(largest_difference(got.frames[0], expected) <= tolerance);
}

void expect_failure(const bytes &content, size_t frame_count, const char *reason)
{
    reading got = read_bytes(content);
    assert_int_equal(got.frames.size(), frame_count);
    assert_non_null(std::strstr(got.error.c_str(), reason));
}

/* ---- Conversions: OpenCV's luma against ours ----------------------------------------------------------------- */

void compare_with_opencv(pixel_format format, const cv::Mat &data, int width, int height, int conversion)
{
    frame_layout layout = {format, width, height, frame_layout_least_stride(format, width)};
    frame input = {layout, data.data, 0, FRAME_TIME_UNKNOWN};
    cv::Mat expected;
    cv::cvtColor(data, expected, conversion);
    assert_true(largest_difference(to_gray(input), expected) == 0);
}

void luma_as_opencv_has_it(void **)
{
    compare_with_opencv(PIXEL_YUYV, noise(46, 20, CV_8UC2), 46, 20, cv::COLOR_YUV2GRAY_YUY2);
    compare_with_opencv(PIXEL_UYVY, noise(46, 20, CV_8UC2), 46, 20, cv::COLOR_YUV2GRAY_UYVY);
    compare_with_opencv(PIXEL_NV12, noise(46, 30, CV_8UC1), 46, 20, cv::COLOR_YUV2GRAY_NV12);
    compare_with_opencv(PIXEL_YU12, noise(46, 30, CV_8UC1), 46, 20, cv::COLOR_YUV2GRAY_I420);
}

void bayer_as_opencv_filters_it(void **)
{
    for (cv::Size size : {cv::Size(31, 17), cv::Size(2, 2), cv::Size(3, 40)}) {
        cv::Mat data = noise(size.width, size.height, CV_8UC1), expected;
        cv::Mat kernel = (cv::Mat_<float>(3, 3) << 1, 2, 1, 2, 4, 2, 1, 2, 1) / 16;
        cv::filter2D(data, expected, CV_32F, kernel, cv::Point(-1, -1), 0, cv::BORDER_REFLECT_101);
        cv::Mat rounded;
        cv::Mat(expected + 0.001f).convertTo(rounded, CV_8U);  /* halves go up */
        frame input = {{PIXEL_SGBRG8, size.width, size.height, static_cast<size_t>(size.width)}, data.data, 0, 0};
        assert_true(largest_difference(to_gray(input), rounded) == 0);
    }
}

/* ---- Still pictures ------------------------------------------------------------------------------------------ */

void stills_without_loss(void **)
{
    cv::Mat picture = ramp(37, 21);
    for (const char *ending : {".png", ".bmp", ".tif", ".webp", ".pgm"}) {
        std::vector<int> best;
        bytes encoded;
        if (std::string(ending) == ".webp")
            best = {cv::IMWRITE_WEBP_QUALITY, 101};
        assert_true(cv::imencode(ending, picture, encoded, best));
        expect_still(encoded, picture, std::string(ending) == ".webp" ? 2 : 0);
    }
}

/* Larger than what is read in one go. */
void large_stills(void **)
{
    cv::Mat picture = noise(600, 500, CV_8UC1);
    for (const char *ending : {".png", ".bmp"})
        expect_still(encode(ending, picture), picture, 0);
}

void stills_of_extreme_sizes(void **)
{
    for (cv::Size size : {cv::Size(1, 1), cv::Size(65535, 1), cv::Size(1, 65535)}) {
        cv::Mat picture = noise(size.width, size.height, CV_8UC1);
        expect_still(encode(".png", picture), picture, 0);
    }
    expect_failure(encode(".png", noise(65536, 2, CV_8UC1)), 0, "is 65536 x 2 px; the largest side is 65535 px");
}

void deep_and_coloured_stills(void **)
{
    cv::Mat gray = ramp(37, 21), deep, colour;
    gray.convertTo(deep, CV_16U, 257);
    cv::cvtColor(gray, colour, cv::COLOR_GRAY2BGR);
    expect_still(encode(".png", deep), gray, 0);
    expect_still(encode(".png", colour), gray, 0);
    expect_still(encode(".ppm", colour), gray, 0);
    expect_still(encode(".jpg", gray), gray, 4);
    expect_still(encode(".jpg", colour), gray, 4);
}

void transparent_stills_lie_on_white(void **)
{
    cv::Mat picture(1, 3, CV_8UC4), deep;
    picture.at<cv::Vec4b>(0, 0) = cv::Vec4b(10, 10, 10, 0);
    picture.at<cv::Vec4b>(0, 1) = cv::Vec4b(10, 10, 10, 255);
    picture.at<cv::Vec4b>(0, 2) = cv::Vec4b(100, 100, 100, 51);
    cv::Mat expected = (cv::Mat_<uint8_t>(1, 3) << 255, 10, 224);
    expect_still(encode(".png", picture), expected, 0);
    picture.convertTo(deep, CV_16U, 257);
    expect_still(encode(".png", deep), expected, 0);
}

void jpegs_one_after_the_other(void **)
{
    cv::Mat first = ramp(40, 24), second = 255 - first, smaller = ramp(16, 16);
    reading both = read_bytes(encode(".jpg", first) + encode(".jpg", second));
    assert_string_equal(both.error.c_str(), "");
    assert_int_equal(both.frames.size(), 2);
    assert_true(largest_difference(both.frames[0], first) <= 4);
    assert_true(largest_difference(both.frames[1], second) <= 4);

    /* Things that cameras put behind the picture. */
    expect_still(encode(".jpg", first) + encode(".jpg", smaller), first, 4);
    expect_still(encode(".jpg", first) + bytes{0, 1, 2, 3}, first, 4);
}

/* Restart markers stand between parts of the coded pixels; a preview in a segment has an end of its own. */
void jpegs_with_markers_inside(void **)
{
    cv::Mat picture = ramp(48, 32);
    bytes restarts;
    assert_true(cv::imencode(".jpg", picture, restarts, {cv::IMWRITE_JPEG_RST_INTERVAL, 2}));
    expect_still(restarts, picture, 4);

    bytes plain = encode(".jpg", picture);
    bytes comment = {0xff, 0xfe, 0, 4, 'h', 'i'};
    bytes preview = {0xff, 0xef, 0, 8, 0xff, 0xd8, 0xff, 0xd9, 0xff, 0xd9};
    expect_still(bytes(plain.begin(), plain.begin() + 2) + comment + preview + bytes(plain.begin() + 2, plain.end()),
                 picture, 4);
}

void damaged_stills(void **)
{
    bytes jpeg = encode(".jpg", noise(64, 48, CV_8UC1)), png = encode(".png", noise(64, 48, CV_8UC1));
    for (size_t size = 4; size < jpeg.size(); size += 7)
        expect_failure(bytes(jpeg.begin(), jpeg.begin() + static_cast<ptrdiff_t>(size)), 0, "cut short");
    expect_failure(jpeg + bytes(jpeg.begin(), jpeg.end() - 2), 1, "cut short: picture 1");
    for (size_t size = 8; size < png.size() - 16; size += 61)
        expect_failure(bytes(png.begin(), png.begin() + static_cast<ptrdiff_t>(size)), 0, "damaged, cut short");
    expect_failure({'B', 'M', ' ', 'o', 'r', ' ', 's', 'o'}, 0, "damaged, cut short");
    expect_failure({0xff, 0xd8, 0xff, 0xd9}, 0, "damaged, cut short");
}

/* ---- Videos -------------------------------------------------------------------------------------------------- */

constexpr int video_frames = 12;

cv::Mat video_frame(int number)
{
    return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(20 * number));
}

std::string write_video()
{
    std::string path = temporary_file(":video.avi", "", 0);
    cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25,
                           cv::Size(64, 48));
    assert_true(writer.isOpened());
    for (int i = 0; i < video_frames; i++)
        writer.write(video_frame(i));
    return path;
}

void expect_video_frames(const reading &got)
{
    for (size_t i = 0; i < got.frames.size(); i++) {
        cv::Mat expected;
        cv::cvtColor(video_frame(static_cast<int>(i)), expected, cv::COLOR_BGR2GRAY);
        assert_true(largest_difference(got.frames[i], expected) <= 4);
        assert_int_equal(got.times_ns[i], i * 40000000);
    }
}

void video_is_read_to_its_end(void **)
{
    std::string path = write_video();
    size_t slash = path.rfind('/');
    /* What stands before the colon could be taken for the name of a protocol. */
    assert_int_equal(chdir(path.substr(0, slash).c_str()), 0);
    reading got = read_path(path.substr(slash + 1));
    unlink(path.c_str());
    assert_string_equal(got.error.c_str(), "");
    assert_int_equal(got.frames.size(), video_frames);
    expect_video_frames(got);
}

void cut_video_gives_its_first_frames_and_an_error(void **)
{
    std::string path = write_video();
    bytes whole = content_of(path);
    unlink(path.c_str());
    reading got = read_bytes(bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(whole.size() * 2 / 3)));
    assert_true(got.frames.size() >= 2 && got.frames.size() < video_frames);
    assert_non_null(std::strstr(got.error.c_str(), "is cut short"));
    expect_video_frames(got);
}

/* An index at the end is how most programs write MP4. */
void mp4_without_its_index_is_cut_short(void **)
{
    bytes mp4 = {0, 0, 0, 16, 'f', 't', 'y', 'p', 'i', 's', 'o', 'm', 0, 0, 0, 0,
                 0, 0, 1, 0,  'm', 'd', 'a', 't', 1, 2};
    expect_failure(mp4, 0, "is cut short: 246 bytes are missing");
    bytes larger = mp4 + bytes(200000);
    larger[17] = 8;  /* half a megabyte */
    expect_failure(larger, 0, "is cut short: 324534 bytes are missing");
    mp4[17] = 0, mp4[18] = 0, mp4[19] = 10;  /* complete, but without any video */
    expect_failure(mp4, 0, "is a video that cannot be read");
}

/* ---- Standard error ------------------------------------------------------------------------------------------ */

void libraries_keep_quiet(void **)
{
    std::string path = temporary_file(".stderr", "", 0);
    int saved = dup(STDERR_FILENO);
    int caught = open(path.c_str(), O_WRONLY | O_TRUNC);
    assert_true(saved >= 0 && caught >= 0);
    dup2(caught, STDERR_FILENO);
    bytes png = encode(".png", noise(64, 48, CV_8UC1));
    read_bytes(bytes(png.begin(), png.begin() + 900));
    read_bytes({0, 0, 0, 16, 'f', 't', 'y', 'p', 'i', 's', 'o', 'm', 0, 0, 0, 0});
    dprintf(STDERR_FILENO, "open again");
    dup2(saved, STDERR_FILENO);
    close(saved);
    close(caught);
    bytes printed = content_of(path);
    unlink(path.c_str());
    assert_string_equal(std::string(printed.begin(), printed.end()).c_str(), "open again");
}

} // namespace

int main()
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(luma_as_opencv_has_it),
        cmocka_unit_test(bayer_as_opencv_filters_it),
        cmocka_unit_test(stills_without_loss),
        cmocka_unit_test(large_stills),
        cmocka_unit_test(stills_of_extreme_sizes),
        cmocka_unit_test(deep_and_coloured_stills),
        cmocka_unit_test(transparent_stills_lie_on_white),
        cmocka_unit_test(jpegs_one_after_the_other),
        cmocka_unit_test(jpegs_with_markers_inside),
        cmocka_unit_test(damaged_stills),
        cmocka_unit_test(video_is_read_to_its_end),
        cmocka_unit_test(cut_video_gives_its_first_frames_and_an_error),
        cmocka_unit_test(mp4_without_its_index_is_cut_short),
        cmocka_unit_test(libraries_keep_quiet),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
