#include "report.hpp"

#include "heap.h"
#include "sanitized.h"

#include <cstdio>

namespace {

constexpr std::size_t workspace_bytes_max = 64 * 1024;
constexpr double share_of_aruco_max = 0.1;
constexpr double worst_over_median_max = 4.0;

#ifdef __OPTIMIZE__
constexpr bool times_count = !BENCH_SANITIZED;
#else
constexpr bool times_count = false;
#endif

bool limit(const char *what, double value, double most)
{
    const bool kept = value <= most;
    std::printf("  %-6s %-52s %10.4g, at most %g\n", kept ? "ok" : "MISSED", what, value, most);
    return kept;
}

bool check_memory(const measurement &all, std::size_t r)
{
    bool kept = limit("workspace, bytes", static_cast<double>(all.readers[r]->workspace_bytes()),
                      static_cast<double>(workspace_bytes_max));
    if (!heap_is_counted()) {
        std::printf("  %-6s heap: allocations cannot be seen in this build\n", "-");
        return kept;
    }
    std::size_t heap_bytes = 0;
    for (const run &one : all.runs[r])
        heap_bytes += one.heap_bytes;
    return limit("heap, bytes", static_cast<double>(heap_bytes), 0.0) && kept;
}

bool check_times(const measurement &all, std::size_t r)
{
    if (!times_count) {
        std::printf("  %-6s times: built without optimisation or with a sanitizer\n", "-");
        return true;
    }
    const run *ours = all.find("tapemark", "tape");
    const double on_tape = *paired_ratio(ours, all.find("aruco", "tape"));
    bool kept = limit("time, against aruco on tape", on_tape, share_of_aruco_max);
    const std::optional<double> own = paired_ratio(ours, all.find("aruco", "aruco"));
    if (own)
        kept = limit("time, against aruco on its own video", *own, share_of_aruco_max) && kept;
    return limit("worst frame, in medians of tape", find_worst(all, r)->ratio, worst_over_median_max) && kept;
}

}  // namespace

bool check_limits(const measurement &all)
{
    std::printf("\nLimits\n");
    std::size_t r = 0;
    while (all.readers[r]->name() != "tapemark")
        r++;
    std::size_t wrong = 0;
    for (const run &one : all.runs[r])
        wrong += one.score.wrong;
    bool kept = limit("wrong ids", static_cast<double>(wrong), 0.0);
    const std::size_t unread = all.find("tapemark", "tape")->score.frames_read == 0;
    kept = limit("tape read in no frame at all", static_cast<double>(unread), 0.0) && kept;
    kept = check_memory(all, r) && kept;
    return check_times(all, r) && kept;
}
