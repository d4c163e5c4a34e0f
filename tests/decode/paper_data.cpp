#include "paper_data.hpp"

#include <tapemark.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace {

constexpr int skipped = 77;
constexpr std::size_t cms_max = 64, tms_max = 16;

std::array<cv::Point2f, 4> points(const tapemark_point corners[4])
{
    std::array<cv::Point2f, 4> out;
    for (std::size_t i = 0; i < 4; i++)
        out[i] = {corners[i].x_px, corners[i].y_px};
    return out;
}

}  // namespace

std::string paper_data_folder()
{
    const char *named = std::getenv("TAPEMARK_PAPER_DATA");
    const std::string folder = named != nullptr ? named : TAPEMARK_PAPER_DATA_DEFAULT;
    if (std::filesystem::is_directory(folder))
        return folder;
    const char *required = std::getenv("TAPEMARK_REQUIRE_PAPER_DATA");
    const bool fails = required != nullptr && std::string(required) == "1";
    std::printf("there is no %s (set TAPEMARK_PAPER_DATA to the folder of the paper's data)\n", folder.c_str());
    std::exit(fails ? EXIT_FAILURE : skipped);
}

std::vector<reading> read_tapemark(const cv::Mat &gray)
{
    const tapemark_image image = {gray.data, gray.cols, gray.rows, static_cast<std::ptrdiff_t>(gray.step[0])};
    std::vector<std::uint8_t> workspace(tapemark_workspace_bytes(gray.cols, gray.rows));
    std::vector<tapemark_cm> cms(cms_max);
    std::vector<tapemark_tm> tms(tms_max);
    tapemark_result result = {};
    result.cms = cms.data();
    result.cm_capacity = cms.size();
    result.tms = tms.data();
    result.tm_capacity = tms.size();
    const tapemark_status status = tapemark_decode(&image, nullptr, workspace.data(), workspace.size(), &result);
    if (status < 0 || status == TAPEMARK_NO_ROOM)
        throw std::runtime_error(std::string("tapemark_decode: ") + tapemark_status_text(status));
    std::vector<reading> all;
    for (std::size_t i = 0; i < result.cm_count; i++)
        all.push_back({cms[i].id, "", true, points(cms[i].corners)});
    for (std::size_t i = 0; i < result.tm_count; i++)
        all.push_back({0, tms[i].code, tms[i].directed, points(tms[i].corners)});
    return all;
}
