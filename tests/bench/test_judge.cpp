// What counts as right and as wrong in the benchmark, on a ground truth of two frames.
#include "judge.hpp"
#include "statistics.hpp"

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <stdexcept>

extern "C" {
#include <cmocka.h>
}

namespace {

const char *const truth_text = R"([
 {"frame": 4,
  "cms": [
   {"id": 7, "full": true, "px_min_sv": 1.2, "corners": [[100, 50], [164, 50], [164, 64], [100, 64]]},
   {"id": -8, "full": true, "px_min_sv": 3.5, "corners": [[150, 50], [214, 50], [214, 64], [150, 64]]},
   {"id": 9, "full": false, "px_min_sv": 2.5, "corners": [[200, 50], [264, 50], [264, 64], [200, 64]]}],
  "segments": [{"ids": [7, -8, 9], "full": true}, {"ids": [30, 31], "full": true}],
  "uncertain": []},
 {"frame": 5, "cms": [], "segments": [{"ids": [-50, -51, -52], "full": false}],
  "uncertain": [{"ids": [-40, 41, 42]}]}
])";

const char *const truth_path = "test_judge_truth.json";

reading cm_at(int id, float x, float y)
{
    reading one;
    one.id = id;
    one.corners = {cv::Point2f(x - 32, y - 7), {x + 32, y - 7}, {x + 32, y + 7}, {x - 32, y + 7}};
    return one;
}

reading tm_with(const char *code, bool directed)
{
    reading one;
    one.code = code;
    one.directed = directed;
    return one;
}

tape_truth load_truth(const char *text)
{
    std::ofstream(truth_path) << text;
    tape_truth truth(truth_path);
    std::remove(truth_path);
    return truth;
}

void counts_what_is_right(void **)
{
    const tally sum = load_truth(truth_text).judge(
        4, {cm_at(7, 132, 57), cm_at(-8, 182, 57), cm_at(9, 232, 57), tm_with("101", true)});
    assert_int_equal(sum.frames_read, 1);
    assert_int_equal(sum.frames_with_marker, 1);
    assert_int_equal(sum.pairs, 3);
    assert_int_equal(sum.tape_markers, 1);
    assert_int_equal(sum.tape_markers_whole, 1);
    assert_int_equal(sum.wrong, 0);
}

void sorts_by_module_size(void **)
{
    const tally sum = load_truth(truth_text).judge(4, {cm_at(-8, 182, 57), cm_at(9, 232, 57)});
    assert_int_equal(sum.recall[1].in_view, 1);
    assert_int_equal(sum.recall[1].read, 0);
    assert_int_equal(sum.recall[4].in_view, 1);
    assert_int_equal(sum.recall[4].read, 1);
    assert_int_equal(sum.recall[3].in_view, 0);
}

void counts_a_marker_once(void **)
{
    const tally sum = load_truth(truth_text).judge(4, {cm_at(7, 132, 57), cm_at(7, 133, 57)});
    assert_int_equal(sum.pairs, 1);
    assert_int_equal(sum.wrong, 0);
}

void another_id_is_wrong(void **)
{
    const tally sum = load_truth(truth_text).judge(4, {cm_at(8, 182, 57)});
    assert_int_equal(sum.frames_read, 0);
    assert_int_equal(sum.wrong, 1);
    assert_string_equal(sum.wrong_list[0].c_str(), "frame 4: 8");
}

void another_place_is_wrong(void **)
{
    const tape_truth truth = load_truth(truth_text);
    assert_int_equal(truth.judge(4, {cm_at(7, 147, 57)}).wrong, 0);
    assert_int_equal(truth.judge(4, {cm_at(7, 149, 57)}).wrong, 1);
}

void a_code_backwards_is_wrong_when_directed(void **)
{
    const tape_truth truth = load_truth(truth_text);
    assert_int_equal(truth.judge(4, {tm_with("100", true)}).wrong, 1);
    assert_int_equal(truth.judge(4, {tm_with("11", true)}).wrong, 1);
    assert_int_equal(truth.judge(5, {tm_with("011", true)}).tape_markers, 1);
    assert_int_equal(truth.judge(5, {tm_with("110", false)}).tape_markers, 1);
}

void a_code_where_the_truth_is_uncertain_counts_for_nothing(void **)
{
    const tally sum = load_truth(truth_text).judge(5, {tm_with("110", true)});
    assert_int_equal(sum.tape_markers, 0);
    assert_int_equal(sum.wrong, 0);
}

void whole_tape_markers_are_counted(void **)
{
    const tape_truth truth = load_truth(truth_text);
    assert_int_equal(truth.judge(4, {}).tape_markers_whole, 1);
    assert_int_equal(truth.judge(5, {}).tape_markers_whole, 0);
}

