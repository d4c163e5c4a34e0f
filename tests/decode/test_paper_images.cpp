// The printed segments of the marker's inventors: whole, small, and turned.
#include "paper_data.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

extern "C" {
#include <cmocka.h>
}

namespace {

std::string folder;

struct segment {
    const char *file;
    std::vector<int> ids;
    const char *code;  // empty for a single CM
};

const std::vector<segment> segments = {
    {"CM15.jpg", {15}, ""},
    {"CM16.jpg", {16}, ""},
    {"CM21.jpg", {21}, ""},
    {"TM12_14.jpg", {12, -13, -14}, "100"},
    {"TM22_27.jpg", {-22, -23, -24, -25, 26, -27}, "000010"},
    {"TM28_32.jpg", {28, -29, -30, -31, -32}, "10000"},
    {"TM33_38.jpg", {-33, -34, -35, -36, 37, 38}, "000011"},
    {"TM42_47.jpg", {-42, -43, -44, 45, -46, -47}, "000100"},
    {"TM48_53.jpg", {-48, -49, -50, 51, -52, 53}, "000101"},
    {"TM54_56.jpg", {-54, 55, -56}, "010"},
    {"tape_0_5.jpg", {0, -1, -2, -3, -4, -5}, "100000"},
    {"tape_0_5.png", {0, -1, -2, -3, -4, -5}, "100000"},
    {"tape_6_11.jpg", {-6, -7, -8, -9, -10, 11}, "000001"},
    {"tape_6_11.png", {-6, -7, -8, -9, -10, 11}, "000001"},
    {"tape_17_20.jpg", {17, -18, -19, -19, -20}, "10000"},
};

constexpr int module_px = 26;

cv::Mat picture_of(const segment &one)
{
    cv::Mat gray = cv::imread(folder + "/markers/" + one.file, cv::IMREAD_GRAYSCALE);
    if (gray.empty())
        fail_msg("%s cannot be read", one.file);
    return gray;
}

std::string text_of(const std::vector<reading> &readings)
{
    std::string text;
    for (const reading &one : readings)
        text += one.code.empty() ? std::to_string(one.id) + " " : one.code + (one.directed ? " " : "? ");
    return text;
}

// The ids in the order in which the segment reads, then its code.
std::string text_of(const segment &one)
{
    std::string text;
    for (int id : one.ids)
        text += std::to_string(id) + " ";
    return *one.code == '\0' ? text : text + one.code + " ";
}

// Clockwise from the image's x axis, in quarter turns.
int quarter_turns(const reading &one)
{
    const cv::Point2f along = one.corners[1] - one.corners[0];
    if (std::abs(along.x) > std::abs(along.y))
        return along.x > 0 ? 0 : 2;
    return along.y > 0 ? 1 : 3;
}

void assert_read(const segment &one, const cv::Mat &gray, int turns, const char *what)
{
    const std::vector<reading> readings = read_tapemark(gray);
    if (text_of(readings) != text_of(one))
        fail_msg("%s, %s: %sinstead of %s", one.file, what, text_of(readings).c_str(), text_of(one).c_str());
    for (const reading &marker : readings)
        if (quarter_turns(marker) != turns)
            fail_msg("%s, %s: read in a wrong direction", one.file, what);
}

void reads_all_as_published(void **)
{
    for (const segment &one : segments)
        assert_read(one, picture_of(one), 0, "as published");
}

void reads_all_when_smaller(void **)
{
    for (const segment &one : segments)
        for (int divisor : {4, 8, 13}) {
            cv::Mat small;
            cv::resize(picture_of(one), small, {}, 1.0 / divisor, 1.0 / divisor, cv::INTER_AREA);
            assert_read(one, small, 0, ("1/" + std::to_string(divisor)).c_str());
        }
}

void reads_all_when_turned(void **)
{
    for (const segment &one : segments) {
        cv::Mat small, turned;
        cv::resize(picture_of(one), small, {}, 0.25, 0.25, cv::INTER_AREA);
        for (int turns = 1; turns < 4; turns++) {
            cv::rotate(small, turned, turns - 1);  // 90, 180 and 270 degrees clockwise
            assert_read(one, turned, turns, ("turned by " + std::to_string(90 * turns)).c_str());
        }
    }
}

// The quiet zone is as wide as the format has it: one module round a CM, two at the ends of a TM.
void finds_the_corners_of_single_cms(void **)
{
    for (const segment &one : segments) {
        if (one.ids.size() != 1)
            continue;
        const std::vector<reading> readings = read_tapemark(picture_of(one));
        assert_int_equal(readings.size(), 1);
        const float left = module_px - 0.5F, right = 33 * module_px - 0.5F, bottom = 8 * module_px - 0.5F;
        const std::array<cv::Point2f, 4> corners = {
            cv::Point2f(left, left), {right, left}, {right, bottom}, {left, bottom}};
        for (std::size_t i = 0; i < 4; i++)
            if (cv::norm(readings[0].corners[i] - corners[i]) > 1.5)
                fail_msg("%s: corner %u is off by %.2f px", one.file, static_cast<unsigned>(i),
                         cv::norm(readings[0].corners[i] - corners[i]));
    }
}

}  // namespace

int main()
{
    folder = paper_data_folder();
    const CMUnitTest tests[] = {
        cmocka_unit_test(reads_all_as_published),
        cmocka_unit_test(reads_all_when_smaller),
        cmocka_unit_test(reads_all_when_turned),
        cmocka_unit_test(finds_the_corners_of_single_cms),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
