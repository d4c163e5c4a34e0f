#include "likeness.hpp"

#include <tapemark.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

constexpr double cm_width = 32, cm_height = 7;

cv::Point2d mapped(const cv::Matx33d &to_picture, double along, double across)
{
    const cv::Vec3d at = to_picture * cv::Vec3d(along, across, 1);
    return {at[0] / at[2], at[1] / at[2]};
}

double bilinear(const cv::Mat &gray, cv::Point2d at)
{
    const int x = std::clamp(static_cast<int>(std::floor(at.x)), 0, gray.cols - 2);
    const int y = std::clamp(static_cast<int>(std::floor(at.y)), 0, gray.rows - 2);
    const double right = std::clamp(at.x - x, 0.0, 1.0), below = std::clamp(at.y - y, 0.0, 1.0);
    const double top = gray.at<uchar>(y, x) * (1 - right) + gray.at<uchar>(y, x + 1) * right;
    const double bottom = gray.at<uchar>(y + 1, x) * (1 - right) + gray.at<uchar>(y + 1, x + 1) * right;
    return top * (1 - below) + bottom * below;
}

// Over the middle of a rectangle of modules.
double mean_of(const cv::Mat &gray, const cv::Matx33d &to_picture, double left, double top, double width,
               double height)
{
    constexpr int steps = 5;
    constexpr double inside = 0.6;
    double sum = 0;
    for (int i = 0; i < steps * steps; i++) {
        const double u = 0.5 + inside * ((i % steps + 0.5) / steps - 0.5);
        const double v = 0.5 + inside * ((i / steps + 0.5) / steps - 0.5);
        sum += bilinear(gray, mapped(to_picture, left + u * width, top + v * height));
    }
    return sum / (steps * steps);
}

// Both finder patterns: their middles are dark, the rings around them light.
void measure_shades(const cv::Mat &gray, const cv::Matx33d &to_picture, marker_look &look)
{
    std::vector<double> light, dark;
    for (double left : {0.0, cm_width - cm_height}) {
        dark.push_back(mean_of(gray, to_picture, left + 2, 2, 3, 3));
        light.push_back(mean_of(gray, to_picture, left + 1, 2, 1, 3));
        light.push_back(mean_of(gray, to_picture, left + 5, 2, 1, 3));
        light.push_back(mean_of(gray, to_picture, left + 2, 1, 3, 1));
        light.push_back(mean_of(gray, to_picture, left + 2, 5, 3, 1));
    }
    look.dark = median_of(dark);
    look.light = median_of(light);
}

// Least squares for gray = a + b × ideal over all pixels within the CM; what is left of it.
double left_over(const cv::Mat &gray, const cv::Mat &ideal, const cv::Mat &inside)
{
    cv::Scalar mean_gray, mean_ideal, spread_gray, spread_ideal;
    cv::meanStdDev(gray, mean_gray, spread_gray, inside);
    cv::meanStdDev(ideal, mean_ideal, spread_ideal, inside);
    cv::Mat product;
    cv::multiply(gray - mean_gray, ideal - mean_ideal, product);
    const double covariance = cv::mean(product, inside)[0];
    const double explained = covariance * covariance / (spread_ideal[0] * spread_ideal[0]);
    return std::sqrt(std::max(spread_gray[0] * spread_gray[0] - explained, 0.0));
}

// A CM as it would be seen without a lens and a sensor: 1 is dark, each pixel the mean of its area.
cv::Mat ideal_of(int id, const cv::Matx33d &to_picture, const cv::Rect &box)
{
    constexpr int samples = 8, columns = static_cast<int>(cm_width), rows = static_cast<int>(cm_height);
    const std::int32_t ids[] = {id};
    std::array<std::uint8_t, static_cast<std::size_t>(rows) * columns> modules{};
    if (tapemark_segment_draw(ids, 1, false, modules.data(), modules.size()) != TAPEMARK_OK)
        throw std::runtime_error("an id of the truth is none");
    const cv::Matx33d to_modules = to_picture.inv();
    cv::Mat fine(samples * box.height, samples * box.width, CV_64F, cv::Scalar(0)), ideal;
    for (int y = 0; y < fine.rows; y++) {
        for (int x = 0; x < fine.cols; x++) {
            const cv::Point2d at =
                mapped(to_modules, box.x + (x + 0.5) / samples - 0.5, box.y + (y + 0.5) / samples - 0.5);
            const int column = static_cast<int>(std::floor(at.x)), row = static_cast<int>(std::floor(at.y));
            if (column >= 0 && column < columns && row >= 0 && row < rows)
                fine.at<double>(y, x) = modules[static_cast<std::size_t>(row * columns + column)];
        }
    }
    cv::resize(fine, ideal, box.size(), 0, 0, cv::INTER_AREA);
    return ideal;
}

