#include "opencv_media.h"

#include "video_container.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include <climits>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <exception>
#include <fcntl.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

/* For the whole process; messages that other threads print meanwhile are lost too. */
class quiet_stderr {
public:
    quiet_stderr() : saved_(dup(STDERR_FILENO))
    {
        int null_device = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (saved_ >= 0 && null_device >= 0)
            dup2(null_device, STDERR_FILENO);
        if (null_device >= 0)
            close(null_device);
    }
    ~quiet_stderr()
    {
        if (saved_ >= 0) {
            dup2(saved_, STDERR_FILENO);
            close(saved_);
        }
    }
    quiet_stderr(const quiet_stderr &) = delete;
    quiet_stderr &operator=(const quiet_stderr &) = delete;

private:
    int saved_;
};

bool may_be_transparent(const uint8_t *bytes, size_t size)
{
    constexpr size_t colour_type_offset = 25;
    enum { PALETTE = 3, GRAY_ALPHA = 4, RGB_ALPHA = 6 };
    if (size <= colour_type_offset || std::memcmp(bytes, "\x89PNG", 4) != 0)
        return false;
    uint8_t type = bytes[colour_type_offset];
    return type == PALETTE || type == GRAY_ALPHA || type == RGB_ALPHA;
}

cv::Mat lay_on_white(const cv::Mat &picture)
{
    cv::Mat bgra = picture;
    if (picture.depth() == CV_16U)
        picture.convertTo(bgra, CV_8U, 1.0 / 257);
    cv::Mat gray, alpha;
    cv::cvtColor(bgra, gray, cv::COLOR_BGRA2GRAY);
    cv::extractChannel(bgra, alpha, 3);
    for (int y = 0; y < gray.rows; y++) {
        uint8_t *row = gray.ptr<uint8_t>(y);
        const uint8_t *opacity = alpha.ptr<uint8_t>(y);
        for (int x = 0; x < gray.cols; x++)
            row[x] = static_cast<uint8_t>((row[x] * opacity[x] + 255 * (255 - opacity[x]) + 127) / 255);
    }
    return gray;
}

cv::Mat decode_gray(const uint8_t *bytes, size_t size)
{
    const cv::_InputArray encoded(bytes, static_cast<int>(size));
    if (may_be_transparent(bytes, size)) {
        cv::Mat picture = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
        if (picture.channels() == 4)
            return lay_on_white(picture);
    }
    return cv::imdecode(encoded, cv::IMREAD_GRAYSCALE);
}

bool has_valid_size(const cv::Mat &picture, error_text *error)
{
    if (picture.cols <= FRAME_SIDE_MAX_PX && picture.rows <= FRAME_SIDE_MAX_PX)
        return true;
    error_text_set(error, "is %d x %d px; the largest side is %d px", picture.cols, picture.rows, FRAME_SIDE_MAX_PX);
    return false;
}

bool copy_picture(const cv::Mat &gray, gray_picture *picture, error_text *error)
{
    size_t width = static_cast<size_t>(gray.cols);
    picture->width_px = gray.cols;
    picture->height_px = gray.rows;
    picture->pixels = static_cast<uint8_t *>(std::malloc(width * static_cast<size_t>(gray.rows)));
    if (picture->pixels == nullptr) {
        error_text_set(error, "not enough memory for a picture of %d x %d px", gray.cols, gray.rows);
        return false;
    }
    for (int y = 0; y < gray.rows; y++)
        std::memcpy(picture->pixels + static_cast<size_t>(y) * width, gray.ptr(y), width);
    return true;
}

struct video_file : frame_source {
    std::string path;
    cv::VideoCapture capture;
    cv::Mat colour;
    cv::Mat gray;
    uint64_t frame_count = 0;
};

/* What to tell when no further frame comes: nothing when the video simply ended. */
frame_status end_of_video(const video_file &file, error_text *error)
{
    if (video_is_cut_short(file.path.c_str(), error))
        return FRAME_FAILED;
    if (file.frame_count > 0)
        return FRAME_END;
    error_text_set(error, "not one frame of this video can be decoded");
    return FRAME_FAILED;
}

int64_t time_ns(const cv::VideoCapture &capture)
{
    double milliseconds = capture.get(cv::CAP_PROP_POS_MSEC);
    return milliseconds >= 0 && milliseconds < 9e12 ? static_cast<int64_t>(milliseconds * 1e6 + 0.5)
                                                    : FRAME_TIME_UNKNOWN;
}

