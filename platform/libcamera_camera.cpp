#include "libcamera_camera.hpp"

#include "libcamera_modes.hpp"

#include <libcamera/control_ids.h>
#include <libcamera/logging.h>
#include <libcamera/property_ids.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

namespace controls = libcamera::controls;

namespace {

constexpr unsigned buffers_wanted = 4;
constexpr unsigned buffers_needed = 3;  /* one is out, one waits, one is being filled */

bool has_control(const libcamera::Camera &device, const libcamera::ControlId &id)
{
    return device.controls().find(&id) != device.controls().end();
}

} // namespace

std::shared_ptr<libcamera::CameraManager> libcamera_share_manager()
{
    static std::mutex guard;
    static std::weak_ptr<libcamera::CameraManager> shared;
    std::lock_guard<std::mutex> lock(guard);
    auto manager = shared.lock();
    if (manager)
        return manager;
    /* Its own messages would be mixed into ours; who wants them sets this variable. */
    if (std::getenv("LIBCAMERA_LOG_LEVELS") == nullptr)
        libcamera::logSetTarget(libcamera::LoggingTargetNone);
    manager = std::shared_ptr<libcamera::CameraManager>(new libcamera::CameraManager(), [](auto *ended) {
        ended->stop();
        delete ended;
    });
    if (manager->start() != 0)
        return nullptr;
    shared = manager;
    return manager;
}

bool libcamera_is_external(const libcamera::Camera &device)
{
    const auto location = device.properties().get(libcamera::properties::Location);
    return location && *location == libcamera::properties::CameraLocationExternal;
}

libcamera_camera::libcamera_camera() : camera(), event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
{
}

libcamera_camera::~libcamera_camera()
{
    if (camera_) {
        stop();
        camera_->requestCompleted.disconnect();
        camera_->disconnected.disconnect();
        configuration_.reset();
        camera_->release();
        camera_.reset();
    }
    jpeg_frame_release(&jpeg_);
    if (event_ >= 0)
        close(event_);
}

/* ---- Open and configure --------------------------------------------------------------------------------- */

bool libcamera_camera::open(const std::string &wanted, error_text *error)
{
    manager_ = libcamera_share_manager();
    if (!manager_ || event_ < 0) {
        error_text_set(error, "libcamera does not start");
        return false;
    }
    const auto cameras = manager_->cameras();
    const bool is_number = !wanted.empty() && wanted.size() < 6 &&
                           wanted.find_first_not_of("0123456789") == std::string::npos;
    const size_t number = is_number ? std::stoul(wanted) : cameras.size();
    auto found = number < cameras.size() ? cameras[number] : manager_->get(wanted);
    if (!found) {
        error_text_set(error, "libcamera sees %zu cameras, and '%.80s' is none of them", cameras.size(),
                       wanted.c_str());
        return false;
    }
    if (found->acquire() != 0) {
        error_text_set(error, "is used by another program");
        return false;
    }
    camera_ = found;
    camera_->requestCompleted.connect(this, &libcamera_camera::completed);
    camera_->disconnected.connect(this, &libcamera_camera::disconnected);
    return true;
}

bool libcamera_camera::check_light(const camera_wishes &wishes, error_text *error) const
{
    if (wishes.exposure_us > 0 && !has_control(*camera_, controls::ExposureTime))
        error_text_set(error, "has no control for the exposure; leave it to the camera");
    else if (wishes.gain > 0 && !has_control(*camera_, controls::AnalogueGain))
        error_text_set(error, "has no control for the gain; leave it to the camera");
    else
        return true;
    return false;
}

bool libcamera_camera::set_format(const camera_wishes &wishes, error_text *error)
{
    const libcamera_modes list = libcamera_list_modes(*camera_, wishes);
    const camera_mode *chosen = camera_mode_choose(list.modes.data(), list.modes.size(), &wishes, error);
    if (chosen == nullptr)
        return false;
    const size_t index = static_cast<size_t>(chosen - list.modes.data());
    settings.mode = *chosen;
    libcamera::Size size(static_cast<unsigned>(chosen->width_px), static_cast<unsigned>(chosen->height_px));
    if (wishes.region.width_px > 0)
        size = {static_cast<unsigned>(wishes.region.width_px), static_cast<unsigned>(wishes.region.height_px)};

    configuration_ = camera_->generateConfiguration({list.roles[index]});
    libcamera::StreamConfiguration &stream = configuration_->at(0);
    stream.pixelFormat = list.formats[index];
    stream.size = size;
    stream.bufferCount = buffers_wanted;
    if (configuration_->validate() == libcamera::CameraConfiguration::Invalid ||
        stream.pixelFormat != list.formats[index]) {
        error_text_set(error, "does not give %s after all", camera_mode_format(chosen));
        return false;
    }
    if (stream.size != size && (wishes.width_px > 0 || wishes.region.width_px > 0)) {
        error_text_set(error, "answers with %ux%u px instead of %ux%u", stream.size.width, stream.size.height,
                       size.width, size.height);
        return false;
    }
    if (camera_->configure(configuration_.get()) != 0) {
        error_text_set(error, "cannot be set to %s:%ux%u", camera_mode_format(chosen), size.width, size.height);
        return false;
    }
    return true;
}

