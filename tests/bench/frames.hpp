// The frames that the decoders are given: 8-bit gray, in memory before the clock starts.
#pragma once

#include "reading.hpp"

#include <opencv2/core.hpp>

#include <string>
#include <vector>

struct frame_range {
    int first = 0;
    int last = 99;
    int step = 1;
};

struct frame {
    cv::Mat gray;
    int number;         // within its video
    std::string label;  // of a clutter frame; empty in a video
};

struct source {
    std::string name;
    marker_kind shows;
    std::vector<frame> frames;
};

std::vector<std::string> source_names();

// Loads "tape", "aruco", "qrcode" or "stag" from DIR/condition_a/NAME.mp4, or makes the "clutter" frames.
// Throws std::runtime_error naming the file and what is wrong with it.
source load_source(const std::string &name, const std::string &data_dir, const frame_range &range);

// Fixed pictures that a camera may meet and that hold no marker: always the same, whatever the machine.
std::vector<frame> make_clutter(cv::Size size);
