// The command line of tapemark-bench.
#pragma once

#include "frames.hpp"

#include <stdexcept>
#include <string>
#include <vector>

enum class clock_kind { wall, cpu };

struct options {
    std::vector<std::string> readers;
    std::vector<std::string> sources;
    frame_range frames;
    int repeats = 5;
    clock_kind clock = clock_kind::wall;
    std::string data_dir;
    std::string json_path;
    bool check = false;
    bool help = false;
};

struct usage_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

extern const char *const usage_text;

// Throws usage_error with one line that names the option, what is wrong and what would be right.
options parse_options(int argc, char **argv);
