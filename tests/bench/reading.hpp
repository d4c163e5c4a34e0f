// What a decoder read in one frame, whichever decoder it was.
#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>
#include <string>

enum class marker_kind { none, tape, aruco, apriltag };

struct reading {
    int id = 0;             // of a single marker
    std::string code;       // of a tape marker; empty for a single marker
    bool directed = true;   // false: the code may as well read backwards
    std::array<cv::Point2f, 4> corners;
};

struct decode_counters {
    std::uint32_t work = 0;    // pixel reads after the first pass
    std::uint32_t limits = 0;  // TAPEMARK_LIMIT_* bits
};
