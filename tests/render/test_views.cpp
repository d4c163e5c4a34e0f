// What tapemark-render shows is where its truth says: the decoder, and OpenCV for other markers, find it there.
#include "paper_data.hpp"
#include "rendering.hpp"

#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include <sys/resource.h>

extern "C" {
#include <cmocka.h>
}

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// Two rooms of 3 m, one beside the other, a wall with tape on both sides between them, and tape on the floor.
const char *const two_rooms = R"({"format": "tapemark-map", "version": 1, "units": "m",
 "plan": {"width_m": 6, "height_m": 3}, "module_mm": 10, "segments": [
  {"on": "wall", "above_floor_m": 0.5, "start": [2.95, 1.34], "end": [2.95, 1.66], "direction_deg": 90, "cms": [
   {"id": 7, "start": [2.95, 1.34], "end": [2.95, 1.66], "direction_deg": 90}]},
  {"on": "wall", "above_floor_m": 0.5, "start": [3.05, 1.66], "end": [3.05, 1.34], "direction_deg": 270, "cms": [
   {"id": -8, "start": [3.05, 1.66], "end": [3.05, 1.34], "direction_deg": 270}]},
  {"on": "wall", "above_floor_m": 0.5, "start": [6, 1.34], "end": [6, 1.66], "direction_deg": 90, "cms": [
   {"id": 9, "start": [6, 1.34], "end": [6, 1.66], "direction_deg": 90}]},
  {"on": "floor", "start": [1.6, 1.34], "end": [1.6, 1.66], "direction_deg": 90, "cms": [
   {"id": 10, "start": [1.6, 1.34], "end": [1.6, 1.66], "direction_deg": 90}]}]})";

double farthest(const std::array<cv::Point2f, 4> &found, const std::array<cv::Point2d, 4> &known)
{
    double most = 0;
    for (std::size_t i = 0; i < 4; i++)
        most = std::max(most, cv::norm(cv::Point2d(found[i]) - known[i]));
    return most;
}

// Every CM that is wholly in view, at least 1.5 px a module and not steeper than 65 degrees, is read where it is;
// nothing is read that is not there. Returns how many.
std::size_t assert_read(const view &seen, double tolerance_px)
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < seen.frames.size(); i++) {
        const std::vector<reading> readings = read_tapemark(seen.frames[i]);
        for (const reading &one : readings) {
            const bool true_one = !one.code.empty() ||
                                  std::any_of(seen.truth[i].cms.begin(), seen.truth[i].cms.end(),
                                              [&](const true_marker &cm) { return cm.id == one.id; });
            if (!true_one)
                fail_msg("frame %zu: CM %d is not there", i, one.id);
        }
        for (const true_marker &cm : seen.truth[i].cms) {
            if (!cm.whole || cm.px_min < 1.5 || cm.angle_deg > 65)
                continue;
            const auto found = std::find_if(readings.begin(), readings.end(), [&](const reading &one) {
                return one.code.empty() && one.id == cm.id;
            });
            if (found == readings.end())
                fail_msg("frame %zu: CM %d was not read", i, cm.id);
            else if (farthest(found->corners, cm.corners) > tolerance_px)
                fail_msg("frame %zu: CM %d is %.2f px off", i, cm.id, farthest(found->corners, cm.corners));
            count++;
        }
    }
    return count;
}

/* ---- Tapes ----------------------------------------------------------------------------------------------- */

void tapes_in_a_row_are_where_the_truth_says(void **)
{
    const view seen =
        render("--ids 3,-4,5 --ids 6 --ids -7,8 --bars auto --distance 1.6m --yaw 25 --pitch 10 --roll 8 "
               "--module 6mm --gap 40mm --size 960x480");
    assert_int_equal(seen.truth[0].tapes.size(), 3);
    assert_int_equal(assert_read(seen, 0.5), 6);
}

// 10 mm at 500 px a metre away are 5 px.
void a_row_has_its_gaps_and_its_middle(void **)
{
    const view seen = render("--ids 5 --ids 6 --module 10mm --gap 100mm --distance 1m --focal 500 --x 10 --y -20");
    const auto &left = seen.truth[0].cms.at(0).corners, &right = seen.truth[0].cms.at(1).corners;
    const double edges[] = {10 - 25 - 160, 10 - 25, 10 + 25, 10 + 25 + 160}, middle_x = 319.5, middle_y = 239.5;
    assert_true(std::fabs(left[0].x - middle_x - edges[0]) < 0.02);
    assert_true(std::fabs(left[1].x - middle_x - edges[1]) < 0.02);
    assert_true(std::fabs(right[0].x - middle_x - edges[2]) < 0.02);
    assert_true(std::fabs(right[1].x - middle_x - edges[3]) < 0.02);
    assert_true(std::fabs((left[0].y + left[3].y) / 2 - middle_y + 20) < 0.02);
}

