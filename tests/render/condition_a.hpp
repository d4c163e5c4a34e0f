// The walk that the marker's inventors published, frame by frame: pictures, and where the tapes in them are.
#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <string>
#include <vector>

// A tape as a whole; corners top left, top right, bottom right, bottom left of its ink.
struct walk_tape {
    std::vector<int> ids;
    bool bars = false;
    bool whole = false;
    std::array<cv::Point2d, 4> corners;
};

struct walk_cm {
    int id = 0;
    bool whole = false;
    double px_min = 0;  // of a module
    std::array<cv::Point2d, 4> corners;
};

struct walk_frame {
    int number = 0;
    cv::Mat gray;  // only where there is a picture
    std::vector<walk_tape> tapes;
    std::vector<walk_cm> cms;
};

// The frames with these numbers. Throws std::runtime_error where the data is missing or broken.
std::vector<walk_frame> load_walk(const std::string &folder, const std::vector<int> &numbers);

// From (modules along, modules across, 1) of a tape to the picture.
cv::Matx33d homography_of(const std::array<cv::Point2d, 4> &corners, double width_modules);

double width_modules_of(const walk_tape &tape);

// The one focal length at which both directions of all tapes are at right angles, in px.
double focal_of(const std::vector<walk_frame> &frames);
