// Order statistics of times.
#pragma once

#include <vector>

// `share` from 0 to 1 of the values are at most this (nearest rank). The values must not be empty.
double percentile(std::vector<double> values, double share);

// Median of a / b, frame by frame; frames that only one has are left out. Neither may be empty.
double median_ratio(const std::vector<double> &a, const std::vector<double> &b);
