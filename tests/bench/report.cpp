#include "report.hpp"

#include "heap.h"

#include <tapemark.h>

#include <cstdio>

namespace {

constexpr double kib = 1024.0;

std::string count_of(std::size_t part, std::size_t whole)
{
    return std::to_string(part) + "/" + std::to_string(whole);
}

std::string memory_text(const reader &who, const run &one)
{
    char text[64];
    const auto workspace_kib = static_cast<double>(who.workspace_bytes()) / kib;
    if (heap_is_counted())
        std::snprintf(text, sizeof text, "%.1f + %.0f", workspace_kib, static_cast<double>(one.heap_bytes) / kib);
    else
        std::snprintf(text, sizeof text, "%.1f + ?", workspace_kib);
    return text;
}

void print_row(const reader &who, const source &where, const run &one)
{
    std::printf("%-11s %-8s", who.name().c_str(), where.name.c_str());
    if (one.fastest_ms.empty())
        std::printf(" %9s %9s %9s", "-", "-", "-");
    else
        std::printf(" %9.3f %9.3f %9.3f", percentile(one.fastest_ms, 0.5), percentile(one.fastest_ms, 0.99),
                    percentile(one.fastest_ms, 1.0));
    if (who.reads() == marker_kind::none)
        std::printf("\n");
    else
        std::printf(" %9s %6zu %6zu  %s\n", count_of(one.score.frames_read, one.score.frames).c_str(),
                    one.score.pairs, one.score.wrong, memory_text(who, one).c_str());
}

void print_table(const measurement &all)
{
    std::printf("%-11s %-8s %9s %9s %9s %9s %6s %6s  %s\n", "decoder", "frames", "median ms", "p99 ms", "worst ms",
                "read", "pairs", "wrong", "workspace + peak heap, KiB");
    for (std::size_t r = 0; r < all.readers.size(); r++)
        for (std::size_t s = 0; s < all.sources.size(); s++)
            print_row(*all.readers[r], all.sources[s], all.runs[r][s]);
}

void print_tape_score(const measurement &all)
{
    const run *tape = all.find("tapemark", "tape");
    if (tape == nullptr)
        return;
    const tally &score = tape->score;
    std::printf("\ntapemark on tape: a whole marker is in view in %zu of %zu frames; tape markers read %zu, whole "
                "ones in view %zu\n(frame, marker) pairs wholly in view, by px per module:",
                score.frames_with_marker, score.frames, score.tape_markers, score.tape_markers_whole);
    for (std::size_t i = 0; i < score.recall.size(); i++)
        std::printf("%s from %g: %s", i == 0 ? "" : ",", module_size_classes[i],
                    count_of(score.recall[i].read, score.recall[i].in_view).c_str());
    std::printf("\n");
}

void print_wrong(const measurement &all)
{
    constexpr std::size_t shown = 5;
    for (std::size_t r = 0; r < all.readers.size(); r++)
        for (std::size_t s = 0; s < all.sources.size(); s++) {
            const std::vector<std::string> &list = all.runs[r][s].score.wrong_list;
            for (std::size_t i = 0; i < list.size() && i < shown; i++)
                std::printf("wrong: %s on %s, %s\n", all.readers[r]->name().c_str(), all.sources[s].name.c_str(),
                            list[i].c_str());
            if (list.size() > shown)
                std::printf("wrong: … and %zu more of these\n", list.size() - shown);
        }
}

void print_ratios(const measurement &all)
{
    const run *ours = all.find("tapemark", "tape");
    std::printf("\nHow many times the time of tapemark on tape (median of the ratios, frame by frame)\n");
    for (const auto &peer : all.readers)
        for (const char *where : {"tape", "aruco"}) {
            const std::optional<double> ratio = paired_ratio(all.find(peer->name(), where), ours);
            if (ratio && !(peer->name() == "tapemark" && std::string(where) == "tape"))
                std::printf("  %-11s on %-6s %8.2f x\n", peer->name().c_str(), where, *ratio);
        }
    std::printf("\nWorst frame of all against the median frame of tape\n");
    for (std::size_t r = 0; r < all.readers.size(); r++) {
        const std::optional<worst_frame> worst = find_worst(all, r);
        if (worst && all.readers[r]->reads() != marker_kind::none)
            std::printf("  %-11s %8.2f x  (%.3f ms: %s)\n", all.readers[r]->name().c_str(), worst->ratio, worst->ms,
                        worst->where.c_str());
    }
}

std::string limits_text(std::uint32_t limits)
{
    static const char *const names[] = {"scan", "work", "candidates", "cms", "tms", "length"};
    std::string text;
    for (std::size_t bit = 0; bit < std::size(names); bit++)
        if ((limits >> bit & 1U) != 0)
            text += (text.empty() ? "" : ", ") + std::string(names[bit]);
    return text;
}

void print_clutter(const measurement &all)
{
    const run *ours = all.find("tapemark", "clutter");
    const run *peer = all.find("aruco", "clutter");
    const run *ours_tape = all.find("tapemark", "tape");
    const run *peer_tape = all.find("aruco", "tape");
    if (ours == nullptr || peer == nullptr || ours_tape == nullptr || ours->fastest_ms.empty())
        return;
    const double ours_ms = percentile(ours_tape->fastest_ms, 0.5);
    const double peer_ms = percentile(peer_tape->fastest_ms, 0.5);
    std::printf("\nClutter, ms and medians of tape\n  %-26s %18s %20s  %s\n", "frame", "tapemark", "aruco",
                "limits that tapemark hit");
    for (const source &where : all.sources)
        for (std::size_t i = 0; where.name == "clutter" && i < where.frames.size(); i++)
            std::printf("  %-26s %9.3f %7.2f x %10.3f %7.2f x  %s\n", where.frames[i].label.c_str(),
                        ours->fastest_ms[i], ours->fastest_ms[i] / ours_ms, peer->fastest_ms[i],
                        peer->fastest_ms[i] / peer_ms, limits_text(ours->counters[i].limits).c_str());
}

}  // namespace

