// The data that the marker's inventors published, and what is read in it.
#pragma once

#include "reading.hpp"

#include <opencv2/core.hpp>

#include <string>
#include <vector>

// The folder named by TAPEMARK_PAPER_DATA, else the one beside the sources. Ends the program where there is none:
// as skipped, or as failed with TAPEMARK_REQUIRE_PAPER_DATA=1.
std::string paper_data_folder();

// All that the decoder reads in a gray picture, CMs first, each kind in the order in which it was reported.
std::vector<reading> read_tapemark(const cv::Mat &gray);
