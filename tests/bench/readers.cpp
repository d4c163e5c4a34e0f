#include "readers.hpp"

#include <tapemark.h>

#include <opencv2/aruco.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace {

class tapemark_reader : public reader {
public:
    explicit tapemark_reader(cv::Size size)
        : workspace_(tapemark_workspace_bytes(size.width, size.height)), cms_(128), tms_(16)
    {
    }
    std::string name() const override { return "tapemark"; }
    std::string settings() const override
    {
        return std::string("version ") + tapemark_version() + ", defaults, no map";
    }
    marker_kind reads() const override { return marker_kind::tape; }
    std::size_t workspace_bytes() const override { return workspace_.size(); }
    decode_counters counters() const override { return {result_.stats.work, result_.stats.limits}; }

    void decode(const cv::Mat &gray) override
    {
        const tapemark_image image = {gray.data, gray.cols, gray.rows, static_cast<std::ptrdiff_t>(gray.step[0])};
        result_.cms = cms_.data();
        result_.cm_capacity = cms_.size();
        result_.tms = tms_.data();
        result_.tm_capacity = tms_.size();
        const tapemark_status status =
            tapemark_decode(&image, nullptr, workspace_.data(), workspace_.size(), &result_);
        if (status < 0)
            throw std::runtime_error(std::string("tapemark_decode: ") + tapemark_status_text(status));
    }

    std::vector<reading> readings() const override
    {
        std::vector<reading> all;
        for (std::size_t i = 0; i < result_.cm_count; i++)
            all.push_back({cms_[i].id, "", true, points(cms_[i].corners)});
        for (std::size_t i = 0; i < result_.tm_count; i++)
            all.push_back({0, tms_[i].code, tms_[i].directed, points(tms_[i].corners)});
        return all;
    }

private:
    static std::array<cv::Point2f, 4> points(const tapemark_point corners[4])
    {
        std::array<cv::Point2f, 4> out;
        for (std::size_t i = 0; i < 4; i++)
            out[i] = {corners[i].x_px, corners[i].y_px};
        return out;
    }

    std::vector<std::uint8_t> workspace_;
    std::vector<tapemark_cm> cms_;
    std::vector<tapemark_tm> tms_;
    tapemark_result result_ = {};
};

// OpenCV's detector, with its defaults or leaner: the defaults threshold the frame with three windows, of which
// the one of 13 px alone reads as much of the paper's video in a third of the time.
class aruco_reader : public reader {
public:
    explicit aruco_reader(bool lean)
        : lean_(lean), dictionary_(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100)),
          parameters_(cv::aruco::DetectorParameters::create())
    {
        if (lean) {
            parameters_->adaptiveThreshWinSizeMin = 13;
            parameters_->adaptiveThreshWinSizeMax = 13;
        }
    }
    std::string name() const override { return lean_ ? "aruco-lean" : "aruco"; }
    std::string settings() const override
    {
        return std::string("OpenCV " CV_VERSION ", DICT_5X5_100, ") +
               (lean_ ? "one threshold window of 13 px" : "defaults");
    }
    marker_kind reads() const override { return marker_kind::aruco; }

    void decode(const cv::Mat &gray) override
    {
        cv::aruco::detectMarkers(gray, dictionary_, corners_, ids_, parameters_);
    }

    std::vector<reading> readings() const override
    {
        std::vector<reading> all;
        for (std::size_t i = 0; i < ids_.size(); i++) {
            reading one;
            one.id = ids_[i];
            std::copy_n(corners_[i].begin(), 4, one.corners.begin());
            all.push_back(one);
        }
        return all;
    }

private:
    bool lean_;
    cv::Ptr<cv::aruco::Dictionary> dictionary_;
    cv::Ptr<cv::aruco::DetectorParameters> parameters_;
    std::vector<std::vector<cv::Point2f>> corners_;
    std::vector<int> ids_;
};