void distance_and_angle_are_what_was_asked_for(void **)
{
    const view seen = render("--ids 5 --distance 1.2m --yaw 30 --focal 700");
    const true_marker &cm = seen.truth[0].cms.at(0);
    assert_true(std::fabs(cm.distance_m - 1.2) < 1e-3);
    assert_true(std::fabs(cm.angle_deg - 30) < 0.02);
    // Along the tape it is shorter by the cosine of the angle.
    const double px = 700 * 0.06 / 7 / 1.2;
    assert_true(std::fabs(cm.px_along - px * std::cos(30 * degree)) < 0.01 * px);
}

void a_room_is_read_as_its_map_says(void **)
{
    write_text("rooms.json", two_rooms);
    const view seen = render("--map rooms.json --camera 0.5,1.5,1,0,-25 --size 800x600 --furnished yes");
    assert_int_equal(assert_read(seen, 0.5), 2);
    for (const true_marker &cm : seen.truth[0].cms)
        assert_true(cm.id == 7 || cm.id == 10);
}

// From the other room the other side of the wall is seen, and the tape on the wall beyond.
void walls_hide_what_is_behind_them(void **)
{
    write_text("rooms.json", two_rooms);
    const view seen = render("--map rooms.json --camera 4.5,1.5,0.6,180,0 --size 800x600");
    assert_int_equal(assert_read(seen, 0.5), 1);
    assert_int_equal(seen.truth[0].cms.size(), 1);
    assert_int_equal(seen.truth[0].cms[0].id, -8);
    const view back = render("--map rooms.json --camera 4.5,1.5,0.6,0,0 --size 800x600");
    assert_int_equal(back.truth[0].cms.size(), 1);
    assert_int_equal(back.truth[0].cms[0].id, 9);
}

void boxes_and_covers_take_their_share(void **)
{
    write_text("rooms.json", two_rooms);
    const view boxed = render("--map rooms.json --camera 0.5,1.5,0.5,0,0 --box 2,1.6,0.1,0.2,1.5 --size 800x600");
    const auto hidden = std::find_if(boxed.truth[0].cms.begin(), boxed.truth[0].cms.end(),
                                     [](const true_marker &cm) { return cm.id == 7; });
    assert_true(hidden != boxed.truth[0].cms.end());
    assert_true(hidden->hidden > 0.3 && hidden->hidden < 0.7 && hidden->covered == 0);
    assert_true(std::fabs(hidden->visible + hidden->hidden - 1) < 2e-3);

    const view covered = render("--ids 5 --px-per-module 6 --cover 320,240,60,200");
    const true_marker &cm = covered.truth[0].cms.at(0);
    assert_true(std::fabs(cm.covered - 60.0 / (32 * 6)) < 0.02);

    double least = 1, most = 0;
    for (const true_frame &frame : render("--ids 5 --px-per-module 6 --covered 0.4 --frames 8", 8).truth) {
        assert_true(std::fabs(frame.cms.at(0).hidden - 0.4) < 0.03);
        assert_true(frame.pictures.empty());
        least = std::min(least, frame.cms[0].visible);
        most = std::max(most, frame.cms[0].visible);
    }
    assert_true(most < 0.65 && least > 0.55);
}

// The same way without walls from the inventors' format, which tells only middles.
void maps_of_the_inventors_are_shown(void **)
{
    const std::string plan =
        R"({"largura": 3, "altura": 3, "idtm": " ", "n_tm": " ", "x1": 0, "y1": 0, "x2": 0, "y2": 0, )";
    write_text("theirs.json", "[" + plan + R"("idcm_decimal": 5, "x": 1.2, "y": 0.1}, )" + plan +
                                  R"("idcm_decimal": -6, "x": 1.6, "y": 0.1}])");
    const view seen = render("--map theirs.json --module 9mm --camera 1.4,1.5,1,-90,-30 --size 800x600");
    assert_int_equal(assert_read(seen, 0.5), 2);
    assert_true(seen.truth[0].cms[0].corners[0].x < seen.truth[0].cms[1].corners[0].x);
}

/* ---- Pictures -------------------------------------------------------------------------------------------- */

