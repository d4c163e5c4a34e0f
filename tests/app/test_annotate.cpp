/* Annotated frames: what is drawn where, read back from the PNG. */
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

/* Last: cmocka's macros have names that the standard library uses. */
extern "C" {
#include "test_main.h"

#include "annotate.h"
}

namespace {

enum colour { GREEN, ORANGE, BLUE };

/* Whether a pixel within this box has the hue of a colour: lines are smoothed at their edges. */
bool has_colour(const cv::Mat &picture, cv::Rect box, colour wanted)
{
    for (const cv::Vec3b &pixel : cv::Mat_<cv::Vec3b>(picture(box & cv::Rect({}, picture.size())).clone())) {
        int blue = pixel[0], green = pixel[1], red = pixel[2];
        bool found = wanted == GREEN    ? green > blue + 80 && green > red + 80
                     : wanted == ORANGE ? red > green + 60 && green > blue + 60
                                        : blue > red + 80 && blue > green + 60;
        if (found)
            return true;
    }
    return false;
}

bool is_gray(const cv::Mat &picture, cv::Rect box)
{
    std::vector<cv::Mat> channels;
    cv::split(picture(box), channels);
    return cv::norm(channels[0], channels[1], cv::NORM_INF) == 0 &&
           cv::norm(channels[1], channels[2], cv::NORM_INF) == 0;
}

cv::Rect around(float x, float y, int reach = 2)
{
    return {cvRound(x) - reach, cvRound(y) - reach, 2 * reach + 1, 2 * reach + 1};
}

struct scene {
    std::vector<uint8_t> pixels;
    gray_view view;
    tapemark_cm cm{};
    tapemark_tm tm{};
    tapemark_finder finder{};
    tapemark_result result{};
};

/* A CM of 160 x 35 px with its top left corner at (x, y), one of its finder patterns, and a TM right around it. */
void make_scene(scene &made, int width, int height, float x, float y)
{
    constexpr int padding = 13;
    made.pixels.assign(static_cast<size_t>((width + padding) * height), 90);
    made.view = {made.pixels.data(), width, height, width + padding};
    made.cm.id = -1234;
    tapemark_point cm_corners[4] = {{x, y}, {x + 160, y}, {x + 160, y + 35}, {x, y + 35}};
    tapemark_point tm_corners[4] = {{x - 40, y}, {x + 200, y}, {x + 200, y + 35}, {x - 40, y + 35}};
    std::copy(cm_corners, cm_corners + 4, made.cm.corners);
    std::copy(tm_corners, tm_corners + 4, made.tm.corners);
    std::strcpy(made.tm.code, "101");
    made.tm.length = 3;
    made.finder = {{x + 17.5f, y + 17.5f}, {5, 0}, {0, 5}, 1};
    made.result.cms = &made.cm;
    made.result.tms = &made.tm;
    made.result.finders = &made.finder;
    made.result.cm_count = made.result.tm_count = made.result.finder_count = 1;
}

cv::Mat annotate(const scene &drawn)
{
    error_text error{};
    std::string folder = std::string(temporary_file("-drawn", "", 0));
    unlink(folder.c_str());
    assert_true(annotate_prepare(folder.c_str(), &error));
    assert_true(annotate_frame(folder.c_str(), "a.mp4", 42, &drawn.view, &drawn.result, &error));
    std::string path = folder + "/a.mp4-000042.png";
    cv::Mat picture = cv::imread(path);
    unlink(path.c_str());
    rmdir(folder.c_str());
    assert_int_equal(picture.cols, drawn.view.width_px);
    assert_int_equal(picture.rows, drawn.view.height_px);
    return picture;
}

void a_frame_without_markers_stays_as_it_is(void **)
{
    scene empty;
    make_scene(empty, 100, 80, 10, 10);
    empty.result = {};
    for (size_t i = 0; i < empty.pixels.size(); i++)
        empty.pixels[i] = static_cast<uint8_t>(i);
    cv::Mat picture = annotate(empty), gray;
    assert_true(is_gray(picture, cv::Rect(0, 0, 100, 80)));
    cv::extractChannel(picture, gray, 0);
    const cv::Mat expected(80, 100, CV_8UC1, empty.pixels.data(), static_cast<size_t>(empty.view.stride_bytes));
    assert_true(cv::norm(gray, expected, cv::NORM_INF) == 0);
}

void markers_are_drawn_where_they_are(void **)
{
    for (cv::Size size : {cv::Size(640, 480), cv::Size(1080, 1920)}) {
        scene drawn;
        make_scene(drawn, size.width, size.height, 200, 200);
        cv::Mat picture = annotate(drawn);
        /* The outline of the CM, and its id above it. */
        assert_true(has_colour(picture, around(280, 200), GREEN));
        assert_true(has_colour(picture, around(280, 235), GREEN));
        assert_true(has_colour(picture, around(360, 217), GREEN));
        assert_true(has_colour(picture, cv::Rect(240, 170, 80, 24), GREEN));
        /* The bracket of the TM at both ends, below, and its code under that. */
        assert_true(has_colour(picture, around(160, 217), ORANGE));
        assert_true(has_colour(picture, around(400, 217), ORANGE));
        assert_true(has_colour(picture, cv::Rect(270, 236, 20, 12), ORANGE));
        assert_true(has_colour(picture, cv::Rect(250, 248, 60, 30), ORANGE));
        /* The finder pattern's edge away from the CM's. */
        assert_true(has_colour(picture, around(235, 217), BLUE));
        /* Inside the CM and far away nothing is drawn. */
        assert_true(is_gray(picture, cv::Rect(250, 210, 90, 15)));
        assert_true(is_gray(picture, cv::Rect(0, 300, size.width, 100)));
        assert_true(is_gray(picture, cv::Rect(0, 0, size.width, 150)));
    }
}

void only_known_directions_have_an_arrow(void **)
{
    scene drawn;
    make_scene(drawn, 640, 480, 200, 200);
    cv::Rect tip(390, 241, 8, 8);
    assert_false(has_colour(annotate(drawn), tip, ORANGE));
    drawn.tm.directed = true;
    assert_true(has_colour(annotate(drawn), tip, ORANGE));
}

void labels_stay_in_the_frame(void **)
{
    scene drawn;
    make_scene(drawn, 640, 480, 200, 3);
    drawn.result.tm_count = 0;
    cv::Mat picture = annotate(drawn);
    assert_true(has_colour(picture, cv::Rect(240, 42, 80, 16), GREEN));
}

void corners_far_outside_do_no_harm(void **)
{
    scene drawn;
    make_scene(drawn, 64, 48, 0, 0);
    for (float far : {1e4f, 1e9f, 1e30f, -1e9f, NAN}) {
        for (tapemark_point *corners : {drawn.cm.corners, drawn.tm.corners})
            corners[1].x_px = corners[2].x_px = far;
        drawn.finder.centre.y_px = far;
        assert_int_equal(annotate(drawn).cols, 64);
    }
}

void folders_that_cannot_be_used(void **)
{
    error_text error{};
    scene drawn;
    make_scene(drawn, 64, 48, 0, 0);
    assert_false(annotate_prepare("/nonexistent/folder", &error));
    assert_non_null(std::strstr(error.text, "cannot be made"));
    assert_false(annotate_prepare(temporary_file("-file", "", 0), &error));
    assert_non_null(std::strstr(error.text, "is not a directory"));
    unlink(temporary_file("-file", "", 0));
    assert_false(annotate_frame("/nonexistent/folder", "a", 0, &drawn.view, &drawn.result, &error));
    assert_non_null(std::strstr(error.text, "/nonexistent/folder/a-000000.png cannot be written: No such file"));
}

} // namespace

int main()
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_without_markers_stays_as_it_is),
        cmocka_unit_test(markers_are_drawn_where_they_are),
        cmocka_unit_test(only_known_directions_have_an_arrow),
        cmocka_unit_test(labels_stay_in_the_frame),
        cmocka_unit_test(corners_far_outside_do_no_harm),
        cmocka_unit_test(folders_that_cannot_be_used),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
