// tapemark-bench: this decoder against its peers, on the same frames, in one run and one thread.
#include "measure.hpp"
#include "options.hpp"
#include "report.hpp"

#include <cstdio>
#include <exception>

namespace {

enum exit_code { exit_ok = 0, exit_failed = 1, exit_usage = 2 };

int run_bench(const options &chosen)
{
    const measurement all = measure(chosen);
    print_report(all, chosen);
    if (!chosen.json_path.empty())
        write_json(all, chosen, chosen.json_path);
    return chosen.check && !check_limits(all) ? exit_failed : exit_ok;
}

}  // namespace

int main(int argc, char **argv)
{
    try {
        const options chosen = parse_options(argc, argv);
        if (chosen.help) {
            std::fputs(usage_text, stdout);
            return exit_ok;
        }
        return run_bench(chosen);
    } catch (const usage_error &error) {
        std::fprintf(stderr, "tapemark-bench: %s\n", error.what());
        return exit_usage;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "tapemark-bench: %s\n", error.what());
        return exit_failed;
    }
}
