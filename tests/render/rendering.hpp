// What the tests of whole views share: the program is run in a folder of its own, and what it wrote is looked at.
#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <string>
#include <vector>

// Of a CM, a tape or a picture; corners top left, top right, bottom right, bottom left.
struct true_marker {
    int id = 0;
    bool whole = false;
    double px_min = 0, px_along = 0, visible = 0, outside = 0, covered = 0, hidden = 0, distance_m = 0, angle_deg = 0;
    std::array<cv::Point2d, 4> corners;
};

struct true_frame {
    double time_s = 0;
    std::vector<true_marker> cms, tapes, pictures;
};

struct view {
    std::vector<cv::Mat> frames;
    std::vector<true_frame> truth;
};

// A folder that is the working directory, and is removed in the end.
class own_folder {
public:
    own_folder();
    ~own_folder();
    own_folder(const own_folder &) = delete;
    own_folder &operator=(const own_folder &) = delete;

private:
    std::string path_;
};

void write_text(const std::string &path, const std::string &text);

// Runs tapemark-render with these options. Throws std::runtime_error when it fails or its output makes no sense.
view render(const std::string &options, int frame_count = 1);