class apriltag_reader : public reader {
public:
    apriltag_reader() : family_(tag36h11_create()), detector_(apriltag_detector_create())
    {
        apriltag_detector_add_family(detector_, family_);
        detector_->nthreads = 1;
    }
    ~apriltag_reader() override
    {
        release();
        apriltag_detector_destroy(detector_);
        tag36h11_destroy(family_);
    }
    apriltag_reader(const apriltag_reader &) = delete;
    apriltag_reader &operator=(const apriltag_reader &) = delete;
    std::string name() const override { return "apriltag"; }
    std::string settings() const override { return "libapriltag, tag36h11, defaults (frames halved to find quads)"; }
    marker_kind reads() const override { return marker_kind::apriltag; }

    void decode(const cv::Mat &gray) override
    {
        release();
        image_u8_t image = {gray.cols, gray.rows, static_cast<std::int32_t>(gray.step[0]), gray.data};
        detections_ = apriltag_detector_detect(detector_, &image);
    }

    std::vector<reading> readings() const override
    {
        std::vector<reading> all;
        for (int i = 0; i < zarray_size(detections_); i++) {
            apriltag_detection_t *detection = nullptr;
            zarray_get(detections_, i, &detection);
            reading one;
            one.id = detection->id;
            for (std::size_t k = 0; k < 4; k++)
                one.corners[k] = cv::Point2f(static_cast<float>(detection->p[k][0]),
                                             static_cast<float>(detection->p[k][1]));
            all.push_back(one);
        }
        return all;
    }

private:
    void release()
    {
        if (detections_ != nullptr)
            apriltag_detections_destroy(detections_);
        detections_ = nullptr;
    }

    apriltag_family_t *family_;
    apriltag_detector_t *detector_;
    zarray_t *detections_ = nullptr;
};

// A pass over the frame writes as many bytes as it reads, into memory that is there from the start.
class floor_reader : public reader {
public:
    explicit floor_reader(cv::Size size) : out_(size.height, size.width, CV_8UC1, cv::Scalar(0)) {}
    marker_kind reads() const override { return marker_kind::none; }

protected:
    cv::Mat out_;
};

class memcpy_reader : public floor_reader {
public:
    using floor_reader::floor_reader;
    std::string name() const override { return "memcpy"; }
    std::string settings() const override { return "the frame copied once"; }
    void decode(const cv::Mat &gray) override
    {
        std::memcpy(out_.data, gray.data, gray.total());
    }
};

class gradient_reader : public floor_reader {
public:
    using floor_reader::floor_reader;
    std::string name() const override { return "gradient"; }
    std::string settings() const override { return "mean of |dx| and |dy| at every pixel"; }
    void decode(const cv::Mat &gray) override
    {
        for (int y = 1; y < gray.rows - 1; y++)
            gradient_row(gray.ptr(y - 1), gray.ptr(y), gray.ptr(y + 1), gray.cols, out_.ptr(y));
    }

private:
    static std::uint8_t distance(std::uint8_t a, std::uint8_t b)
    {
        return static_cast<std::uint8_t>(std::max(a, b) - std::min(a, b));
    }

    // In bytes throughout, as compilers turn that into vector instructions.
    static void gradient_row(const std::uint8_t *above, const std::uint8_t *row, const std::uint8_t *below, int width,
                             std::uint8_t *__restrict out)
    {
        for (int x = 1; x < width - 1; x++) {
            const std::uint8_t along = distance(row[x + 1], row[x - 1]);
            const std::uint8_t across = distance(below[x], above[x]);
            out[x] = static_cast<std::uint8_t>((along + across + 1) >> 1);
        }
    }
};

}  // namespace

std::vector<std::string> reader_names()
{
    return {"tapemark", "aruco", "aruco-lean", "apriltag", "memcpy", "gradient"};
}

std::vector<std::unique_ptr<reader>> make_readers(cv::Size frame_size)
{
    std::vector<std::unique_ptr<reader>> all;
    all.push_back(std::make_unique<tapemark_reader>(frame_size));
    all.push_back(std::make_unique<aruco_reader>(false));
    all.push_back(std::make_unique<aruco_reader>(true));
    all.push_back(std::make_unique<apriltag_reader>());
    all.push_back(std::make_unique<memcpy_reader>(frame_size));
    all.push_back(std::make_unique<gradient_reader>(frame_size));
    return all;
}
