#include "preview_notes.h"

#include <exception>

#include <opencv2/imgproc.hpp>

namespace {

void draw_text(cv::Mat &picture, const char *text, cv::Point at, double size, const cv::Scalar &colour)
{
    const cv::Scalar black(0, 0, 0);
    cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, black, 3, cv::LINE_AA);
    cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
}

void draw_marker(cv::Mat &picture, const preview_marker &marker, double size)
{
    const cv::Scalar colour = marker.tape ? cv::Scalar(0, 140, 255) : cv::Scalar(80, 220, 60);
    cv::Point corners[4];
    for (int i = 0; i < 4; i++)
        corners[i] = cv::Point(cvRound(marker.corners[i].x_px), cvRound(marker.corners[i].y_px));
    const cv::Point *outline = corners;
    const int count = 4;
    cv::polylines(picture, &outline, &count, 1, true, colour, 2, cv::LINE_AA);
    const cv::Point at = marker.tape ? corners[3] + cv::Point(0, cvRound(24 * size)) : corners[0] - cv::Point(0, 4);
    draw_text(picture, marker.label, at, size, colour);
}

void draw_all(const preview_canvas &canvas, const preview_notes &read)
{
    cv::Mat picture(canvas.height_px, canvas.width_px, CV_8UC3, canvas.bgr, static_cast<size_t>(canvas.stride_bytes));
    const double size = canvas.width_px < 800 ? 0.4 : 0.6;
    for (size_t i = 0; i < read.count; i++)
        draw_marker(picture, read.markers[i], size);
    draw_text(picture, read.caption, cv::Point(6, canvas.height_px - 8), size, cv::Scalar(255, 255, 255));
}

}

extern "C" void preview_notes_paint(void *, const preview_canvas *canvas, const void *notes)
{
    /* A picture with less drawn into it is better than no picture. */
    try {
        draw_all(*canvas, *static_cast<const preview_notes *>(notes));
    } catch (const std::exception &) {
    }
}
