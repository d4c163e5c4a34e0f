// How a code marker looks in a picture, in numbers: to tell whether two pictures of it are alike.
#pragma once

#include <opencv2/core.hpp>

#include <array>
#include <vector>

struct marker_look {
    double light = 0, dark = 0;  // of its finder patterns: the light ring, the dark middle
    double blur_px = 0;          // sigma of the Gaussian that makes an ideal picture most like this one
    double unexplained = 0;      // what is left then, in gray levels
    std::vector<double> cells;   // means of all cells, 0 for light, 1 for dark
};

// `to_picture` maps (modules along, modules across, 1) from the top left corner of the CM's ink.
marker_look look_of(const cv::Mat &gray, int id, const cv::Matx33d &to_picture);

// Standard deviation of what is finer than three pixels, in gray levels, around a place: of the noise, where nothing
// else is.
double noise_at(const cv::Mat &gray, cv::Point2d place);

double median_of(std::vector<double> values);
double correlation_of(const std::vector<double> &a, const std::vector<double> &b);
double difference_of(const std::vector<double> &a, const std::vector<double> &b);  // root of the mean square
