#include "frames.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace {

const cv::Size clutter_size(1080, 1920);

std::vector<frame> read_video(const std::string &path, const frame_range &range)
{
    // A decoder that works ahead in threads of its own would take time from what is measured.
    setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "threads;1", 1);
    if (!std::filesystem::is_regular_file(path))
        throw std::runtime_error(path + ": no such file");
    cv::VideoCapture video(path, cv::CAP_FFMPEG);
    if (!video.isOpened())
        throw std::runtime_error(path + ": not a video that OpenCV can read");
    std::vector<frame> frames;
    cv::Mat colour;
    for (int number = 0; number <= range.last && video.grab(); number++) {
        if (number < range.first || (number - range.first) % range.step != 0)
            continue;
        if (!video.retrieve(colour))
            throw std::runtime_error(path + ": frame " + std::to_string(number) + " cannot be decoded");
        cv::Mat gray;
        cv::cvtColor(colour, gray, cv::COLOR_BGR2GRAY);
        frames.push_back({gray, number, ""});
    }
    if (frames.empty())
        throw std::runtime_error(path + ": holds none of the frames asked for");
    return frames;
}

marker_kind shown_in(const std::string &name)
{
    if (name == "tape")
        return marker_kind::tape;
    return name == "aruco" ? marker_kind::aruco : marker_kind::none;
}

}  // namespace

std::vector<std::string> source_names()
{
    return {"tape", "aruco", "qrcode", "stag", "clutter"};
}

source load_source(const std::string &name, const std::string &data_dir, const frame_range &range)
{
    if (name == "clutter")
        return {name, marker_kind::none, make_clutter(clutter_size)};
    return {name, shown_in(name), read_video(data_dir + "/condition_a/" + name + ".mp4", range)};
}
