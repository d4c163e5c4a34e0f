#include "report.hpp"

#include "heap.h"

#include <tapemark.h>

#include <cjson/cJSON.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

namespace {

void add_count(cJSON *object, const char *name, std::size_t count)
{
    cJSON_AddNumberToObject(object, name, static_cast<double>(count));
}

void add_times(cJSON *object, const run &one)
{
    if (one.fastest_ms.empty())
        return;
    cJSON_AddNumberToObject(object, "median_ms", percentile(one.fastest_ms, 0.5));
    cJSON_AddNumberToObject(object, "p99_ms", percentile(one.fastest_ms, 0.99));
    cJSON_AddNumberToObject(object, "worst_ms", percentile(one.fastest_ms, 1.0));
    cJSON_AddNumberToObject(object, "median_ms_all_passes", percentile(one.all_ms, 0.5));
    cJSON_AddNumberToObject(object, "p99_ms_all_passes", percentile(one.all_ms, 0.99));
    cJSON_AddNumberToObject(object, "worst_ms_all_passes", percentile(one.all_ms, 1.0));
}

void add_score(cJSON *object, const tally &score)
{
    add_count(object, "frames_read", score.frames_read);
    add_count(object, "pairs", score.pairs);
    add_count(object, "wrong", score.wrong);
    cJSON *list = cJSON_AddArrayToObject(object, "wrong_list");
    for (const std::string &entry : score.wrong_list)
        cJSON_AddItemToArray(list, cJSON_CreateString(entry.c_str()));
}

void add_truth(cJSON *object, const tally &score)
{
    add_count(object, "frames_with_whole_marker", score.frames_with_marker);
    add_count(object, "tape_markers", score.tape_markers);
    add_count(object, "tape_markers_whole", score.tape_markers_whole);
    cJSON *list = cJSON_AddArrayToObject(object, "recall_by_module_size");
    for (std::size_t i = 0; i < score.recall.size(); i++) {
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddNumberToObject(entry, "from_px_per_module", module_size_classes[i]);
        add_count(entry, "in_view", score.recall[i].in_view);
        add_count(entry, "read", score.recall[i].read);
        cJSON_AddItemToArray(list, entry);
    }
}

void add_frames(cJSON *object, const reader &who, const source &where, const run &one)
{
    cJSON *list = cJSON_AddArrayToObject(object, "each_frame");
    for (std::size_t i = 0; i < where.frames.size(); i++) {
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddNumberToObject(entry, "frame", where.frames[i].number);
        if (!where.frames[i].label.empty())
            cJSON_AddStringToObject(entry, "label", where.frames[i].label.c_str());
        if (i < one.fastest_ms.size())
            cJSON_AddNumberToObject(entry, "fastest_ms", one.fastest_ms[i]);
        if (who.reads() == marker_kind::tape) {
            cJSON_AddNumberToObject(entry, "work", one.counters[i].work);
            cJSON_AddNumberToObject(entry, "limits", one.counters[i].limits);
        }
        cJSON_AddItemToArray(list, entry);
    }
}

cJSON *run_object(const reader &who, const source &where, const run &one)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "decoder", who.name().c_str());
    cJSON_AddStringToObject(object, "source", where.name.c_str());
    add_count(object, "frames", where.frames.size());
    add_times(object, one);
    if (who.reads() != marker_kind::none) {
        add_score(object, one.score);
        add_count(object, "workspace_bytes", who.workspace_bytes());
        if (heap_is_counted())
            add_count(object, "peak_heap_bytes", one.heap_bytes);
    }
    if (who.reads() == marker_kind::tape && where.shows == marker_kind::tape)
        add_truth(object, one.score);
    add_frames(object, who, where, one);
    return object;
}

void add_comparisons(cJSON *root, const measurement &all)
{
    cJSON *ratios = cJSON_AddArrayToObject(root, "times_of_tapemark_on_tape");
    cJSON *worst_list = cJSON_AddArrayToObject(root, "worst_over_median");
    for (std::size_t r = 0; r < all.readers.size(); r++) {
        for (const source &where : all.sources) {
            const std::optional<double> ratio = paired_ratio(all.find(all.readers[r]->name(), where.name),
                                                             all.find("tapemark", "tape"));
            if (!ratio || where.name == "clutter")
                continue;
            cJSON *entry = cJSON_CreateObject();
            cJSON_AddStringToObject(entry, "decoder", all.readers[r]->name().c_str());
            cJSON_AddStringToObject(entry, "source", where.name.c_str());
            cJSON_AddNumberToObject(entry, "ratio", *ratio);
            cJSON_AddItemToArray(ratios, entry);
        }
        const std::optional<worst_frame> worst = find_worst(all, r);
        if (!worst)
            continue;
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddStringToObject(entry, "decoder", all.readers[r]->name().c_str());
        cJSON_AddNumberToObject(entry, "ratio", worst->ratio);
        cJSON_AddStringToObject(entry, "frame", worst->where.c_str());
        cJSON_AddItemToArray(worst_list, entry);
    }
}

}  // namespace

void write_json(const measurement &all, const options &chosen, const std::string &path)
{
    const std::unique_ptr<cJSON, void (*)(cJSON *)> root(cJSON_CreateObject(), cJSON_Delete);
    cJSON_AddStringToObject(root.get(), "tapemark", tapemark_version());
    cJSON_AddStringToObject(root.get(), "opencv", CV_VERSION);
    cJSON_AddStringToObject(root.get(), "clock", chosen.clock == clock_kind::wall ? "wall" : "cpu");
    cJSON_AddNumberToObject(root.get(), "passes", chosen.repeats);
    cJSON *runs = cJSON_AddArrayToObject(root.get(), "runs");
    for (std::size_t r = 0; r < all.readers.size(); r++)
        for (std::size_t s = 0; s < all.sources.size(); s++)
            cJSON_AddItemToArray(runs, run_object(*all.readers[r], all.sources[s], all.runs[r][s]));
    add_comparisons(root.get(), all);

    const std::unique_ptr<char, void (*)(void *)> text(cJSON_Print(root.get()), cJSON_free);
    std::FILE *file = std::fopen(path.c_str(), "w");
    if (file == nullptr)
        throw std::runtime_error(path + ": cannot be created");
    const bool written = std::fputs(text.get(), file) >= 0 && std::fputc('\n', file) != EOF;
    if (std::fclose(file) != 0 || !written)
        throw std::runtime_error(path + ": cannot be written to its end");
}