frame_status next_video_frame(frame_source *source, frame *output, error_text *error)
{
    video_file &file = *static_cast<video_file *>(source);
    try {
        bool got;
        {
            quiet_stderr quiet;
            got = file.capture.read(file.colour) && !file.colour.empty();
        }
        if (!got)
            return end_of_video(file, error);
        if (!has_valid_size(file.colour, error))
            return FRAME_FAILED;
        cv::cvtColor(file.colour, file.gray, cv::COLOR_BGR2GRAY);
        frame_layout layout = {PIXEL_GREY, file.gray.cols, file.gray.rows, file.gray.step[0]};
        *output = frame{layout, file.gray.data, file.frame_count++, time_ns(file.capture)};
        return FRAME_READY;
    } catch (const std::exception &) {
        error_text_set(error, "frame %llu of this video cannot be decoded",
                       static_cast<unsigned long long>(file.frame_count));
        return FRAME_FAILED;
    }
}

void close_video(frame_source *source)
{
    quiet_stderr quiet;
    delete static_cast<video_file *>(source);
}

const frame_source_methods video_methods = {next_video_frame, close_video};

/* FFmpeg's own threads complain at any time. OpenCV brings the library along, but no header of it. */
void quiet_ffmpeg()
{
    using level_setter = void (*)(int level);
    constexpr int level_quiet = -8;
    if (auto set_level = reinterpret_cast<level_setter>(dlsym(RTLD_DEFAULT, "av_log_set_level")))
        set_level(level_quiet);
}

bool open_capture(video_file &file)
{
    constexpr double most_frames = 1e9;
    quiet_stderr quiet;
    /* "file:" keeps FFmpeg from taking a colon in the name for a protocol. */
    bool opened = file.capture.open("file:" + file.path, cv::CAP_FFMPEG);
    quiet_ffmpeg();  /* opening the first video sets the level */
    if (!opened)
        return false;
    double frames = file.capture.get(cv::CAP_PROP_FRAME_COUNT);
    file.frames_expected = frames > 0 && frames < most_frames ? static_cast<uint64_t>(frames) : 0;
    return true;
}

} // namespace

extern "C" bool opencv_decode_still(const uint8_t *bytes, size_t size, gray_picture *picture, error_text *error)
{
    cv::Mat gray;
    try {
        quiet_stderr quiet;
        if (size <= INT_MAX)
            gray = decode_gray(bytes, size);
    } catch (const std::exception &) {
        gray.release();
    }
    if (gray.empty()) {
        error_text_set(error, "is damaged, cut short or a kind of picture that cannot be read");
        return false;
    }
    return has_valid_size(gray, error) && copy_picture(gray, picture, error);
}

extern "C" bool opencv_encode_png(const uint8_t *pixels, int32_t width_px, int32_t height_px, uint8_t **bytes,
                                  size_t *size, error_text *error)
{
    std::vector<uint8_t> encoded;
    try {
        quiet_stderr quiet;
        const cv::Mat picture(height_px, width_px, CV_8UC1, const_cast<uint8_t *>(pixels));
        if (!cv::imencode(".png", picture, encoded))
            encoded.clear();
    } catch (const std::exception &) {
        encoded.clear();
    }
    *size = encoded.size();
    *bytes = encoded.empty() ? nullptr : static_cast<uint8_t *>(std::malloc(encoded.size()));
    if (*bytes == nullptr) {
        error_text_set(error, "not enough memory for a PNG of %d x %d px", width_px, height_px);
        return false;
    }
    std::memcpy(*bytes, encoded.data(), encoded.size());
    return true;
}

/* Standard error is left as it is: this runs beside threads that have something to say. */
extern "C" size_t opencv_encode_jpeg(const uint8_t *bgr, int32_t width_px, int32_t height_px, uint8_t **bytes,
                                     size_t *capacity)
{
    constexpr int quality = 80;
    std::vector<uint8_t> encoded;
    try {
        const cv::Mat picture(height_px, width_px, CV_8UC3, const_cast<uint8_t *>(bgr));
        if (!cv::imencode(".jpg", picture, encoded, {cv::IMWRITE_JPEG_QUALITY, quality}))
            return 0;
    } catch (const std::exception &) {
        return 0;
    }
    if (encoded.size() > *capacity) {
        auto larger = static_cast<uint8_t *>(std::realloc(*bytes, encoded.size()));
        if (larger == nullptr)
            return 0;
        *bytes = larger;
        *capacity = encoded.size();
    }
    std::memcpy(*bytes, encoded.data(), encoded.size());
    return encoded.size();
}

extern "C" frame_source *opencv_video_open(const char *path, error_text *error)
{
    video_file *file = nullptr;
    try {
        file = new video_file();
        file->methods = &video_methods;
        file->path = path;
        if (open_capture(*file))
            return file;
    } catch (const std::exception &) {
        /* Told below, as any other failure to open. */
    }
    close_video(file);
    if (!video_is_cut_short(path, error))
        error_text_set(error, "is a video that cannot be read: damaged, cut short or in an unknown coding");
    return nullptr;
}
