// What tapemark-make prints, module by module, against the format's test vectors and the pictures that the marker's
// inventors published.
#include <opencv2/imgcodecs.hpp>

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <unistd.h>
#include <vector>

extern "C" {
#include <cmocka.h>
}

namespace {

constexpr int skipped = 77;
constexpr int height_modules = 7, cm_modules = 32, cm_pitch = 25, coding_left = 8, coding_columns = 16;

std::string program;
std::filesystem::path paper, work;

// Rows of '#' for ink and '.' for paper, without the quiet zone.
using grid = std::vector<std::string>;

// Takes the middle of each module. The quiet zone is one module above and below, and `side_modules` at the ends.
grid sample(const std::filesystem::path &picture, int side_modules, int width_modules)
{
    const cv::Mat gray = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
    if (gray.empty())
        fail_msg("%s cannot be read", picture.c_str());
    const double across_px = gray.rows / (height_modules + 2.0);
    const double along_px = gray.cols / (width_modules + 2.0 * side_modules);
    grid modules;
    for (int row = 0; row < height_modules; row++) {
        std::string line;
        for (int column = 0; column < width_modules; column++) {
            const int x = static_cast<int>((column + side_modules + 0.5) * along_px);
            const int y = static_cast<int>((row + 1.5) * across_px);
            line += gray.at<std::uint8_t>(y, x) < 128 ? '#' : '.';
        }
        modules.push_back(line);
    }
    return modules;
}

int width_of(int cm_count)
{
    return cm_pitch * cm_count + (cm_count >= 3 ? 23 : 7);
}

int side_of(int cm_count)
{
    return cm_count >= 3 ? 2 : 1;
}

// Runs the program and returns its only picture that has these ids, without signs, in its name.
std::filesystem::path make(const std::string &arguments, int first, int last)
{
    const std::string command = program + " " + arguments + " --module 1mm --png 254 --no-labels --paper roll " +
                                "--quiet -o " + (work / "made").string();
    std::filesystem::remove_all(work / "made");
    if (std::system(command.c_str()) != 0)
        fail_msg("%s", command.c_str());
    char ending[40];
    if (first == last)
        std::snprintf(ending, sizeof ending, "-cm%04d.png", first);
    else
        std::snprintf(ending, sizeof ending, "-cm%04d-%04d.png", first, last);
    for (const auto &entry : std::filesystem::directory_iterator(work / "made")) {
        const std::string name = entry.path().filename().string();
        if (name.size() > std::string(ending).size() && name.find(ending) == name.size() - std::string(ending).size())
            return entry.path();
    }
    fail_msg("no picture *%s from %s", ending, command.c_str());
    return {};
}

// ---- The pictures of the marker's inventors -----------------------------------------------------------------

void equals_the_published_pictures(void **)
{
    const struct {
        const char *file;
        int first, count;
        const char *arguments;
    } pictures[] = {
        {"CM15.jpg", 15, 1, "--cms 1 --first-id 15"},
        {"CM16.jpg", 16, 1, "--cms 1 --first-id 16"},
        {"CM21.jpg", 21, 1, "--cms 1 --first-id 21"},
        {"TM12_14.jpg", 12, 3, "--cms 3 --first-id 12"},
        {"TM28_32.jpg", 28, 5, "--cms 5 --first-id 28"},
        {"TM42_47.jpg", 42, 6, "--cms 30 --first-id 18 --camera-upright"},
        {"TM54_56.jpg", 54, 3, "--cms 9 --first-id 48 --tm-cms 3 --camera-upright"},
        {"tape_0_5.jpg", 0, 6, "--cms 6"},
        {"tape_0_5.png", 0, 6, "--cms 6"},
    };
    for (const auto &one : pictures) {
        const grid published = sample(paper / "markers" / one.file, side_of(one.count), width_of(one.count));
        const grid made = sample(make(one.arguments, one.first, one.first + one.count - 1), side_of(one.count),
                                 width_of(one.count));
        for (int row = 0; row < height_modules; row++)
            if (published[static_cast<std::size_t>(row)] != made[static_cast<std::size_t>(row)])
                fail_msg("%s, row %d: %s instead of %s", one.file, row, made[static_cast<std::size_t>(row)].c_str(),
                         published[static_cast<std::size_t>(row)].c_str());
    }
}

// ---- The format's test vectors ------------------------------------------------------------------------------

// Cells by id: rows of '0' and '1' with slashes between them.
std::map<int, std::string> read_vectors()
{
    const std::filesystem::path path = paper / ".." / "format" / "vectors.csv";
    std::ifstream file(path);
    std::map<int, std::string> vectors;
    std::string line, id, bits, checksum, cells;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream fields(line);
        if (std::getline(fields, id, ',') && std::getline(fields, bits, ',') && std::getline(fields, checksum, ',') &&
            std::getline(fields, cells, ','))
            vectors[std::stoi(id)] = cells.substr(0, 118);
    }
    if (vectors.size() != 211)
        fail_msg("%s holds %zu vectors instead of 211", path.c_str(), vectors.size());
    return vectors;
}

