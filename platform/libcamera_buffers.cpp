#include "libcamera_buffers.hpp"

#include <algorithm>
#include <fcntl.h>
#include <linux/dma-buf.h>
#include <linux/dma-heap.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace {

/* Raspberry Pi OS has the first; the second is what other kernels have for cameras. */
int open_heap()
{
    for (const char *path : {"/dev/dma_heap/vidbuf_cached", "/dev/dma_heap/linux,cma"}) {
        int heap = open(path, O_RDWR | O_CLOEXEC);
        if (heap >= 0)
            return heap;
    }
    return -1;
}

int allocate_from(int heap, size_t bytes)
{
    dma_heap_allocation_data request = {};
    request.len = bytes;
    request.fd_flags = O_RDWR | O_CLOEXEC;
    return ioctl(heap, DMA_HEAP_IOCTL_ALLOC, &request) == 0 ? static_cast<int>(request.fd) : -1;
}

/* Memory that is no DMA buffer answers with an error, and needs none of this. */
void synchronise(int descriptor, uint64_t flags)
{
    dma_buf_sync request = {};
    request.flags = flags | DMA_BUF_SYNC_READ;
    ioctl(descriptor, DMA_BUF_IOCTL_SYNC, &request);
}

} // namespace

void libcamera_buffers::release()
{
    for (const mapped_buffer &one : mapped_)
        munmap(const_cast<uint8_t *>(one.bytes), one.size);
    mapped_.clear();
    own_.clear();
    allocator_.reset();
}

bool libcamera_buffers::map(libcamera::FrameBuffer *buffer)
{
    const auto &planes = buffer->planes();
    const int descriptor = planes[0].fd.get();
    size_t end = 0;
    for (const auto &plane : planes)
        if (plane.fd.get() == descriptor)
            end = std::max<size_t>(end, size_t{plane.offset} + plane.length);
    void *bytes = mmap(nullptr, end, PROT_READ, MAP_SHARED, descriptor, 0);
    if (bytes == MAP_FAILED)
        return false;
    mapped_.push_back({buffer, descriptor, static_cast<const uint8_t *>(bytes), end, planes[0].offset});
    return true;
}

bool libcamera_buffers::allocate_cached(size_t count, size_t frame_bytes)
{
    const int heap = open_heap();
    bool done = heap >= 0;
    for (size_t i = 0; done && i < count; i++) {
        int descriptor = allocate_from(heap, frame_bytes);
        done = descriptor >= 0;
        if (!done)
            break;
        std::vector<libcamera::FrameBuffer::Plane> planes(1);
        planes[0].fd = libcamera::SharedFD(std::move(descriptor));
        planes[0].offset = 0;
        planes[0].length = static_cast<unsigned int>(frame_bytes);
        own_.push_back(std::make_unique<libcamera::FrameBuffer>(planes));
        done = map(own_.back().get());
    }
    if (heap >= 0)
        close(heap);
    if (!done)
        release();
    return done;
}

bool libcamera_buffers::allocate(const std::shared_ptr<libcamera::Camera> &camera,
                                 const libcamera::StreamConfiguration &stream, bool prefer_cached)
{
    release();
    if (prefer_cached && allocate_cached(stream.bufferCount, stream.frameSize))
        return true;
    allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera);
    if (allocator_->allocate(stream.stream()) < 0)
        return false;
    for (const auto &buffer : allocator_->buffers(stream.stream()))
        if (!map(buffer.get()))
            return false;
    return !mapped_.empty();
}

void libcamera_buffers::begin_reading(size_t index) const
{
    synchronise(mapped_[index].descriptor, DMA_BUF_SYNC_START);
}

void libcamera_buffers::end_reading(size_t index) const
{
    synchronise(mapped_[index].descriptor, DMA_BUF_SYNC_END);
}
