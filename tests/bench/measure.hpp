// Runs every decoder on every frame and keeps the times.
#pragma once

#include "judge.hpp"
#include "options.hpp"
#include "readers.hpp"
#include "statistics.hpp"

#include <memory>
#include <optional>
#include <vector>

// One decoder on one source.
struct run {
    std::vector<double> fastest_ms;  // of each frame, over all passes; the slowest frames have had more of them
    std::vector<double> all_ms;      // of each frame and pass
    std::vector<decode_counters> counters;
    tally score;
    std::size_t heap_bytes = 0;      // peak of the worst frame
};

struct measurement {
    std::vector<std::unique_ptr<reader>> readers;
    std::vector<source> sources;
    std::vector<std::vector<run>> runs;  // [reader][source]

    const run *find(const std::string &reader_name, const std::string &source_name) const;
};

// One untimed pass that counts what is read and the heap, then the timed ones. All decoders take turns on a frame,
// and another one begins each time, so that a machine that gets slower or faster does so for all of them.
measurement measure(const options &chosen);

// median_ratio() of the times of two runs. Nothing where one of them is missing or was not timed.
std::optional<double> paired_ratio(const run *a, const run *b);
