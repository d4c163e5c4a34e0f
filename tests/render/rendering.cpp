#include "rendering.hpp"

#include <cjson/cJSON.h>
#include <opencv2/imgcodecs.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <unistd.h>

namespace {

double number(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsNumber(value))
        throw std::runtime_error(std::string("truth: \"") + name + "\" is no number");
    return value->valuedouble;
}

true_marker marker_of(const cJSON *entry)
{
    true_marker marker;
    if (cJSON_HasObjectItem(entry, "id"))
        marker.id = static_cast<int>(number(entry, "id"));
    else if (cJSON_HasObjectItem(entry, "picture"))
        marker.id = static_cast<int>(number(entry, "picture"));
    marker.whole = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(entry, "full"));
    marker.px_min = number(entry, "px_min_sv");
    marker.px_along = number(entry, "px_along");
    marker.visible = number(entry, "vis_frac");
    marker.outside = number(entry, "outside");
    marker.covered = number(entry, "covered");
    marker.hidden = number(entry, "hidden");
    marker.distance_m = number(entry, "distance_m");
    marker.angle_deg = number(entry, "angle_deg");
    const cJSON *corners = cJSON_GetObjectItemCaseSensitive(entry, "corners");
    for (int i = 0; i < 4; i++) {
        const cJSON *corner = cJSON_GetArrayItem(corners, i);
        if (cJSON_GetArraySize(corners) != 4 || cJSON_GetArraySize(corner) != 2)
            throw std::runtime_error("truth: \"corners\" are not four points");
        marker.corners[static_cast<std::size_t>(i)] = {cJSON_GetArrayItem(corner, 0)->valuedouble,
                                                       cJSON_GetArrayItem(corner, 1)->valuedouble};
    }
    return marker;
}

std::vector<true_marker> markers_of(const cJSON *frame, const char *name)
{
    std::vector<true_marker> markers;
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(frame, name), *entry = nullptr;
    if (!cJSON_IsArray(list))
        throw std::runtime_error(std::string("truth: \"") + name + "\" is no array");
    cJSON_ArrayForEach(entry, list) markers.push_back(marker_of(entry));
    return markers;
}

true_frame frame_of(const std::string &line, std::size_t index)
{
    const std::unique_ptr<cJSON, decltype(&cJSON_Delete)> frame(cJSON_Parse(line.c_str()), cJSON_Delete);
    if (!cJSON_IsObject(frame.get()) || number(frame.get(), "frame") != static_cast<double>(index))
        throw std::runtime_error("truth: a line is not the object of its frame");
    return {number(frame.get(), "time_s"), markers_of(frame.get(), "cms"), markers_of(frame.get(), "segments"),
            markers_of(frame.get(), "pictures")};
}

}  // namespace

own_folder::own_folder() : path_("/tmp/tapemark-render-XXXXXX")
{
    if (mkdtemp(path_.data()) == nullptr || chdir(path_.c_str()) != 0)
        throw std::runtime_error("no folder of its own");
}

own_folder::~own_folder()
{
    std::error_code ignored;
    std::filesystem::current_path("/", ignored);
    std::filesystem::remove_all(path_, ignored);
}

void write_text(const std::string &path, const std::string &text)
{
    std::ofstream(path, std::ios::binary) << text;
}

view render(const std::string &options, int frame_count)
{
    const std::string command = std::string(TAPEMARK_RENDER) + " --truth seen.jsonl -o seen.png " + options;
    if (std::system(command.c_str()) != 0)
        throw std::runtime_error(command);
    view seen;
    for (int frame = 0; frame < frame_count; frame++) {
        char name[32] = "seen.png";
        if (frame_count > 1)
            std::snprintf(name, sizeof name, "seen-%04d.png", frame);
        seen.frames.push_back(cv::imread(name, cv::IMREAD_UNCHANGED));
        if (seen.frames.back().type() != CV_8UC1)
            throw std::runtime_error(std::string(name) + ": is no gray picture");
    }
    std::ifstream lines("seen.jsonl");
    for (std::string line; std::getline(lines, line);)
        seen.truth.push_back(frame_of(line, seen.truth.size()));
    if (seen.truth.size() != seen.frames.size())
        throw std::runtime_error("truth: not a line a frame");
    return seen;
}
