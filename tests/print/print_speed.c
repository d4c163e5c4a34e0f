/* A kilometre of tape, 4700 CMs, on A4 and on a roll: time, memory and size of the PDF. */
#include "printing.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>

enum { TMS = 783, CMS = 6, MOST_MEMORY_MIB = 300, MOST_FILE_MIB = 10 };
static const double most_s = 5;

static hand_tape kilometre(void)
{
    static int32_t ids[CMS * TMS];
    static hand_segment segments[TMS];
    for (int32_t i = 0; i < CMS * TMS; i++)
        ids[i] = i % 5 < 3 ? -i : i;
    for (size_t i = 0; i < TMS; i++)
        segments[i] = (hand_segment){0, CMS, true};
    return hand_tape_new(60.0 / 7, ids, segments, TMS);
}

/* Of this process: on a busy machine a clock on the wall would tell of others. */
static double now_s(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static void print_a_kilometre(print_paper paper)
{
    error_text error = {""};
    print_summary summary;
    struct stat status;
    struct rusage usage;
    const char *folder = new_folder(), *path = path_in(folder, "tape.pdf");
    hand_tape tape = kilometre();
    double start_s = now_s();
    if (!print_pdf(&tape.wanted, &tape.layout, &(print_settings){.paper = paper}, path, &summary, &error))
        fail_msg("%s", error.text);
    double took_s = now_s() - start_s;
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    double file_mib = (double)status.st_size / (1 << 20), memory_mib = (double)usage.ru_maxrss / 1024;
    printf("%zu pages in %.2f s, %.0f MiB of memory, %.1f MiB of file\n", summary.pages, took_s, memory_mib,
           file_mib);
    assert_true(took_s < most_s);
    assert_true(memory_mib < MOST_MEMORY_MIB);
    assert_true(file_mib < MOST_FILE_MIB);
    remove_folder(folder);
    hand_tape_release(&tape);
}

static void a_kilometre_of_sheets(void **state)
{
    (void)state;
    print_a_kilometre(PRINT_A4);
}

static void a_kilometre_of_roll(void **state)
{
    (void)state;
    print_a_kilometre(PRINT_ROLL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_kilometre_of_sheets),
        cmocka_unit_test(a_kilometre_of_roll),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