void aruco_pictures_are_where_the_truth_says(void **)
{
    constexpr int ids = 4, modules = 7, texels = 10;
    const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
    std::string pictures;
    for (int id = 0; id < ids; id++) {
        cv::Mat marker;
        cv::aruco::drawMarker(dictionary, 17 + id, modules * texels, marker, 1);
        const std::string name = "aruco" + std::to_string(id) + ".png";
        cv::imwrite(name, marker);
        pictures += " --picture " + name + ":60mm:7";
    }
    const view seen = render(pictures + " --border 10mm --gap 40mm --distance 60cm --yaw -25 --pitch 15 --roll 5 "
                                        "--size 800x480 --focal 900 --defocus 0.4 --noise 0.5 --shot-noise 1");
    std::vector<int> found_ids;
    std::vector<std::vector<cv::Point2f>> found;
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    parameters->cornerRefinementWinSize = 3;
    cv::aruco::detectMarkers(seen.frames[0], dictionary, found, found_ids, parameters);
    assert_int_equal(found_ids.size(), ids);
    assert_int_equal(seen.truth[0].pictures.size(), ids);
    for (std::size_t i = 0; i < found_ids.size(); i++) {
        const true_marker &known = seen.truth[0].pictures.at(static_cast<std::size_t>(found_ids[i] - 17));
        double off = 0;
        for (std::size_t corner = 0; corner < 4; corner++)
            off = std::max(off, cv::norm(cv::Point2d(found[i][corner]) - known.corners[corner]));
        print_message("ArUco %d: corners off by %.2f px at most\n", found_ids[i], off);
        assert_true(off < 0.3);
        const double side = cv::norm(known.corners[1] - known.corners[0]) / modules;
        assert_true(std::fabs(known.px_along - side) < 0.05 * side);
    }
}

void pictures_on_the_plan_face_where_they_are_told_to(void **)
{
    cv::Mat picture(40, 40, CV_8U, cv::Scalar(255));
    picture(cv::Rect(0, 0, 20, 20)).setTo(0);
    cv::imwrite("corner.png", picture);
    const std::string at = "--picture corner.png:20cm --at ", from = " --camera 1,1,1,0 --size 400x400 --paper 240";
    const view facing = render(at + "3,1,1,180" + from);
    const true_marker &shown = facing.truth[0].pictures.at(0);
    assert_true(shown.whole);
    assert_true(shown.corners[0].x < shown.corners[1].x && shown.corners[0].y < shown.corners[3].y);
    const cv::Point2d middle = (shown.corners[0] + shown.corners[2]) / 2, dark = (shown.corners[0] + middle) / 2;
    assert_true(facing.frames[0].at<uchar>(cvRound(dark.y), cvRound(dark.x)) < 60);
    assert_true(facing.frames[0].at<uchar>(cvRound(2 * middle.y - dark.y), cvRound(2 * middle.x - dark.x)) > 200);
    assert_true(render(at + "3,1,1,0" + from).truth[0].pictures.empty());

    // On the floor its lower edge lies where it faces: towards the camera it is upright.
    const view lying = render(at + "3,1,0,180 --camera 1,1,1.5,0,-36 --size 400x400");
    const true_marker &flat = lying.truth[0].pictures.at(0);
    assert_true(flat.corners[0].x < flat.corners[1].x && flat.corners[0].y < flat.corners[3].y);
}

/* ---- Cameras that move ----------------------------------------------------------------------------------- */

const char *const sideways = "time_s,x_m,y_m,height_m,heading_deg\n0,1,1,0.5,0\n1,1,1.4,0.5,0\n";

double difference(const cv::Mat &a, const cv::Mat &b)
{
    return cv::norm(a, b, cv::NORM_L2) / std::sqrt(static_cast<double>(a.total()));
}

void a_path_moves_the_picture_as_it_should(void **)
{
    write_text("way.csv", sideways);
    const view seen = render("--ids 5 --at 3,1.2,0.5,180 --path way.csv --fps 4 --focal 800 --size 640x240", 5);
    for (std::size_t i = 0; i < 5; i++) {
        const true_marker &cm = seen.truth[i].cms.at(0);
        const double x = (cm.corners[0].x + cm.corners[2].x) / 2, time_s = seen.truth[i].time_s;
        assert_true(std::fabs(time_s - 0.25 * static_cast<double>(i)) < 1e-4);
        // To the right is towards greater y when looking along the x axis.
        assert_true(std::fabs(x - (319.5 + 800 * (1.2 - (1 + 0.4 * time_s)) / 2)) < 0.3);
    }
}

