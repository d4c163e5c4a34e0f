/* libcamera behind the C interface of cameras. No exception leaves this file. */
#include "libcamera_camera.hpp"
#include "libcamera_modes.hpp"

#include <libcamera/property_ids.h>

#include <exception>

namespace {

libcamera_camera *self(camera *device)
{
    return static_cast<libcamera_camera *>(device);
}

bool fail(error_text *error, const std::exception &reason)
{
    error_text_set(error, "libcamera fails: %.200s", reason.what());
    return false;
}

bool configure(camera *device, const camera_wishes *wishes, error_text *error)
{
    try {
        return self(device)->configure(*wishes, error);
    } catch (const std::exception &reason) {
        return fail(error, reason);
    }
}

bool set_light(camera *device, int32_t exposure_us, double gain, error_text *error)
{
    try {
        return self(device)->set_light(exposure_us, gain, error);
    } catch (const std::exception &reason) {
        return fail(error, reason);
    }
}

camera_status next(camera *device, int timeout_ms, camera_frame *output, error_text *error)
{
    try {
        return self(device)->next(timeout_ms, output, error);
    } catch (const std::exception &reason) {
        fail(error, reason);
        return CAMERA_FAILED;
    }
}

void release(camera *device)
{
    self(device)->release();
}

int descriptor(const camera *device)
{
    return static_cast<const libcamera_camera *>(device)->event();
}

void close_camera(camera *device)
{
    delete self(device);
}

const camera_methods methods = {configure, set_light, next, release, descriptor, close_camera};

void tell_of(const std::shared_ptr<libcamera::Camera> &camera, size_t number, camera_teller tell, void *context)
{
    const libcamera_modes list = libcamera_list_modes(*camera, camera_wishes{});
    const auto model = camera->properties().get(libcamera::properties::Model);
    const std::string name = "libcamera:" + std::to_string(number);
    const std::string label = model ? std::string(*model) : camera->id();
    if (list.modes.empty())
        return;
    const camera_description description = {name.c_str(), label.c_str(), list.modes.data(), list.modes.size()};
    tell(context, &description);
}

} // namespace

extern "C" camera *camera_libcamera_open(const char *name, error_text *error)
{
    try {
        auto opened = std::make_unique<libcamera_camera>();
        opened->methods = &methods;
        return opened->open(name, error) ? opened.release() : nullptr;
    } catch (const std::exception &reason) {
        fail(error, reason);
        return nullptr;
    }
}

extern "C" void camera_libcamera_list(bool built_in, camera_teller tell, void *context)
{
    try {
        const auto manager = libcamera_share_manager();
        if (!manager)
            return;
        const auto cameras = manager->cameras();
        for (size_t i = 0; i < cameras.size(); i++)
            if (libcamera_is_external(*cameras[i]) != built_in)
                tell_of(cameras[i], i, tell, context);
    } catch (const std::exception &) {
        /* Cameras that libcamera fails on are none that can be used. */
    }
}