bool libcamera_camera::make_requests(error_text *error)
{
    libcamera::StreamConfiguration &stream = configuration_->at(0);
    /* USB cameras are written to memory by the processor: that is cached anyway. */
    if (!buffers_.allocate(camera_, stream, !libcamera_is_external(*camera_)) || buffers_.count() < buffers_needed) {
        error_text_set(error, "has not enough memory for its frames");
        return false;
    }
    layout_ = libcamera_layout(settings.mode, stream, *buffers_.buffer(0), buffers_.size(0));
    const size_t bytes = settings.mode.jpeg ? 1 : frame_layout_size_bytes(&layout_);
    for (size_t i = 0; i < buffers_.count(); i++) {
        auto request = camera_->createRequest(i);
        if (bytes == 0 || buffers_.size(i) < bytes || !request ||
            request->addBuffer(stream.stream(), buffers_.buffer(i)) != 0) {
            error_text_set(error, "gives no buffers that hold a frame");
            return false;
        }
        requests_.push_back(std::move(request));
    }
    return true;
}

/* A region is told in pixels of the whole picture, and libcamera counts the sensor's. */
bool libcamera_camera::add_region(const camera_region &region, libcamera::ControlList &list, error_text *error)
{
    if (region.width_px == 0)
        return true;
    const auto known = camera_->controls().find(&controls::ScalerCrop);
    if (known == camera_->controls().end()) {
        error_text_set(error, "cannot give a region of its picture: the device does not crop");
        return false;
    }
    const auto whole = known->second.max().get<libcamera::Rectangle>();
    const double scale_x = static_cast<double>(whole.width) / settings.mode.width_px;
    const double scale_y = static_cast<double>(whole.height) / settings.mode.height_px;
    list.set(controls::ScalerCrop,
             libcamera::Rectangle(whole.x + static_cast<int>(std::lround(region.x_px * scale_x)),
                                  whole.y + static_cast<int>(std::lround(region.y_px * scale_y)),
                                  static_cast<unsigned>(std::lround(region.width_px * scale_x)),
                                  static_cast<unsigned>(std::lround(region.height_px * scale_y))));
    return true;
}

bool libcamera_camera::start(const camera_wishes &wishes, error_text *error)
{
    libcamera::ControlList list(controls::controls);
    libcamera_set_light(list, camera_->controls(), wishes.exposure_us, static_cast<float>(wishes.gain));
    if (!add_region(wishes.region, list, error))
        return false;
    if (wishes.rate_hz > 0 && has_control(*camera_, controls::FrameDurationLimits)) {
        const int64_t frame_us = std::llround(1e6 / wishes.rate_hz);
        list.set(controls::FrameDurationLimits, libcamera::Span<const int64_t, 2>({frame_us, frame_us}));
        settings.mode.rate_hz = wishes.rate_hz;
    }
    settings.mode.width_px = layout_.width_px;
    settings.mode.height_px = layout_.height_px;
    settings.exposure_us = wishes.exposure_us;
    settings.gain = wishes.gain;
    settings.region = wishes.region;
    camera_restart_numbers(this);
    last_sign_ns_ = camera_clock_ns();
    if (camera_->start(&list) != 0) {
        error_text_set(error, "does not start");
        return false;
    }
    running_ = true;
    for (auto &request : requests_)
        camera_->queueRequest(request.get());
    return true;
}

/* libcamera 0.0.3 ends the whole program when a camera is stopped that was unplugged, and libcamera has not heard so
 * yet. When no frames come any more that may be why: then it gets the time to hear. */
bool libcamera_camera::is_gone_for_sure()
{
    constexpr std::chrono::seconds time_to_hear(3);
    constexpr int64_t silence_ns = 500000000;
    std::unique_lock<std::mutex> lock(guard_);
    const int64_t last_sign_ns = last_sign_ns_;
    if (camera_clock_ns() - last_sign_ns > silence_ns)
        changed_.wait_for(lock, time_to_hear,
                          [this, last_sign_ns] { return gone_ || last_sign_ns_ != last_sign_ns; });
    return gone_;
}

/* No request completes once the camera has stopped, or is gone. */
void libcamera_camera::stop()
{
    if (held_ != nullptr)
        buffers_.end_reading(held_->cookie());
    if (running_ && !is_gone_for_sure())
        camera_->stop();
    running_ = false;
    held_ = nullptr;
    latest_ = nullptr;
    requests_.clear();
    buffers_.release();
}

bool libcamera_camera::configure(const camera_wishes &wishes, error_text *error)
{
    stop();
    if (check_light(wishes, error) && set_format(wishes, error) && make_requests(error) && start(wishes, error))
        return true;
    stop();
    return false;
}