// 0.4 m a second, 2 m away, at a focal length of 800 px, over 50 ms: 8 px.
void an_open_shutter_blurs_as_far_as_things_move(void **)
{
    write_text("way.csv", sideways);
    const std::string scene =
        "--ids 5 --at 3,1.2,0.5,180 --fps 2 --focal 800 --size 640x240 --noise 0 --shot-noise 0 ";
    // The floor is at other distances, and moves otherwise.
    const cv::Range tape(90, 150);
    const cv::Mat still = render(scene + "--path way.csv", 3).frames[1].rowRange(tape);
    const cv::Mat open = render(scene + "--path way.csv --shutter 50ms", 3).frames[1].rowRange(tape);
    const cv::Mat blurred = render(scene + "--camera 1,1.2,0.5,0 --motion 8").frames[0].rowRange(tape);
    print_message("open shutter: %.2f gray levels from straight motion, %.2f from none\n", difference(open, blurred),
                  difference(open, still));
    assert_true(difference(open, blurred) < 1);
    assert_true(difference(open, still) > 5);
}

// A camera that goes around a tape and looks at it sees it sharply: it moves and turns at the same time.
void what_is_looked_at_stays_sharp(void **)
{
    write_text("around.csv", "time_s,x_m,y_m,height_m,heading_deg\n0,1,1,0.5,5.7106\n1,1,1.4,0.5,-5.7106\n");
    const std::string scene =
        "--ids 5 --at 3,1.2,0.5,180 --fps 2 --focal 800 --size 640x240 --noise 0 --shot-noise 0 ";
    const cv::Range tape(90, 150);
    const cv::Mat still = render(scene + "--path around.csv", 3).frames[1].rowRange(tape);
    const cv::Mat open = render(scene + "--path around.csv --shutter 50ms", 3).frames[1].rowRange(tape);
    print_message("going around it: %.2f gray levels from standing still\n", difference(open, still));
    assert_true(difference(open, still) < 1.5);
}

/* ---- Time ------------------------------------------------------------------------------------------------ */

// Of all that has been run and has ended.
double processor_ms()
{
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);
    return 1e3 * static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-3 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

void measure_time(void **)
{
    constexpr int frames = 20, rounds = 3;
    write_text("rooms.json", two_rooms);
    double best_ms = 1e9;
    for (int round = 0; round < rounds; round++) {
        const double start_ms = processor_ms();
        render("--map rooms.json --camera 0.5,1.5,1,0,-25 --furnished yes --vignetting 0.3 --frames 20", frames);
        best_ms = std::min(best_ms, (processor_ms() - start_ms) / frames);
    }
    print_message("640 x 480 px: %.1f ms a frame, PNG and start of the program included\n", best_ms);
    assert_true(best_ms < 100);
}

template <CMUnitTestFunction test> void in_own_folder(void **state)
{
    try {
        const own_folder folder;
        test(state);
    } catch (const std::exception &error) {
        fail_msg("%s", error.what());
    }
}

// Debugging builds are slower by any factor.
void frames_take_little_time(void **state)
{
    if (TAPEMARK_MEASURE_TIME == 0)
        skip();
    in_own_folder<measure_time>(state);
}

}  // namespace

#define IN_OWN_FOLDER(test) {#test, in_own_folder<test>, nullptr, nullptr, nullptr}

int main()
{
    const CMUnitTest tests[] = {
        IN_OWN_FOLDER(tapes_in_a_row_are_where_the_truth_says),
        IN_OWN_FOLDER(a_row_has_its_gaps_and_its_middle),
        IN_OWN_FOLDER(distance_and_angle_are_what_was_asked_for),
        IN_OWN_FOLDER(a_room_is_read_as_its_map_says),
        IN_OWN_FOLDER(walls_hide_what_is_behind_them),
        IN_OWN_FOLDER(boxes_and_covers_take_their_share),
        IN_OWN_FOLDER(maps_of_the_inventors_are_shown),
        IN_OWN_FOLDER(aruco_pictures_are_where_the_truth_says),
        IN_OWN_FOLDER(pictures_on_the_plan_face_where_they_are_told_to),
        IN_OWN_FOLDER(a_path_moves_the_picture_as_it_should),
        IN_OWN_FOLDER(an_open_shutter_blurs_as_far_as_things_move),
        IN_OWN_FOLDER(what_is_looked_at_stays_sharp),
        cmocka_unit_test(frames_take_little_time),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
