/* What a camera of libcamera can be set to. */
#ifndef PLATFORM_LIBCAMERA_MODES_HPP
#define PLATFORM_LIBCAMERA_MODES_HPP

#include "camera_mode.h"

#include <libcamera/libcamera.h>

#include <memory>
#include <vector>

/* Element i of all three belongs together. */
struct libcamera_modes {
    std::vector<camera_mode> modes;
    std::vector<libcamera::PixelFormat> formats;
    std::vector<libcamera::StreamRole> roles;
};

/* Processed pictures come first, then those of the bare sensor. Of sizes without steps, the list has the wished one
 * and those that libcamera proposes; rates it does not tell. */
libcamera_modes libcamera_list_modes(libcamera::Camera &camera, const camera_wishes &wishes);

/* The layout of frames of this mode once the camera is configured. `room_bytes` is what there is of a frame from its
 * first plane on: where the chroma does not lie right behind the luma, the frame is the luma alone. */
frame_layout libcamera_layout(const camera_mode &mode, const libcamera::StreamConfiguration &stream,
                              const libcamera::FrameBuffer &buffer, size_t room_bytes);

#endif
