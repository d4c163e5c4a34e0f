// What was measured: as a table to read, as JSON to keep, and against the limits of the product.
#pragma once

#include "measure.hpp"

#include <string>

void print_report(const measurement &all, const options &chosen);

// Throws std::runtime_error naming the file when it cannot be written.
void write_json(const measurement &all, const options &chosen, const std::string &path);

// Prints a line for each limit. False when one is missed.
bool check_limits(const measurement &all);

// The frame that takes longest, on any source, against the decoder's median frame of the tape video.
struct worst_frame {
    double ratio;
    double ms;
    std::string where;
};

// Nothing when it was not timed on the tape video.
std::optional<worst_frame> find_worst(const measurement &all, std::size_t reader_index);
