#include "options.hpp"

#include "readers.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <sstream>

const char *const usage_text =
    "usage: tapemark-bench [OPTION]...\n"
    "Times Tapemark, OpenCV's aruco and AprilTag on the same frames in one thread, and counts what they read.\n"
    "\n"
    "  --data DIR        folder with condition_a/tape.mp4, aruco.mp4, qrcode.mp4, stag.mp4 and truth.json\n"
    "                    (default: $TAPEMARK_PAPER_DATA, else the folder paper in ../shared beside the sources)\n"
    "  --only LIST       of tapemark, aruco, aruco-lean, apriltag, memcpy, gradient (default: all)\n"
    "  --sources LIST    of tape, aruco, qrcode, stag, clutter (default: all)\n"
    "  --frames A..B[:N] frames A to B of each video, every Nth of them (default: 0..99)\n"
    "  --repeat N        timed passes; a frame's time is its fastest one (default: 5; 0: decode once, untimed)\n"
    "  --clock wall|cpu  time on the wall or of this process alone (default: wall)\n"
    "  --json FILE       writes all numbers, those of each frame too\n"
    "  --check           fails unless Tapemark keeps its limits: no wrong id, at most 1/10 of aruco's time,\n"
    "                    worst frame at most 4 medians, 64 KiB of workspace, no heap\n"
    "  --help            prints this\n";

namespace {

std::string joined(const std::vector<std::string> &names)
{
    std::string all;
    for (const std::string &name : names)
        all += (all.empty() ? "" : ", ") + name;
    return all;
}

std::vector<std::string> parse_list(const std::string &option, const std::string &text,
                                    const std::vector<std::string> &known)
{
    std::vector<std::string> chosen;
    std::istringstream stream(text);
    for (std::string name; std::getline(stream, name, ',');) {
        if (std::find(known.begin(), known.end(), name) == known.end())
            throw usage_error(option + ": no \"" + name + "\"; there are " + joined(known));
        chosen.push_back(name);
    }
    if (chosen.empty())
        throw usage_error(option + ": an empty list; there are " + joined(known));
    return chosen;
}

int parse_count(const std::string &option, const std::string &text)
{
    const bool digits = !text.empty() && text.size() < 7 && text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits)
        throw usage_error(option + ": \"" + text + "\" is not a number from 0 to 999999");
    return std::stoi(text);
}

frame_range parse_range(const std::string &text)
{
    const std::size_t dots = text.find("..");
    if (dots == std::string::npos)
        throw usage_error("--frames: \"" + text + "\" is not FIRST..LAST or FIRST..LAST:STEP");
    const std::size_t colon = text.find(':', dots);
    frame_range range;
    range.first = parse_count("--frames", text.substr(0, dots));
    const std::size_t last_length = colon == std::string::npos ? colon : colon - dots - 2;
    range.last = parse_count("--frames", text.substr(dots + 2, last_length));
    if (colon != std::string::npos)
        range.step = parse_count("--frames", text.substr(colon + 1));
    if (range.first > range.last || range.step == 0)
        throw usage_error("--frames: \"" + text + "\" holds no frame; FIRST is at most LAST, STEP at least 1");
    return range;
}

clock_kind parse_clock(const std::string &text)
{
    if (text != "wall" && text != "cpu")
        throw usage_error("--clock: \"" + text + "\" is neither wall nor cpu");
    return text == "wall" ? clock_kind::wall : clock_kind::cpu;
}

std::string default_data_dir()
{
    const char *place = std::getenv("TAPEMARK_PAPER_DATA");
    return place != nullptr && *place != '\0' ? place : TAPEMARK_PAPER_DATA_DEFAULT;
}

void demand_what_is_checked(const options &chosen)
{
    const auto has = [](const std::vector<std::string> &list, const char *name) {
        return std::find(list.begin(), list.end(), name) != list.end();
    };
    if (!has(chosen.readers, "tapemark") || !has(chosen.readers, "aruco") || !has(chosen.sources, "tape") ||
        chosen.repeats == 0)
        throw usage_error("--check: needs tapemark, aruco, the source tape and at least one repeat");
}

}  // namespace

options parse_options(int argc, char **argv)
{
    options chosen;
    chosen.readers = reader_names();
    chosen.sources = source_names();
    chosen.data_dir = default_data_dir();
    const std::map<std::string, std::function<void(const std::string &)>> with_value = {
        {"--data", [&](const std::string &text) { chosen.data_dir = text; }},
        {"--only", [&](const std::string &text) { chosen.readers = parse_list("--only", text, reader_names()); }},
        {"--sources",
         [&](const std::string &text) { chosen.sources = parse_list("--sources", text, source_names()); }},
        {"--frames", [&](const std::string &text) { chosen.frames = parse_range(text); }},
        {"--repeat", [&](const std::string &text) { chosen.repeats = parse_count("--repeat", text); }},
        {"--clock", [&](const std::string &text) { chosen.clock = parse_clock(text); }},
        {"--json", [&](const std::string &text) { chosen.json_path = text; }},
    };
    for (int i = 1; i < argc; i++) {
        const std::string option = argv[i];
        const auto found = with_value.find(option);
        if (option == "--check")
            chosen.check = true;
        else if (option == "--help")
            chosen.help = true;
        else if (found == with_value.end())
            throw usage_error(option + ": no such option; --help lists them");
        else if (i + 1 == argc)
            throw usage_error(option + ": its value is missing");
        else
            found->second(argv[++i]);
    }
    if (chosen.check)
        demand_what_is_checked(chosen);
    return chosen;
}
