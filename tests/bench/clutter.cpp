#include "frames.hpp"

extern "C" {
#include <scene.h>
}

#include <stdexcept>

namespace {

struct clutter {
    const char *label;
    scene_background background;
};

// Pictures from the same painter as those of the decoder's tests, as a good camera sees them.
const clutter clutter_list[] = {
    {"noise, strong", {SCENE_NOISE, 255, 0, 0.5, 0, {}}},
    {"noise, faint", {SCENE_NOISE, 158, 98, 0.5, 0, {}}},
    {"noise, coarse", {SCENE_NOISE, 255, 0, 5, 0, {}}},
    {"blinds, 12 px", {SCENE_BLINDS, 230, 60, 12, 91, {}}},
    {"blinds, upright, 4.5 px", {SCENE_BLINDS, 230, 60, 4.5, 3, {}}},
    {"popcorn ceiling, fine", {SCENE_POPCORN, 200, 100, 6, 0, {}}},
    {"popcorn ceiling, coarse", {SCENE_POPCORN, 200, 100, 16, 0, {}}},
    {"text, 1.5 px strokes", {SCENE_TEXT, 235, 30, 1.5, 0, {}}},
    {"text, 4 px strokes", {SCENE_TEXT, 235, 30, 4, 2, {}}},
    {"checkerboard, 3 px", {SCENE_CHECKERBOARD, 220, 30, 3, 0, {}}},
    {"checkerboard, 10 px", {SCENE_CHECKERBOARD, 220, 30, 10, 20, {}}},
    {"checkerboard, 40 px", {SCENE_CHECKERBOARD, 220, 30, 40, 0, {}}},
    {"bar codes, 2 px", {SCENE_STRIPES, 235, 30, 2, 0, {}}},
    {"squares in squares, 2 px", {SCENE_SQUARES, 235, 30, 2, 0, {}}},
    {"squares in squares, 5 px", {SCENE_SQUARES, 235, 30, 5, 10, {}}},
    {"grid codes, 3 px", {SCENE_GRID_CODES, 235, 30, 3, 0, {}}},
    {"finder patterns, 1.5 px", {SCENE_FINDER_ROWS, 235, 30, 1.5, 0, {}}},
    {"finder patterns, 3 px", {SCENE_FINDER_ROWS, 235, 30, 3, 5, {}}},
};

cv::Mat rendered(const clutter &one, cv::Size size)
{
    scene view = scene_default(size.width, size.height);
    view.background = one.background;
    cv::Mat picture(size, CV_8UC1);
    if (!scene_render(&view, picture.data, nullptr)) {
        const char *problem = scene_problem(&view);
        throw std::runtime_error(std::string("clutter \"") + one.label + "\" cannot be painted: " +
                                 (problem != nullptr ? problem : "out of memory"));
    }
    return picture;
}

}  // namespace

std::vector<frame> make_clutter(cv::Size size)
{
    std::vector<frame> frames;
    for (const clutter &one : clutter_list)
        frames.push_back({rendered(one, size), static_cast<int>(frames.size()), one.label});
    return frames;
}
