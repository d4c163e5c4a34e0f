#include "condition_a.hpp"

#include <tapemark.h>

#include <cjson/cJSON.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace {

// The video is upright, its picture is not: above and below it is black.
constexpr int first_row = 548, rows = 823, columns = 1080;

using json = std::unique_ptr<cJSON, decltype(&cJSON_Delete)>;

const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(object, name);
    if (found == nullptr)
        throw std::runtime_error(std::string("truth.json: an entry lacks \"") + name + "\"");
    return found;
}

std::array<cv::Point2d, 4> corners_of(const cJSON *entry)
{
    const cJSON *list = member(entry, "corners");
    std::array<cv::Point2d, 4> corners;
    for (int i = 0; i < 4; i++) {
        const cJSON *corner = cJSON_GetArrayItem(list, i);
        if (cJSON_GetArraySize(corner) != 2)
            throw std::runtime_error("truth.json: \"corners\" are not four points");
        corners[static_cast<std::size_t>(i)] = {cJSON_GetArrayItem(corner, 0)->valuedouble,
                                                cJSON_GetArrayItem(corner, 1)->valuedouble - first_row};
    }
    return corners;
}

walk_tape tape_of(const cJSON *entry)
{
    constexpr std::size_t tm_cms_min = 3;
    walk_tape tape;
    const cJSON *id = nullptr;
    cJSON_ArrayForEach(id, member(entry, "ids")) tape.ids.push_back(id->valueint);
    tape.bars = tape.ids.size() >= tm_cms_min;
    tape.whole = cJSON_IsTrue(member(entry, "full"));
    tape.corners = corners_of(entry);
    return tape;
}

walk_cm cm_of(const cJSON *entry)
{
    walk_cm cm;
    cm.id = member(entry, "id")->valueint;
    cm.whole = cJSON_IsTrue(member(entry, "full"));
    cm.px_min = member(entry, "px_min_sv")->valuedouble;
    cm.corners = corners_of(entry);
    return cm;
}

json read_truth(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    json root(cJSON_Parse(text.c_str()), cJSON_Delete);
    if (!cJSON_IsArray(root.get()))
        throw std::runtime_error(path + ": is no JSON array");
    return root;
}

walk_frame frame_of(const cJSON *truth, int number, const cv::Mat &colour)
{
    walk_frame frame;
    frame.number = number;
    if (colour.cols != columns || colour.rows < first_row + rows)
        throw std::runtime_error("tape.mp4: is no upright video of 1080 x 1920 px");
    cv::cvtColor(colour.rowRange(first_row, first_row + rows), frame.gray, cv::COLOR_BGR2GRAY);
    const cJSON *entry = nullptr;
    cJSON_ArrayForEach(entry, member(truth, "segments")) frame.tapes.push_back(tape_of(entry));
    cJSON_ArrayForEach(entry, member(truth, "cms")) frame.cms.push_back(cm_of(entry));
    return frame;
}

}  // namespace

std::vector<walk_frame> load_walk(const std::string &folder, const std::vector<int> &numbers)
{
    const json truth = read_truth(folder + "/condition_a/truth.json");
    cv::VideoCapture video(folder + "/condition_a/tape.mp4");
    std::vector<walk_frame> frames;
    cv::Mat colour;
    for (int number = 0; video.read(colour); number++) {
        if (std::find(numbers.begin(), numbers.end(), number) == numbers.end())
            continue;
        const cJSON *entry = cJSON_GetArrayItem(truth.get(), number);
        if (entry == nullptr)
            throw std::runtime_error("truth.json: has fewer frames than the video");
        frames.push_back(frame_of(entry, number, colour));
    }
    if (frames.size() != numbers.size())
        throw std::runtime_error("tape.mp4: not all frames can be read");
    return frames;
}

double width_modules_of(const walk_tape &tape)
{
    return static_cast<double>(tapemark_segment_width_modules(tape.ids.size(), tape.bars));
}

cv::Matx33d homography_of(const std::array<cv::Point2d, 4> &corners, double width_modules)
{
    const auto width = static_cast<float>(width_modules), height = static_cast<float>(TAPEMARK_HEIGHT_MODULES);
    const std::vector<cv::Point2f> flat = {{0, 0}, {width, 0}, {width, height}, {0, height}};
    std::vector<cv::Point2f> seen;
    for (const cv::Point2d &corner : corners)
        seen.emplace_back(static_cast<float>(corner.x), static_cast<float>(corner.y));
    return cv::getPerspectiveTransform(flat, seen);
}

// With (x, y) from the middle of the picture, a right angle between the columns a and b of a homography reads
// (ax bx + ay by) / focal² + aw bw = 0. All tapes together, each weighed by how long its columns are at the focal
// length found before, give one focal length.
double focal_of(const std::vector<walk_frame> &frames)
{
    const cv::Matx33d to_middle(1, 0, -(columns - 1) / 2.0, 0, 1, -(rows - 1) / 2.0, 0, 0, 1);
    double focal_px = columns;
    for (int round = 0; round < 10; round++) {
        double above = 0, below = 0;
        for (const walk_frame &frame : frames) {
            for (const walk_tape &tape : frame.tapes) {
                if (!tape.whole)
                    continue;
                const cv::Matx33d h = to_middle * homography_of(tape.corners, width_modules_of(tape));
                const double plane = h(0, 0) * h(0, 1) + h(1, 0) * h(1, 1), depth = h(2, 0) * h(2, 1);
                const double weight = 1 / (cv::norm(cv::Vec3d(h(0, 0), h(1, 0), focal_px * h(2, 0))) *
                                           cv::norm(cv::Vec3d(h(0, 1), h(1, 1), focal_px * h(2, 1))));
                above += weight * weight * plane * plane;
                below -= weight * weight * plane * depth;
            }
        }
        focal_px = std::sqrt(above / below);
    }
    return focal_px;
}
