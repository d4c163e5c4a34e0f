#include "annotate.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace {

const cv::Scalar finder_colour(255, 160, 40);
const cv::Scalar cm_colour(60, 220, 0);
const cv::Scalar tm_colour(0, 140, 255);
const cv::Scalar outline_colour(0, 0, 0);

/* Thin on small frames, so that lines do not hide the markers; visible on large ones. */
struct style {
    int line_px;
    int text_px;  /* width of the strokes of letters */
    double font_scale;
    float gap_px;

    explicit style(cv::Size size)
    {
        double side = std::min(std::max(size.width, size.height), 4000);
        line_px = std::max(1, static_cast<int>(std::lround(side / 2000)));
        text_px = std::max(1, static_cast<int>(std::lround(side / 1200)));
        font_scale = std::max(0.4, side / 2600);
        gap_px = static_cast<float>(std::max(4.0, side / 320));
    }
};

cv::Point2f to_cv(tapemark_point point)
{
    return {point.x_px, point.y_px};
}

/* Far outside any frame OpenCV's fixed-point coordinates would overflow. */
bool can_be_drawn(cv::Point2f point)
{
    constexpr float most_px = 1e5f;
    return std::fabs(point.x) < most_px && std::fabs(point.y) < most_px;
}

void draw_line(cv::Mat &canvas, cv::Point2f from, cv::Point2f to, const cv::Scalar &colour, int line_px)
{
    constexpr int fraction_bits = 4;
    constexpr float unit = 1 << fraction_bits;
    if (can_be_drawn(from) && can_be_drawn(to))
        cv::line(canvas, cv::Point(cvRound(from.x * unit), cvRound(from.y * unit)),
                 cv::Point(cvRound(to.x * unit), cvRound(to.y * unit)), colour, line_px, cv::LINE_AA, fraction_bits);
}

void draw_outline(cv::Mat &canvas, const cv::Point2f corners[4], const cv::Scalar &colour, int line_px)
{
    for (int i = 0; i < 4; i++)
        draw_line(canvas, corners[i], corners[(i + 1) % 4], colour, line_px);
}

cv::Point2f unit_vector(cv::Point2f vector)
{
    float length = std::hypot(vector.x, vector.y);
    return length > 0 ? vector / length : cv::Point2f(0, 0);
}

bool fits(const cv::Mat &canvas, cv::Point2f centre, cv::Point2f half)
{
    return centre.x >= half.x && centre.y >= half.y && centre.x + half.x < static_cast<float>(canvas.cols) &&
           centre.y + half.y < static_cast<float>(canvas.rows);
}

/* Upright text beside an edge of a marker, `outward` of it; on the marker's other side where the text would leave
 * the frame. */
void draw_label(cv::Mat &canvas, const std::string &text, cv::Point2f edge, cv::Point2f other_edge,
                cv::Point2f outward, const cv::Scalar &colour, const style &look)
{
    int baseline;
    cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, look.font_scale, look.text_px, &baseline);
    cv::Point2f half(static_cast<float>(size.width) / 2, static_cast<float>(size.height) / 2);
    float reach = std::fabs(outward.x) * half.x + std::fabs(outward.y) * half.y + look.gap_px;
    cv::Point2f centre = edge + outward * reach;
    if (!fits(canvas, centre, half))
        centre = other_edge - outward * reach;
    if (!can_be_drawn(centre))
        return;
    cv::Point origin(cvRound(centre.x - half.x), cvRound(centre.y + half.y));
    cv::putText(canvas, text, origin, cv::FONT_HERSHEY_SIMPLEX, look.font_scale, outline_colour, look.text_px + 2,
                cv::LINE_AA);
    cv::putText(canvas, text, origin, cv::FONT_HERSHEY_SIMPLEX, look.font_scale, colour, look.text_px, cv::LINE_AA);
}

void draw_finder(cv::Mat &canvas, const tapemark_finder &finder, const style &look)
{
    constexpr float half_modules = 3.5f;
    cv::Point2f centre = to_cv(finder.centre);
    cv::Point2f along = to_cv(finder.along) * half_modules;
    cv::Point2f across = to_cv(finder.across) * half_modules;
    const cv::Point2f corners[4] = {centre - along - across, centre + along - across, centre + along + across,
                                    centre - along + across};
    draw_outline(canvas, corners, finder_colour, look.line_px);
}