std::optional<worst_frame> find_worst(const measurement &all, std::size_t reader_index)
{
    const run *tape = all.find(all.readers[reader_index]->name(), "tape");
    if (tape == nullptr || tape->fastest_ms.empty())
        return std::nullopt;
    worst_frame worst = {0.0, 0.0, ""};
    for (std::size_t s = 0; s < all.sources.size(); s++) {
        const std::vector<double> &fastest_ms = all.runs[reader_index][s].fastest_ms;
        for (std::size_t i = 0; i < fastest_ms.size(); i++) {
            if (fastest_ms[i] <= worst.ms)
                continue;
            const frame &slow = all.sources[s].frames[i];
            worst.ms = fastest_ms[i];
            worst.where = all.sources[s].name + ", " +
                          (slow.label.empty() ? "frame " + std::to_string(slow.number) : slow.label);
        }
    }
    worst.ratio = worst.ms / percentile(tape->fastest_ms, 0.5);
    return worst;
}

void print_report(const measurement &all, const options &chosen)
{
    const cv::Size size = all.sources.front().frames.front().gray.size();
    std::printf("Frames of %d x %d px in memory, one thread, %s; each frame's fastest of %d passes, and the\n"
                "slowest frames timed again until proved\n", size.width,
                size.height, chosen.clock == clock_kind::wall ? "time on the wall" : "CPU time of the process",
                chosen.repeats);
    for (const auto &who : all.readers)
        std::printf("  %-11s %s\n", who->name().c_str(), who->settings().c_str());
    std::printf("\n");
    print_table(all);
    std::printf("read: frames with at least one correct reading. tapemark on tape is held against ground truth;\n"
                "aruco on its own video against the ids 0 to 56 that are there; everything else that is read is\n"
                "wrong. There is no video with AprilTags: apriltag is here for its time.\n");
    print_tape_score(all);
    print_wrong(all);
    if (chosen.repeats > 0) {
        print_ratios(all);
        print_clutter(all);
    }
}
