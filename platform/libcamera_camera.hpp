/* A camera of libcamera: it fills requests on a thread of its own, and the newest one waits for us. */
#ifndef PLATFORM_LIBCAMERA_CAMERA_HPP
#define PLATFORM_LIBCAMERA_CAMERA_HPP

#include "camera_backend.h"
#include "jpeg_frame.h"
#include "libcamera_buffers.hpp"
#include "libcamera_versions.hpp"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

/* There may be one manager in a process at a time; whoever needs it shares it. NULL when libcamera does not start. */
std::shared_ptr<libcamera::CameraManager> libcamera_share_manager();

/* USB cameras and the like, which are not part of the machine. */
bool libcamera_is_external(const libcamera::Camera &device);

class libcamera_camera : public camera {
public:
    libcamera_camera();
    ~libcamera_camera();
    bool open(const std::string &wanted, error_text *error);
    bool configure(const camera_wishes &wishes, error_text *error);
    bool set_light(int32_t exposure_us, double gain, error_text *error);
    camera_status next(int timeout_ms, camera_frame *output, error_text *error);
    void release();
    int event() const { return event_; }

private:
    bool check_light(const camera_wishes &wishes, error_text *error) const;
    bool set_format(const camera_wishes &wishes, error_text *error);
    bool make_requests(error_text *error);
    bool add_region(const camera_region &region, libcamera::ControlList &list, error_text *error);
    bool start(const camera_wishes &wishes, error_text *error);
    bool is_gone_for_sure();
    void stop();
    void queue(libcamera::Request *request);
    void completed(libcamera::Request *request);
    void disconnected();
    void raise_event() const;
    libcamera::Request *take_latest(bool *gone);
    bool hand_out(libcamera::Request *request, camera_frame *output);

    std::shared_ptr<libcamera::CameraManager> manager_;
    std::shared_ptr<libcamera::Camera> camera_;
    std::unique_ptr<libcamera::CameraConfiguration> configuration_;
    libcamera_buffers buffers_;
    std::vector<std::unique_ptr<libcamera::Request>> requests_;
    frame_layout layout_ = {};
    jpeg_frame jpeg_ = {};
    libcamera::Request *held_ = nullptr;
    int event_;  /* readable while a request waits, and once the camera is gone */
    bool running_ = false;

    std::mutex guard_;  /* of all below, which libcamera's thread uses as well */
    libcamera::Request *latest_ = nullptr;
    uint32_t passed_over_ = 0;
    uint32_t damaged_ = 0;
    libcamera::ControlList changes_{libcamera::controls::controls};
    int64_t last_sign_ns_ = 0;  /* when a request completed last, or the camera started */
    bool gone_ = false;
    std::condition_variable changed_;  /* last_sign_ns_ or gone_ */
};

#endif