void draw_cm(cv::Mat &canvas, const tapemark_cm &cm, const style &look)
{
    cv::Point2f corners[4];
    std::transform(cm.corners, cm.corners + 4, corners, to_cv);
    draw_outline(canvas, corners, cm_colour, look.line_px);
    if (can_be_drawn(corners[0]))
        cv::circle(canvas, cv::Point(cvRound(corners[0].x), cvRound(corners[0].y)), look.line_px + 1, cm_colour,
                   cv::FILLED, cv::LINE_AA);
    cv::Point2f up = unit_vector(corners[0] + corners[1] - corners[2] - corners[3]);
    draw_label(canvas, std::to_string(cm.id), (corners[0] + corners[1]) / 2, (corners[2] + corners[3]) / 2, up,
               cm_colour, look);
}

/* A bracket below the marker, so that it does not hide the outlines and ids of its CMs. */
void draw_tm(cv::Mat &canvas, const tapemark_tm &tm, const style &look)
{
    cv::Point2f corners[4];
    std::transform(tm.corners, tm.corners + 4, corners, to_cv);
    cv::Point2f down = unit_vector(corners[2] + corners[3] - corners[0] - corners[1]);
    cv::Point2f along = unit_vector(corners[1] + corners[2] - corners[0] - corners[3]);
    cv::Point2f left = corners[3] + down * look.gap_px;
    cv::Point2f right = corners[2] + down * look.gap_px;
    int line_px = look.line_px + 1;
    draw_line(canvas, left, right, tm_colour, line_px);
    draw_line(canvas, left, corners[0], tm_colour, look.line_px);
    draw_line(canvas, right, corners[1], tm_colour, look.line_px);
    if (tm.directed) {
        draw_line(canvas, right, right - (along - down) * (1.5f * look.gap_px), tm_colour, line_px);
        draw_line(canvas, right, right - (along + down) * (1.5f * look.gap_px), tm_colour, line_px);
    }
    std::string label = std::string(tm.code) + (tm.directed ? "" : " ?");
    draw_label(canvas, label, (left + right) / 2, (corners[0] + corners[1]) / 2, down, tm_colour, look);
}

cv::Mat draw(const gray_view &view, const tapemark_result &result)
{
    /* OpenCV has no read-only view; the pixels are not written to. */
    const cv::Mat gray(view.height_px, view.width_px, CV_8UC1, const_cast<uint8_t *>(view.pixels),
                       static_cast<size_t>(view.stride_bytes));
    cv::Mat canvas;
    cv::cvtColor(gray, canvas, cv::COLOR_GRAY2BGR);
    const style look(canvas.size());
    for (size_t i = 0; i < result.finder_count; i++)
        draw_finder(canvas, result.finders[i], look);
    for (size_t i = 0; i < result.tm_count; i++)
        draw_tm(canvas, result.tms[i], look);
    for (size_t i = 0; i < result.cm_count; i++)
        draw_cm(canvas, result.cms[i], look);
    return canvas;
}

/* OpenCV's own writing does not notice a full disk. */
bool write_file(const std::string &path, const std::vector<uint8_t> &bytes, error_text *error)
{
    std::FILE *file = std::fopen(path.c_str(), "wb");
    bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    int reason = errno;
    if (file != nullptr && std::fclose(file) != 0 && written) {
        written = false;
        reason = errno;
    }
    if (!written) {
        error_text_set(error, "%.300s cannot be written: %s", path.c_str(), std::strerror(reason));
        if (file != nullptr)
            unlink(path.c_str());
    }
    return written;
}

} // namespace

extern "C" bool annotate_prepare(const char *directory, error_text *error)
{
    struct stat status;
    if (mkdir(directory, 0777) != 0 && errno != EEXIST) {
        error_text_set(error, "this directory cannot be made: %s", std::strerror(errno));
        return false;
    }
    if (stat(directory, &status) != 0 || !S_ISDIR(status.st_mode)) {
        error_text_set(error, "is not a directory");
        return false;
    }
    if (access(directory, W_OK | X_OK) != 0) {
        error_text_set(error, "no file can be written into it: %s", std::strerror(errno));
        return false;
    }
    return true;
}

extern "C" bool annotate_frame(const char *directory, const char *name, uint64_t frame_number, const gray_view *view,
                               const tapemark_result *result, error_text *error)
{
    try {
        char number[32];
        std::snprintf(number, sizeof number, "-%06llu.png", static_cast<unsigned long long>(frame_number));
        std::vector<uint8_t> png;
        /* The fastest level still halves the size. */
        cv::imencode(".png", draw(*view, *result), png, {cv::IMWRITE_PNG_COMPRESSION, 1});
        return write_file(std::string(directory) + "/" + name + number, png, error);
    } catch (const std::exception &) {
        error_text_set(error, "not enough memory for a picture of %d x %d px", view->width_px, view->height_px);
        return false;
    }
}