std::string coding_region(const grid &modules, int left)
{
    std::string cells;
    for (const std::string &row : modules) {
        cells += cells.empty() ? "" : "/";
        for (int i = 0; i < coding_columns; i++)
            cells += row[static_cast<std::size_t>(left + coding_left + i)] == '#' ? '1' : '0';
    }
    return cells;
}

// Compares the ids that there are vectors of, and takes them off the list.
void compare(std::map<int, std::string> &vectors, const grid &modules, int first, int count, int sign)
{
    for (int i = 0; i < count; i++) {
        const int id = sign * (first + i), left = (count >= 3 ? 8 : 0) + cm_pitch * i;
        const auto found = vectors.find(id);
        if (found == vectors.end())
            continue;
        const std::string cells = coding_region(modules, left);
        if (cells != found->second)
            fail_msg("id %d: %s instead of %s", id, cells.c_str(), found->second.c_str());
        vectors.erase(found);
    }
}

// All CMs of a camera-upright plan's first TM are dark, unless one of them has the id 0.
void compare_dark(std::map<int, std::string> &vectors, int first, int count)
{
    const std::string tm = std::to_string(count);
    const std::filesystem::path picture = make("--camera-upright --cms " + tm + " --tm-cms " + tm + " --first-id " +
                                               std::to_string(first), first, first + count - 1);
    compare(vectors, sample(picture, side_of(count), width_of(count)), first, count, -1);
}

// On lines that hold one CM each, all stand alone and are light.
void compare_light(std::map<int, std::string> &vectors, int first, int count)
{
    std::ofstream plan(work / "plan.json");
    plan << R"({"room_m":[1,10],"module_mm":1,"first_id":)" << first << R"(,"lines":[)";
    for (int i = 0; i < count; i++)
        plan << (i > 0 ? "," : "") << R"({"from_m":[0,)" << i * 0.1 << R"(],"to_m":[0.034,)" << i * 0.1 << "]}";
    plan << "]}";
    plan.close();
    const std::string command = program + " " + (work / "plan.json").string() +
                                " --png 254 --no-labels --paper roll --quiet -o " + (work / "light").string();
    std::filesystem::remove_all(work / "light");
    if (std::system(command.c_str()) != 0)
        fail_msg("%s", command.c_str());
    for (int i = 0; i < count; i++) {
        char name[60];
        std::snprintf(name, sizeof name, "tape-%03d-cm%04d.png", i + 1, first + i);
        compare(vectors, sample(work / "light" / name, 1, cm_modules), first + i, 1, 1);
    }
}

void equals_the_test_vectors(void **)
{
    std::map<int, std::string> vectors = read_vectors();
    const struct {
        int first, count;
    } runs[] = {{1, 32}, {33, 32}, {65, 32}, {154, 4}, {231, 3}, {3080, 4}, {3158, 3}, {79157, 3}, {500000, 3},
                {1000000, 3}, {1505580, 3}};
    for (const auto &run : runs) {
        compare_dark(vectors, run.first, run.count);
        compare_light(vectors, run.first, run.count);
    }
    compare_light(vectors, 0, 1);
    for (const auto &left : vectors)
        fail_msg("id %d was not printed", left.first);
}

int enter_work(void **)
{
    std::string name = (std::filesystem::temp_directory_path() / "tapemark-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        return -1;
    work = name;
    return 0;
}

int leave_work(void **)
{
    return std::filesystem::remove_all(work) > 0 ? 0 : -1;
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: test_grids TAPEMARK-MAKE\n");
        return EXIT_FAILURE;
    }
    program = argv[1];
    const char *named = std::getenv("TAPEMARK_PAPER_DATA"), *required = std::getenv("TAPEMARK_REQUIRE_PAPER_DATA");
    paper = named != nullptr ? named : TAPEMARK_PAPER_DATA_DEFAULT;
    if (!std::filesystem::is_directory(paper)) {
        std::printf("there is no %s (set TAPEMARK_PAPER_DATA to the folder of the paper's data)\n", paper.c_str());
        return required != nullptr && std::string(required) == "1" ? EXIT_FAILURE : skipped;
    }
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(equals_the_published_pictures, enter_work, leave_work),
        cmocka_unit_test_setup_teardown(equals_the_test_vectors, enter_work, leave_work),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
