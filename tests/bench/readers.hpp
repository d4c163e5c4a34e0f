// The decoders that are compared, and the floor below which none can get, behind one interface.
#pragma once

#include "reading.hpp"

#include <opencv2/core.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

class reader {
public:
    virtual ~reader() = default;
    virtual std::string name() const = 0;
    virtual std::string settings() const = 0;
    virtual marker_kind reads() const = 0;
    // The part that is timed.
    virtual void decode(const cv::Mat &gray) = 0;
    // What the last decode() read.
    virtual std::vector<reading> readings() const { return {}; }
    // Memory that the caller hands in for frames of this size; what is taken from the heap is counted apart.
    virtual std::size_t workspace_bytes() const { return 0; }
    // Counters of the last decode(), for those that keep any.
    virtual decode_counters counters() const { return {}; }
};

// In the order of the report: tapemark, aruco, aruco-lean, apriltag, memcpy, gradient.
std::vector<std::unique_ptr<reader>> make_readers(cv::Size frame_size);
std::vector<std::string> reader_names();
