// Rendered frames are like those of the marker's inventors: a stretch of their walk is rendered again, from where
// their camera was, with `--like condition-a`, and both are measured.
#include "condition_a.hpp"
#include "likeness.hpp"
#include "paper_data.hpp"

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>

extern "C" {
#include <cmocka.h>

#include "render_options.h"
#include "scene.h"
}

namespace {

// From 1.7 to 5 px a module, near and far, head on and from the side.
const std::vector<int> stretch = {2, 6, 10, 13, 17, 19, 21, 39, 49, 57, 60, 63, 66, 68, 70};

constexpr double least_px = 1.5;

struct pair_of_looks {
    marker_look theirs, ours;
};

double focal_px;
std::vector<pair_of_looks> pairs;
std::vector<double> their_noise, our_noise;
std::size_t in_view, read_in_theirs, read_in_ours;

/* ---- Rendering their view -------------------------------------------------------------------------------- */

// What the program takes for `--like condition-a`.
render_options preset(int width_px, int height_px)
{
    const std::string size = std::to_string(width_px) + "x" + std::to_string(height_px);
    std::vector<std::string> words = {"tapemark-render", "--size", size, "--like", "condition-a", "-o", "x.pgm"};
    std::vector<char *> arguments;
    for (std::string &word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    render_options options;
    error_text error;
    if (render_options_parse(static_cast<int>(words.size()), arguments.data(), &options, &error) != OPTIONS_RUN)
        throw std::runtime_error(error.text);
    return options;
}

scene_vector vector_of(const cv::Vec3d &v)
{
    return {v[0], v[1], v[2]};
}

// Where a tape is, seen from the camera: the columns of its homography are its directions and its corner. Their tapes
// are some percent longer than they are high, so what is rendered has their length, and their middle line.
scene_tape place(const walk_tape &seen, const std::vector<std::int32_t> &ids, const cv::Mat &gray)
{
    constexpr double middle = static_cast<double>(TAPEMARK_HEIGHT_MODULES) / 2;
    const cv::Matx33d to_ray(1 / focal_px, 0, -(gray.cols - 1) / 2.0 / focal_px, 0, 1 / focal_px,
                             -(gray.rows - 1) / 2.0 / focal_px, 0, 0, 1);
    const cv::Matx33d h = to_ray * homography_of(seen.corners, width_modules_of(seen));
    const cv::Vec3d columns[] = {
        {h(0, 0), h(1, 0), h(2, 0)}, {h(0, 1), h(1, 1), h(2, 1)}, {h(0, 2), h(1, 2), h(2, 2)}};
    scene_tape tape = scene_tape_of(ids.data(), ids.size(), seen.bars);
    const double scale = tape.module_m / cv::norm(columns[0]);
    const cv::Vec3d along = columns[0] / cv::norm(columns[0]);
    const cv::Vec3d down = cv::normalize(columns[1] - along * along.dot(columns[1]));
    const cv::Vec3d left_middle = (columns[2] + middle * columns[1]) * scale;
    tape.along = vector_of(along);
    tape.down = vector_of(down);
    tape.origin_m = vector_of(left_middle - middle * tape.module_m * down);
    return tape;
}

struct rendered {
    cv::Mat gray;
    std::vector<walk_cm> cms;
};

walk_cm cm_of(const scene_cm_truth &truth)
{
    walk_cm cm;
    cm.id = truth.id;
    for (std::size_t i = 0; i < 4; i++)
        cm.corners[i] = {truth.corners[i].x_px, truth.corners[i].y_px};
    return cm;
}

rendered render_again(const walk_frame &frame)
{
    static scene_truth truth;
    std::vector<std::vector<std::int32_t>> ids;
    std::vector<scene_tape> tapes;
    render_options options = preset(frame.gray.cols, frame.gray.rows);
    for (const walk_tape &tape : frame.tapes)
        ids.emplace_back(tape.ids.begin(), tape.ids.end());
    for (std::size_t i = 0; i < ids.size(); i++) {
        tapes.push_back(place(frame.tapes[i], ids[i], frame.gray));
        tapes.back().light = options.paper;
        tapes.back().dark = options.ink;
    }
    scene view = options.view;
    view.seed = static_cast<std::uint64_t>(frame.number);
    view.camera.focal_px = focal_px;
    view.tapes = tapes.data();
    view.tape_count = tapes.size();
    render_options_release(&options);

    rendered again = {cv::Mat(frame.gray.size(), CV_8U), {}};
    const char *problem = scene_problem(&view);
    if (problem != nullptr || !scene_render(&view, again.gray.data, &truth))
        throw std::runtime_error(problem != nullptr ? problem : "not enough memory");
    for (std::size_t i = 0; i < truth.cm_count; i++)
        again.cms.push_back(cm_of(truth.cms[i]));
    return again;
}

/* ---- Measuring both -------------------------------------------------------------------------------------- */

bool has_read(const std::vector<reading> &readings, int id)
{
    return std::any_of(readings.begin(), readings.end(),
                       [id](const reading &one) { return one.code.empty() && one.id == id; });
}

// Of those with its id the nearest: their tapes have one of them twice.
const walk_cm &same_cm(const walk_cm &cm, const std::vector<walk_cm> &among)
{
    const walk_cm *nearest = nullptr;
    for (const walk_cm &other : among) {
        if (other.id == cm.id && (nearest == nullptr || cv::norm(other.corners[0] - cm.corners[0]) <
                                                            cv::norm(nearest->corners[0] - cm.corners[0])))
            nearest = &other;
    }
    if (nearest == nullptr)
        throw std::runtime_error("a CM is not in the rendered picture");
    return *nearest;
}

void measure(const walk_frame &frame)
{
    const rendered again = render_again(frame);
    const std::vector<reading> theirs = read_tapemark(frame.gray), ours = read_tapemark(again.gray);
    for (const walk_cm &cm : frame.cms) {
        if (!cm.whole || cm.px_min < least_px)
            continue;
        pairs.push_back({look_of(frame.gray, cm.id, homography_of(cm.corners, TAPEMARK_CM_WIDTH_MODULES)),
                         look_of(again.gray, cm.id, homography_of(same_cm(cm, again.cms).corners,
                                                                  TAPEMARK_CM_WIDTH_MODULES))});
        // Beside the tape there is wall above and floor below; the wall is less in shadow.
        const cv::Point2d above = (cm.corners[0] + cm.corners[1]) / 2 - cv::Point2d(0, 40);
        if (above.y > 16) {
            their_noise.push_back(noise_at(frame.gray, above));
            our_noise.push_back(noise_at(again.gray, above));
        }
        in_view++;
        read_in_theirs += has_read(theirs, cm.id);
        read_in_ours += has_read(ours, cm.id);
    }
}

int measure_stretch(void **)
{
    try {
        const std::vector<walk_frame> frames = load_walk(paper_data_folder(), stretch);
        focal_px = focal_of(frames);
        for (const walk_frame &frame : frames)
            measure(frame);
    } catch (const std::runtime_error &error) {
        print_error("%s\n", error.what());
        return -1;
    }
    return 0;
}

template <typename Getter> std::vector<double> all_of(Getter getter)
{
    std::vector<double> values;
    for (const pair_of_looks &pair : pairs)
        values.push_back(getter(pair));
    return values;
}

// A row of the table: medians over all CMs.
void assert_alike(const char *what, const std::vector<double> &theirs, const std::vector<double> &ours,
                  double tolerance)
{
    const double their = median_of(theirs), our = median_of(ours);
    print_message("%-36s theirs %7.3f   rendered %7.3f   may differ by %.3f\n", what, their, our, tolerance);
    assert_true(std::fabs(their - our) <= tolerance);
}

/* ---- What has to be alike -------------------------------------------------------------------------------- */

void focal_length_is_the_presets(void **)
{
    render_options options = preset(1080, 823);
    print_message("%-36s theirs %7.1f   preset   %7.1f\n", "focal length, px", focal_px, options.focal_px);
    assert_true(std::fabs(focal_px - options.focal_px) < 0.02 * focal_px);
    render_options_release(&options);
}

void contrast_is_alike(void **)
{
    assert_true(pairs.size() >= 40);
    assert_alike("light, gray levels", all_of([](const pair_of_looks &p) { return p.theirs.light; }),
                 all_of([](const pair_of_looks &p) { return p.ours.light; }), 6);
    assert_alike("dark, gray levels", all_of([](const pair_of_looks &p) { return p.theirs.dark; }),
                 all_of([](const pair_of_looks &p) { return p.ours.dark; }), 6);
    assert_alike("module contrast, gray levels",
                 all_of([](const pair_of_looks &p) { return p.theirs.light - p.theirs.dark; }),
                 all_of([](const pair_of_looks &p) { return p.ours.light - p.ours.dark; }), 8);
}

void blur_is_alike(void **)
{
    assert_alike("blur, sigma in px", all_of([](const pair_of_looks &p) { return p.theirs.blur_px; }),
                 all_of([](const pair_of_looks &p) { return p.ours.blur_px; }), 0.05);
    // Edges in their tapes are rougher: no column of their texture is quite as wide as the next, and they were not
    // averaged over pixels. That is not rendered again.
    const double theirs = median_of(all_of([](const pair_of_looks &p) { return p.theirs.unexplained; }));
    const double ours = median_of(all_of([](const pair_of_looks &p) { return p.ours.unexplained; }));
    print_message("%-36s theirs %7.3f   rendered %7.3f\n", "what no blur explains, gray levels", theirs, ours);
    assert_true(ours < theirs);
}

void noise_is_alike(void **)
{
    assert_alike("noise beside the tape, gray levels", their_noise, our_noise, 0.15);
}

void cells_are_alike(void **)
{
    const double correlation = median_of(all_of([](const pair_of_looks &p) {
        return correlation_of(p.theirs.cells, p.ours.cells);
    }));
    const double difference =
        median_of(all_of([](const pair_of_looks &p) { return difference_of(p.theirs.cells, p.ours.cells); }));
    print_message("cells of a CM, of %zu: correlation %.3f, difference %.3f of the contrast\n", pairs.size(),
                  correlation, difference);
    assert_true(correlation > 0.985);
    assert_true(difference < 0.07);
}

void decoder_reads_both_alike(void **)
{
    print_message("%zu CMs: read in theirs %zu, in rendered ones %zu\n", in_view, read_in_theirs, read_in_ours);
    assert_true(read_in_theirs * 100 >= in_view * 97);
    assert_true(read_in_ours * 100 >= in_view * 97);
}

}  // namespace

int main()
{
    paper_data_folder();
    const CMUnitTest tests[] = {
        cmocka_unit_test(focal_length_is_the_presets), cmocka_unit_test(contrast_is_alike),
        cmocka_unit_test(blur_is_alike),               cmocka_unit_test(noise_is_alike),
        cmocka_unit_test(cells_are_alike),             cmocka_unit_test(decoder_reads_both_alike),
    };
    return cmocka_run_group_tests(tests, measure_stretch, nullptr);
}
