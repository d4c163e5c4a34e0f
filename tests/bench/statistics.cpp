#include "statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

double percentile(std::vector<double> values, double share)
{
    std::sort(values.begin(), values.end());
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double median_ratio(const std::vector<double> &a, const std::vector<double> &b)
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); i++)
        ratios.push_back(a[i] / b[i]);
    return percentile(ratios, 0.5);
}
