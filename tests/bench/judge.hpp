// Right and wrong: readings held against what is known to be in the frame.
#pragma once

#include "reading.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

// Lower ends of the classes of module size, in px per module in the direction in which it is smallest.
constexpr std::array<double, 5> module_size_classes = {0.0, 1.0, 1.5, 2.0, 3.0};

struct class_recall {
    std::size_t in_view = 0;
    std::size_t read = 0;
};

struct tally {
    std::size_t frames = 0;
    std::size_t frames_with_marker = 0;  // a whole marker is in view; all frames where there is no ground truth
    std::size_t frames_read = 0;         // at least one correct reading
    std::size_t pairs = 0;               // (frame, marker) pairs read correctly
    std::size_t tape_markers = 0;        // tape markers read correctly
    std::size_t tape_markers_whole = 0;  // those that are wholly in view
    std::size_t wrong = 0;
    std::vector<std::string> wrong_list;
    std::array<class_recall, module_size_classes.size()> recall = {};

    void add(const tally &other);
};

// Ground truth of a tape video: truth.json as the paper's data folder has it.
class tape_truth {
public:
    // Throws std::runtime_error naming the file and what is wrong with it.
    explicit tape_truth(const std::string &path);
    tally judge(int frame, const std::vector<reading> &readings) const;

private:
    struct code_marker {
        int id;
        bool whole;
        double px_per_module;
        std::array<cv::Point2f, 4> corners;
    };
    struct frame_truth {
        std::vector<code_marker> cms;
        std::set<std::string> codes;       // of all tape markers in view, those without trusted corners too
        std::size_t whole_tape_markers = 0;
        std::set<int> uncertain_ids;       // in view, but without trusted corners: neither right nor wrong
        bool uncertain = false;
    };
    static bool near(const reading &one, const code_marker &truth);
    void load_frame(const struct cJSON *entry);

    std::map<int, frame_truth> frames_;
};

// The paper's other videos have no ground truth, but the same 57 places: an id of 0 to 56 counts as right.
tally judge_plausible(int frame, const std::vector<reading> &readings);

// Where no marker of the decoder's kind is in view, whatever it reads is wrong.
tally judge_absent(int frame, const std::vector<reading> &readings);
