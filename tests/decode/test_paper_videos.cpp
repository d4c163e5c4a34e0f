// The videos of the marker's inventors: how much of the tape is read, and that nothing is read where there is none.
#include "frames.hpp"
#include "judge.hpp"
#include "paper_data.hpp"

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

extern "C" {
#include <cmocka.h>
}

namespace {

std::string folder;
tally sum;

// Ends with a failure where a file of the data is missing or broken.
source frames_of(const char *video)
{
    try {
        return load_source(video, folder, {});
    } catch (const std::runtime_error &error) {
        fail_msg("%s", error.what());
        throw;
    }
}

int decode_tape_video(void **)
{
    const tape_truth truth(folder + "/condition_a/truth.json");
    for (const frame &one : frames_of("tape").frames)
        sum.add(truth.judge(one.number, read_tapemark(one.gray)));
    return 0;
}

void reads_nothing_wrong(void **)
{
    assert_int_equal(sum.frames, 100);
    for (const std::string &wrong : sum.wrong_list)
        print_error("%s\n", wrong.c_str());
    assert_int_equal(sum.wrong, 0);
}

void reads_most_frames(void **)
{
    assert_true(sum.frames_read >= 86);
}

// From 1.5 px a module on, 97 of 100 CMs; below, down to one pixel, 80.
void reads_most_cms(void **)
{
    std::size_t in_view = 0, read = 0;
    for (std::size_t i = 2; i < module_size_classes.size(); i++) {
        in_view += sum.recall[i].in_view;
        read += sum.recall[i].read;
    }
    print_message("%zu of %zu CMs from 1.5 px a module on, %zu of %zu from 1 px\n", read, in_view, sum.recall[1].read,
                  sum.recall[1].in_view);
    assert_int_equal(in_view, 487);
    assert_int_equal(sum.recall[1].in_view, 53);
    assert_true(100 * read >= 97 * in_view);
    assert_true(100 * sum.recall[1].read >= 80 * sum.recall[1].in_view);
}

void reads_most_tms(void **)
{
    assert_int_equal(sum.tape_markers_whole, 63);
    assert_true(10 * sum.tape_markers >= 9 * sum.tape_markers_whole);
}

void reads_nothing_in_other_videos(void **)
{
    for (const char *video : {"aruco", "qrcode", "stag"}) {
        const source other = frames_of(video);
        assert_int_equal(other.frames.size(), 100);
        for (const frame &one : other.frames) {
            const std::vector<reading> readings = read_tapemark(one.gray);
            if (!readings.empty())
                fail_msg("%s, frame %d: %d %s was read", video, one.number, readings[0].id, readings[0].code.c_str());
        }
    }
}

}  // namespace

int main()
{
    folder = paper_data_folder();
    const CMUnitTest tests[] = {
        cmocka_unit_test(reads_nothing_wrong),
        cmocka_unit_test(reads_most_frames),
        cmocka_unit_test(reads_most_cms),
        cmocka_unit_test(reads_most_tms),
        cmocka_unit_test(reads_nothing_in_other_videos),
    };
    return cmocka_run_group_tests(tests, decode_tape_video, nullptr);
}