bool libcamera_camera::set_light(int32_t exposure_us, double gain, error_text *error)
{
    camera_wishes wishes = {};
    wishes.exposure_us = exposure_us;
    wishes.gain = gain;
    if (!running_) {
        error_text_set(error, "is not set up");
        return false;
    }
    if (!check_light(wishes, error))
        return false;
    std::lock_guard<std::mutex> lock(guard_);
    changes_.clear();
    libcamera_set_light(changes_, camera_->controls(), exposure_us, static_cast<float>(gain));
    settings.exposure_us = exposure_us;
    settings.gain = gain;
    return true;
}

/* ---- Frames --------------------------------------------------------------------------------------------- */

void libcamera_camera::raise_event() const
{
    const uint64_t one = 1;
    /* It can only fail when it is readable already. */
    if (write(event_, &one, sizeof one) < 0)
        return;
}

/* With the guard held. */
void libcamera_camera::queue(libcamera::Request *request)
{
    request->reuse(libcamera::Request::ReuseBuffers);
    for (const auto &change : changes_)
        request->controls().set(change.first, change.second);
    changes_.clear();
    camera_->queueRequest(request);
}

/* On libcamera's thread: the newest frame takes the place of the one that waits. */
void libcamera_camera::completed(libcamera::Request *request)
{
    if (request->status() == libcamera::Request::RequestCancelled)
        return;
    std::lock_guard<std::mutex> lock(guard_);
    last_sign_ns_ = camera_clock_ns();
    changed_.notify_one();
    if (buffers_.buffer(request->cookie())->metadata().status != libcamera::FrameMetadata::FrameSuccess) {
        damaged_++;
        passed_over_++;
        queue(request);
        return;
    }
    if (latest_ != nullptr) {
        passed_over_++;
        queue(latest_);
    }
    latest_ = request;
    raise_event();
}

/* On libcamera's thread. */
void libcamera_camera::disconnected()
{
    std::lock_guard<std::mutex> lock(guard_);
    gone_ = true;
    changed_.notify_one();
    raise_event();
}

libcamera::Request *libcamera_camera::take_latest(bool *gone)
{
    std::lock_guard<std::mutex> lock(guard_);
    uint64_t ignored;
    libcamera::Request *taken = latest_;
    latest_ = nullptr;
    numbers.passed_over += passed_over_;
    counts.damaged += damaged_;
    passed_over_ = 0;
    damaged_ = 0;
    *gone = gone_ && taken == nullptr;
    /* Once the camera is gone it stays readable. */
    if (!gone_ && read(event_, &ignored, sizeof ignored) < 0)
        return taken;
    return taken;
}

bool libcamera_camera::hand_out(libcamera::Request *request, camera_frame *output)
{
    const size_t index = request->cookie();
    const libcamera::FrameMetadata &buffer = buffers_.buffer(index)->metadata();
    const auto &metadata = request->metadata();
    const auto stamp = metadata.get(controls::SensorTimestamp);
    const auto exposure = metadata.get(controls::ExposureTime);
    const int64_t start_ns = stamp ? *stamp : static_cast<int64_t>(buffer.timestamp);
    const size_t used = buffer.planes().size() > 0 ? buffer.planes()[0].bytesused : 0;

    held_ = request;
    buffers_.begin_reading(index);
    *output = {};
    output->exposure_us = exposure ? *exposure : settings.exposure_us;
    output->image.layout = layout_;
    output->image.data = buffers_.bytes(index);
    output->image.time_ns = camera_normal_time_ns(start_ns) + int64_t{output->exposure_us} * 500;

    bool whole = used >= layout_.stride_bytes * static_cast<size_t>(layout_.height_px);
    if (settings.mode.jpeg) {
        whole = used <= buffers_.size(index) && jpeg_frame_decode(&jpeg_, output->image.data, used, &layout_);
        output->image.data = jpeg_.picture.pixels;
    }
    if (!whole) {
        counts.damaged++;
        camera_pass_over(this);
        release();
        return false;
    }
    camera_count_frame(this, buffer.sequence, output);
    return true;
}

camera_status libcamera_camera::next(int timeout_ms, camera_frame *output, error_text *error)
{
    const int64_t deadline_ns = camera_clock_ns() + int64_t{timeout_ms} * 1000000;
    if (!running_) {
        error_text_set(error, "is not set up");
        return CAMERA_FAILED;
    }
    for (;;) {
        bool gone;
        libcamera::Request *request = take_latest(&gone);
        if (request != nullptr && hand_out(request, output))
            return CAMERA_FRAME;
        if (gone) {
            error_text_set(error, "is gone: it was unplugged, or its driver was removed");
            return CAMERA_GONE;
        }
        const int left_ms = camera_left_ms(deadline_ns);
        pollfd waiting = {event_, POLLIN, 0};
        if (left_ms == 0 || poll(&waiting, 1, left_ms) == 0)
            return CAMERA_TIMEOUT;
    }
}

void libcamera_camera::release()
{
    if (held_ == nullptr)
        return;
    buffers_.end_reading(held_->cookie());
    std::lock_guard<std::mutex> lock(guard_);
    queue(held_);
    held_ = nullptr;
}