void uncertain_ids_count_for_nothing(void **)
{
    const tally sum = load_truth(truth_text).judge(5, {cm_at(-40, 500, 500)});
    assert_int_equal(sum.wrong, 0);
    assert_int_equal(sum.pairs, 0);
    assert_int_equal(sum.frames_read, 0);
    assert_int_equal(load_truth(truth_text).judge(5, {cm_at(40, 500, 500)}).wrong, 1);
}

void without_truth_ids_must_be_plausible(void **)
{
    const tally sum = judge_plausible(0, {cm_at(0, 9, 9), cm_at(56, 9, 9), cm_at(56, 90, 9), cm_at(57, 9, 9)});
    assert_int_equal(sum.pairs, 2);
    assert_int_equal(sum.wrong, 1);
    assert_int_equal(sum.frames_read, 1);
    assert_int_equal(judge_plausible(0, {}).frames_read, 0);
}

void where_no_marker_is_every_reading_is_wrong(void **)
{
    assert_int_equal(judge_absent(3, {cm_at(7, 9, 9), tm_with("101", true)}).wrong, 2);
    assert_int_equal(judge_absent(3, {}).wrong, 0);
}

void tallies_add_up(void **)
{
    const tape_truth truth = load_truth(truth_text);
    tally sum = truth.judge(4, {cm_at(7, 132, 57), tm_with("101", true), cm_at(5, 9, 9)});
    sum.add(truth.judge(4, {cm_at(7, 132, 57), tm_with("101", true)}));
    sum.add(truth.judge(5, {cm_at(6, 9, 9)}));
    assert_int_equal(sum.frames, 3);
    assert_int_equal(sum.frames_with_marker, 2);
    assert_int_equal(sum.frames_read, 2);
    assert_int_equal(sum.pairs, 2);
    assert_int_equal(sum.tape_markers, 2);
    assert_int_equal(sum.tape_markers_whole, 2);
    assert_int_equal(sum.wrong, 2);
    assert_int_equal(sum.wrong_list.size(), 2);
    assert_int_equal(sum.recall[1].in_view, 2);
    assert_int_equal(sum.recall[1].read, 2);
}

void damaged_truth_is_refused(void **)
{
    const char *const damaged[] = {"", "{}", R"([{"frame": 1}])",
                                   R"([{"frame": 1, "segments": [], "cms": [{"id": 1, "full": true}]}])",
                                   R"([{"frame": 1, "segments": [], "cms": [{"id": 1, "full": true, "px_min_sv": 2,
                                       "corners": [[1, 1], [9, 1], [9, 5], [1, 5], [1, 3]]}]}])"};
    for (const char *text : damaged) {
        std::string message;
        try {
            load_truth(text);
        } catch (const std::runtime_error &error) {
            message = error.what();
        }
        std::remove(truth_path);
        assert_int_equal(message.find(truth_path), 0);
    }
}

void percentiles_are_of_the_nearest_rank(void **)
{
    std::vector<double> values;
    for (int i = 100; i > 0; i--)
        values.push_back(i);
    assert_true(percentile(values, 0.5) == 50.0);
    assert_true(percentile(values, 0.99) == 99.0);
    assert_true(percentile(values, 1.0) == 100.0);
    assert_true(percentile({3.0}, 0.5) == 3.0);
}

void ratios_are_of_the_same_frame(void **)
{
    const std::vector<double> slow = {10.0, 40.0, 900.0};
    const std::vector<double> fast = {1.0, 20.0, 300.0, 5.0};
    assert_true(median_ratio(slow, fast) == 3.0);
}

}  // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(counts_what_is_right),
        cmocka_unit_test(sorts_by_module_size),
        cmocka_unit_test(counts_a_marker_once),
        cmocka_unit_test(another_id_is_wrong),
        cmocka_unit_test(another_place_is_wrong),
        cmocka_unit_test(a_code_backwards_is_wrong_when_directed),
        cmocka_unit_test(a_code_where_the_truth_is_uncertain_counts_for_nothing),
        cmocka_unit_test(whole_tape_markers_are_counted),
        cmocka_unit_test(uncertain_ids_count_for_nothing),
        cmocka_unit_test(without_truth_ids_must_be_plausible),
        cmocka_unit_test(where_no_marker_is_every_reading_is_wrong),
        cmocka_unit_test(tallies_add_up),
        cmocka_unit_test(damaged_truth_is_refused),
        cmocka_unit_test(percentiles_are_of_the_nearest_rank),
        cmocka_unit_test(ratios_are_of_the_same_frame),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
