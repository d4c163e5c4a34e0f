/* Memory that libcamera's cameras write their frames to, where we can read it quickly. */
#ifndef PLATFORM_LIBCAMERA_BUFFERS_HPP
#define PLATFORM_LIBCAMERA_BUFFERS_HPP

#include <libcamera/libcamera.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

class libcamera_buffers {
public:
    libcamera_buffers() = default;
    ~libcamera_buffers() { release(); }
    libcamera_buffers(const libcamera_buffers &) = delete;
    libcamera_buffers &operator=(const libcamera_buffers &) = delete;

    /* Buffers for this stream, as many as it is configured for. Those of cameras that write by DMA come from cached
     * memory where the kernel has such a heap: reading what is not cached takes thirty times as long. False when
     * there is not enough. */
    bool allocate(const std::shared_ptr<libcamera::Camera> &camera, const libcamera::StreamConfiguration &stream,
                  bool prefer_cached);

    void release();

    size_t count() const { return mapped_.size(); }
    libcamera::FrameBuffer *buffer(size_t index) const { return mapped_[index].buffer; }

    /* The first plane and all that lies behind it. */
    const uint8_t *bytes(size_t index) const { return mapped_[index].bytes + mapped_[index].offset; }
    size_t size(size_t index) const { return mapped_[index].size - mapped_[index].offset; }

    /* Around reading: what the camera wrote becomes visible to the processor. */
    void begin_reading(size_t index) const;
    void end_reading(size_t index) const;

private:
    struct mapped_buffer {
        libcamera::FrameBuffer *buffer;
        int descriptor;
        const uint8_t *bytes;
        size_t size;
        size_t offset;
    };

    bool allocate_cached(size_t count, size_t frame_bytes);
    bool map(libcamera::FrameBuffer *buffer);

    std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
    std::vector<std::unique_ptr<libcamera::FrameBuffer>> own_;
    std::vector<mapped_buffer> mapped_;
};

#endif