// The best sigma of a row of them, between them by a parabola.
void measure_blur(const cv::Mat &seen, const cv::Mat &ideal, const cv::Mat &inside, marker_look &look)
{
    constexpr double first = 0.2, step = 0.1;
    constexpr int steps = 12;
    std::vector<double> left;
    for (int i = 0; i < steps; i++) {
        cv::Mat blurred;
        const double sigma = first + step * i;
        cv::GaussianBlur(ideal, blurred, cv::Size(11, 11), sigma, sigma, cv::BORDER_REPLICATE);
        left.push_back(left_over(seen, blurred, inside));
    }
    const auto best = static_cast<int>(std::min_element(left.begin(), left.end()) - left.begin());
    look.blur_px = first + step * best;
    look.unexplained = left[static_cast<std::size_t>(best)];
    if (best > 0 && best < steps - 1) {
        const double before = left[static_cast<std::size_t>(best - 1)],
                     after = left[static_cast<std::size_t>(best + 1)];
        look.blur_px += step * (before - after) / (2 * (before + after - 2 * look.unexplained));
    }
}

}  // namespace

marker_look look_of(const cv::Mat &gray, int id, const cv::Matx33d &to_picture)
{
    constexpr int margin = 6;
    std::vector<cv::Point> outline;
    for (const cv::Point2d &corner : {mapped(to_picture, 0, 0), mapped(to_picture, cm_width, 0),
                                      mapped(to_picture, cm_width, cm_height), mapped(to_picture, 0, cm_height)})
        outline.emplace_back(cvRound(corner.x), cvRound(corner.y));
    cv::Rect box = cv::boundingRect(outline);
    box = cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
          cv::Rect(0, 0, gray.cols, gray.rows);
    for (cv::Point &corner : outline)
        corner -= box.tl();
    cv::Mat inside(box.size(), CV_8U, cv::Scalar(0)), seen;
    cv::fillConvexPoly(inside, outline, cv::Scalar(255));
    gray(box).convertTo(seen, CV_64F);

    marker_look look;
    measure_shades(gray, to_picture, look);
    measure_blur(seen, ideal_of(id, to_picture, box), inside, look);
    for (int row = 0; row < static_cast<int>(cm_height); row++) {
        for (int column = 0; column < static_cast<int>(cm_width); column++)
            look.cells.push_back((look.light - mean_of(gray, to_picture, column, row, 1, 1)) /
                                 (look.light - look.dark));
    }
    return look;
}

double noise_at(const cv::Mat &gray, cv::Point2d place)
{
    constexpr int side = 24;
    const cv::Rect box = cv::Rect(cvRound(place.x) - side / 2, cvRound(place.y) - side / 2, side, side) &
                         cv::Rect(0, 0, gray.cols, gray.rows);
    cv::Mat seen, smooth;
    gray(box).convertTo(seen, CV_64F);
    cv::GaussianBlur(seen, smooth, cv::Size(), 1.5);
    cv::Scalar mean, spread;
    cv::meanStdDev(seen - smooth, mean, spread);
    return spread[0];
}

double median_of(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

double correlation_of(const std::vector<double> &a, const std::vector<double> &b)
{
    const double count = static_cast<double>(a.size());
    double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); i++) {
        mean_a += a[i] / count;
        mean_b += b[i] / count;
    }
    for (std::size_t i = 0; i < a.size(); i++) {
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
        ab += (a[i] - mean_a) * (b[i] - mean_b);
    }
    return ab / std::sqrt(aa * bb);
}

double difference_of(const std::vector<double> &a, const std::vector<double> &b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); i++)
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}
