#include "measure.hpp"

#include "heap.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <unistd.h>

namespace {

double now_ms(clock_kind kind)
{
    timespec now = {};
    clock_gettime(kind == clock_kind::wall ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

void show_progress(const char *what, int pass, std::size_t done, std::size_t all)
{
    static const bool terminal = isatty(STDERR_FILENO) != 0;
    if (terminal)
        std::fprintf(stderr, "\r%s %d, frame %zu of %zu   %s", what, pass, done, all, done == all ? "\n" : "");
}

std::size_t longest(const std::vector<source> &sources)
{
    std::size_t frames = 0;
    for (const source &one : sources)
        frames = std::max(frames, one.frames.size());
    return frames;
}

tally judge(const reader &who, const source &where, int number, const tape_truth *truth)
{
    const std::vector<reading> readings = who.readings();
    if (who.reads() == marker_kind::none)
        return {};
    if (who.reads() != where.shows)
        return judge_absent(number, readings);
    return truth != nullptr && where.shows == marker_kind::tape ? truth->judge(number, readings)
                                                                : judge_plausible(number, readings);
}

void survey(measurement &all, const tape_truth *truth)
{
    const std::size_t frames = longest(all.sources);
    for (std::size_t i = 0; i < frames; i++) {
        for (std::size_t s = 0; s < all.sources.size(); s++) {
            if (i >= all.sources[s].frames.size())
                continue;
            const frame &input = all.sources[s].frames[i];
            for (std::size_t r = 0; r < all.readers.size(); r++) {
                run &into = all.runs[r][s];
                heap_count_start();
                all.readers[r]->decode(input.gray);
                into.heap_bytes = std::max(into.heap_bytes, heap_count_stop());
                into.counters.push_back(all.readers[r]->counters());
                into.score.add(judge(*all.readers[r], all.sources[s], input.number, truth));
            }
        }
        show_progress("untimed pass", 0, i + 1, frames);
    }
}

double time_decode(reader &who, const cv::Mat &gray, clock_kind clock)
{
    const double begin_ms = now_ms(clock);
    who.decode(gray);
    return now_ms(clock) - begin_ms;
}

void timed_pass(measurement &all, clock_kind clock, int pass)
{
    const std::size_t frames = longest(all.sources);
    for (std::size_t i = 0; i < frames; i++) {
        for (std::size_t s = 0; s < all.sources.size(); s++) {
            if (i >= all.sources[s].frames.size())
                continue;
            for (std::size_t turn = 0; turn < all.readers.size(); turn++) {
                const std::size_t r = (turn + i + static_cast<std::size_t>(pass)) % all.readers.size();
                const double took_ms = time_decode(*all.readers[r], all.sources[s].frames[i].gray, clock);
                std::vector<double> &fastest = all.runs[r][s].fastest_ms;
                if (fastest.size() == i)
                    fastest.push_back(took_ms);
                fastest[i] = std::min(fastest[i], took_ms);
                all.runs[r][s].all_ms.push_back(took_ms);
            }
        }
        show_progress("timed pass", pass, i + 1, frames);
    }
}

// A frame may look slow because the machine was. The slowest frames are timed again until the slowest of all has
// proved to be so, or half a second is spent.
void retime_slowest(reader &who, const source &where, run &into, clock_kind clock)
{
    constexpr int proof = 25;
    std::vector<int> again(into.fastest_ms.size(), 0);
    const double begin_ms = now_ms(clock_kind::wall);
    while (now_ms(clock_kind::wall) - begin_ms < 500.0) {
        const auto slowest = static_cast<std::size_t>(
            std::max_element(into.fastest_ms.begin(), into.fastest_ms.end()) - into.fastest_ms.begin());
        if (again[slowest]++ == proof)
            return;
        into.fastest_ms[slowest] =
            std::min(into.fastest_ms[slowest], time_decode(who, where.frames[slowest].gray, clock));
    }
}

std::vector<std::unique_ptr<reader>> chosen_readers(const std::vector<std::string> &names, cv::Size size)
{
    std::vector<std::unique_ptr<reader>> readers = make_readers(size);
    const auto unwanted = [&](const std::unique_ptr<reader> &one) {
        return std::find(names.begin(), names.end(), one->name()) == names.end();
    };
    readers.erase(std::remove_if(readers.begin(), readers.end(), unwanted), readers.end());
    return readers;
}

void demand_one_size(const std::vector<source> &sources)
{
    for (const source &one : sources)
        for (const frame &input : one.frames)
            if (input.gray.size() != sources.front().frames.front().gray.size())
                throw std::runtime_error(one.name + ": its frames have another size than those of " +
                                         sources.front().name);
}

}  // namespace

const run *measurement::find(const std::string &reader_name, const std::string &source_name) const
{
    for (std::size_t r = 0; r < readers.size(); r++)
        for (std::size_t s = 0; s < sources.size(); s++)
            if (readers[r]->name() == reader_name && sources[s].name == source_name)
                return &runs[r][s];
    return nullptr;
}

measurement measure(const options &chosen)
{
    cv::setNumThreads(1);
    measurement all;
    std::unique_ptr<tape_truth> truth;
    for (const std::string &name : chosen.sources) {
        all.sources.push_back(load_source(name, chosen.data_dir, chosen.frames));
        if (name == "tape")
            truth = std::make_unique<tape_truth>(chosen.data_dir + "/condition_a/truth.json");
    }
    demand_one_size(all.sources);
    all.readers = chosen_readers(chosen.readers, all.sources.front().frames.front().gray.size());
    all.runs.assign(all.readers.size(), std::vector<run>(all.sources.size()));
    survey(all, truth.get());
    for (int pass = 1; pass <= chosen.repeats; pass++)
        timed_pass(all, chosen.clock, pass);
    for (std::size_t r = 0; r < all.readers.size() && chosen.repeats > 0; r++)
        for (std::size_t s = 0; s < all.sources.size(); s++)
            retime_slowest(*all.readers[r], all.sources[s], all.runs[r][s], chosen.clock);
    return all;
}

std::optional<double> paired_ratio(const run *a, const run *b)
{
    if (a == nullptr || b == nullptr || a->fastest_ms.empty() || b->fastest_ms.empty())
        return std::nullopt;
    return median_ratio(a->fastest_ms, b->fastest_ms);
}
