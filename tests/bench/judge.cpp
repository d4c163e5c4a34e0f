#include "judge.hpp"

#include <cjson/cJSON.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace {

constexpr int places = 57;

const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(object, name);
    if (found == nullptr)
        throw std::runtime_error(std::string("an entry lacks \"") + name + "\"");
    return found;
}

double number(const cJSON *value, const char *what)
{
    if (!cJSON_IsNumber(value))
        throw std::runtime_error(std::string("\"") + what + "\" is not a number");
    return value->valuedouble;
}

std::array<cv::Point2f, 4> corners_of(const cJSON *array)
{
    if (cJSON_GetArraySize(array) != 4)
        throw std::runtime_error("\"corners\" are not four");
    std::array<cv::Point2f, 4> out;
    for (int i = 0; i < 4; i++) {
        const cJSON *corner = cJSON_GetArrayItem(array, i);
        out[static_cast<std::size_t>(i)] = {static_cast<float>(number(cJSON_GetArrayItem(corner, 0), "corners")),
                                            static_cast<float>(number(cJSON_GetArrayItem(corner, 1), "corners"))};
    }
    return out;
}

cv::Point2f centre_of(const std::array<cv::Point2f, 4> &corners)
{
    return (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0F;
}

std::vector<int> ids_of(const cJSON *entry)
{
    std::vector<int> ids;
    const cJSON *id = nullptr;
    cJSON_ArrayForEach(id, cJSON_GetObjectItemCaseSensitive(entry, "ids")) ids.push_back(id->valueint);
    return ids;
}

std::string code_of(const std::vector<int> &ids)
{
    std::string code;
    for (int id : ids)
        code += id < 0 ? '0' : '1';
    return code;
}

void note_wrong(tally &sum, int frame, const reading &one)
{
    sum.wrong++;
    sum.wrong_list.push_back("frame " + std::to_string(frame) + ": " +
                             (one.code.empty() ? std::to_string(one.id) : "TM " + one.code));
}

std::string text_of(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw std::runtime_error(path + ": cannot be opened");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

void tally::add(const tally &other)
{
    frames += other.frames;
    frames_with_marker += other.frames_with_marker;
    frames_read += other.frames_read;
    pairs += other.pairs;
    tape_markers += other.tape_markers;
    tape_markers_whole += other.tape_markers_whole;
    wrong += other.wrong;
    wrong_list.insert(wrong_list.end(), other.wrong_list.begin(), other.wrong_list.end());
    for (std::size_t i = 0; i < recall.size(); i++) {
        recall[i].in_view += other.recall[i].in_view;
        recall[i].read += other.recall[i].read;
    }
}

tape_truth::tape_truth(const std::string &path)
{
    const std::string text = text_of(path);
    const std::unique_ptr<cJSON, void (*)(cJSON *)> root(cJSON_ParseWithLength(text.data(), text.size()),
                                                         cJSON_Delete);
    if (!cJSON_IsArray(root.get()))
        throw std::runtime_error(path + ": not a JSON array with an object for each frame");
    try {
        const cJSON *entry = nullptr;
        cJSON_ArrayForEach(entry, root.get()) load_frame(entry);
    } catch (const std::runtime_error &error) {
        throw std::runtime_error(path + ": " + error.what());
    }
}

void tape_truth::load_frame(const cJSON *entry)
{
    frame_truth &truth = frames_[static_cast<int>(number(member(entry, "frame"), "frame"))];
    const cJSON *item = nullptr;
    cJSON_ArrayForEach(item, member(entry, "cms"))
    {
        truth.cms.push_back({static_cast<int>(number(member(item, "id"), "id")),
                             cJSON_IsTrue(member(item, "full")) != 0,
                             number(member(item, "px_min_sv"), "px_min_sv"), corners_of(member(item, "corners"))});
    }
    cJSON_ArrayForEach(item, member(entry, "segments"))
    {
        const std::vector<int> ids = ids_of(item);
        if (ids.size() < 3)
            continue;
        truth.codes.insert(code_of(ids));
        truth.whole_tape_markers += cJSON_IsTrue(member(item, "full")) != 0;
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(entry, "uncertain"))
    {
        const std::vector<int> ids = ids_of(item);
        truth.uncertain = true;
        truth.uncertain_ids.insert(ids.begin(), ids.end());
        if (ids.size() >= 3)
            truth.codes.insert(code_of(ids));
    }
}

bool tape_truth::near(const reading &one, const code_marker &truth)
{
    const cv::Point2f off = centre_of(one.corners) - centre_of(truth.corners);
    const auto [x_min, x_max] = std::minmax_element(truth.corners.begin(), truth.corners.end(),
                                                    [](cv::Point2f a, cv::Point2f b) { return a.x < b.x; });
    const auto [y_min, y_max] = std::minmax_element(truth.corners.begin(), truth.corners.end(),
                                                    [](cv::Point2f a, cv::Point2f b) { return a.y < b.y; });
    const float size = std::max(x_max->x - x_min->x, y_max->y - y_min->y);
    return std::max(std::abs(off.x), std::abs(off.y)) <= 0.2F * size + 3.0F;
}

tally tape_truth::judge(int frame, const std::vector<reading> &readings) const
{
    const auto found = frames_.find(frame);
    if (found == frames_.end())
        throw std::runtime_error("the ground truth has no frame " + std::to_string(frame));
    const frame_truth &truth = found->second;
    tally sum;
    std::vector<bool> read(truth.cms.size(), false);
    std::set<std::string> codes_read;
    for (const reading &one : readings) {
        if (one.code.empty()) {
            const auto hit = std::find_if(truth.cms.begin(), truth.cms.end(), [&](const code_marker &cm) {
                return cm.id == one.id && near(one, cm);
            });
            if (hit != truth.cms.end())
                read[static_cast<std::size_t>(hit - truth.cms.begin())] = true;
            else if (truth.uncertain_ids.count(one.id) == 0)
                note_wrong(sum, frame, one);
        } else {
            const std::string reversed(one.code.rbegin(), one.code.rend());
            if (truth.codes.count(one.code) != 0 || (!one.directed && truth.codes.count(reversed) != 0))
                codes_read.insert(one.code);
            else if (!truth.uncertain)
                note_wrong(sum, frame, one);
        }
    }
    for (std::size_t i = 0; i < read.size(); i++) {
        sum.pairs += read[i];
        if (!truth.cms[i].whole)
            continue;
        sum.frames_with_marker = 1;
        std::size_t size_class = module_size_classes.size() - 1;
        while (size_class > 0 && truth.cms[i].px_per_module < module_size_classes[size_class])
            size_class--;
        sum.recall[size_class].in_view++;
        sum.recall[size_class].read += read[i];
    }
    sum.frames = 1;
    sum.tape_markers = codes_read.size();
    sum.tape_markers_whole = truth.whole_tape_markers;
    sum.frames_read = sum.pairs + sum.tape_markers > 0;
    return sum;
}

tally judge_plausible(int frame, const std::vector<reading> &readings)
{
    tally sum;
    std::set<int> ids;
    for (const reading &one : readings) {
        if (one.id < 0 || one.id >= places)
            note_wrong(sum, frame, one);
        else
            ids.insert(one.id);
    }
    sum.frames = 1;
    sum.frames_with_marker = 1;
    sum.pairs = ids.size();
    sum.frames_read = !ids.empty();
    return sum;
}

tally judge_absent(int frame, const std::vector<reading> &readings)
{
    tally sum;
    sum.frames = 1;
    for (const reading &one : readings)
        note_wrong(sum, frame, one);
    return sum;
}
