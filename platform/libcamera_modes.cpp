#include "libcamera_modes.hpp"

#include <libcamera/formats.h>

namespace formats = libcamera::formats;

namespace {

struct coding {
    libcamera::PixelFormat name;
    pixel_format format;
    bool jpeg;
};

const coding codings[] = {
    {formats::R8, PIXEL_GREY, false},
    {formats::R10, PIXEL_Y10, false},
    {formats::R10_CSI2P, PIXEL_Y10P, false},
    {formats::R12, PIXEL_Y12, false},
    {formats::YUV420, PIXEL_YU12, false},
    {formats::NV12, PIXEL_NV12, false},
    {formats::YUYV, PIXEL_YUYV, false},
    {formats::UYVY, PIXEL_UYVY, false},
    {formats::SRGGB8, PIXEL_SRGGB8, false},
    {formats::SGRBG8, PIXEL_SGRBG8, false},
    {formats::SGBRG8, PIXEL_SGBRG8, false},
    {formats::SBGGR8, PIXEL_SBGGR8, false},
    {formats::SRGGB10, PIXEL_SRGGB10, false},
    {formats::SGRBG10, PIXEL_SGRBG10, false},
    {formats::SGBRG10, PIXEL_SGBRG10, false},
    {formats::SBGGR10, PIXEL_SBGGR10, false},
    {formats::SRGGB10_CSI2P, PIXEL_SRGGB10P, false},
    {formats::SGRBG10_CSI2P, PIXEL_SGRBG10P, false},
    {formats::SGBRG10_CSI2P, PIXEL_SGBRG10P, false},
    {formats::SBGGR10_CSI2P, PIXEL_SBGGR10P, false},
    {formats::MJPEG, PIXEL_GREY, true},
};

const coding *coding_of(const libcamera::PixelFormat &name)
{
    for (const coding &one : codings)
        if (one.name == name)
            return &one;
    return nullptr;
}

void add_size(libcamera_modes &list, const coding &how, libcamera::StreamRole role, const libcamera::Size &size)
{
    if (size.width < 1 || size.width > FRAME_SIDE_MAX_PX || size.height < 1 || size.height > FRAME_SIDE_MAX_PX)
        return;
    list.modes.push_back({how.format, how.jpeg, static_cast<int32_t>(size.width),
                          static_cast<int32_t>(size.height), 0});
    list.formats.push_back(how.name);
    list.roles.push_back(role);
}

void add_role(libcamera_modes &list, libcamera::Camera &camera, libcamera::StreamRole role,
              const camera_wishes &wishes)
{
    auto configuration = camera.generateConfiguration({role});
    if (!configuration || configuration->size() == 0)
        return;
    const libcamera::StreamConfiguration &stream = configuration->at(0);
    const libcamera::Size wished(static_cast<unsigned>(wishes.width_px), static_cast<unsigned>(wishes.height_px));
    for (const auto &name : stream.formats().pixelformats()) {
        const coding *how = coding_of(name);
        if (how == nullptr)
            continue;
        for (const auto &size : stream.formats().sizes(name))
            add_size(list, *how, role, size);
        if (wishes.width_px > 0 && stream.formats().range(name).contains(wished))
            add_size(list, *how, role, wished);
    }
}

} // namespace

libcamera_modes libcamera_list_modes(libcamera::Camera &camera, const camera_wishes &wishes)
{
    libcamera_modes list;
    add_role(list, camera, libcamera::StreamRole::VideoRecording, wishes);
    add_role(list, camera, libcamera::StreamRole::Raw, wishes);
    return list;
}

frame_layout libcamera_layout(const camera_mode &mode, const libcamera::StreamConfiguration &stream,
                              const libcamera::FrameBuffer &buffer, size_t room_bytes)
{
    frame_layout layout = {mode.format, static_cast<int32_t>(stream.size.width),
                           static_cast<int32_t>(stream.size.height), stream.stride};
    if (mode.jpeg) {
        layout.stride_bytes = stream.size.width;
        return layout;
    }
    if (layout.stride_bytes == 0)
        layout.stride_bytes = frame_layout_least_stride(layout.format, layout.width_px);
    const auto &planes = buffer.planes();
    const size_t luma_bytes = layout.stride_bytes * stream.size.height;
    const bool apart = planes.size() > 1 && (planes[1].fd.get() != planes[0].fd.get() ||
                                             planes[1].offset - planes[0].offset != luma_bytes);
    if (pixel_format_describe(mode.format)->chroma != CHROMA_NONE &&
        (apart || frame_layout_size_bytes(&layout) > room_bytes))
        layout.format = PIXEL_GREY;
    return layout;
}
