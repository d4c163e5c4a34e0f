/* A plan of a kilometre of tape becomes print and map within 5 s and 300 MB. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "own_folder.h"

enum { SECONDS_MAX = 5, MEGABYTES_MAX = 300, LINES = 10 };

static const char *program;

/* Corridors of 100 m, one beside the other. */
static void write_plan(void)
{
    FILE *file = fopen("plan.json", "w");
    assert_non_null(file);
    fputs("{\"room_m\":[100,40],\"tape_height_mm\":60,\"lines\":[", file);
    for (int i = 0; i < LINES; i++)
        fprintf(file, "%s{\"from_m\":[0,%d],\"to_m\":[100,%d]}", i > 0 ? "," : "", 4 * i, 4 * i);
    fputs("]}", file);
    assert_int_equal(fclose(file), 0);
}

static double processor_seconds(const struct rusage *usage)
{
    return (double)(usage->ru_utime.tv_sec + usage->ru_stime.tv_sec) +
           (double)(usage->ru_utime.tv_usec + usage->ru_stime.tv_usec) * 1e-6;
}

/* Processor time, which others on the machine do not change as they do the time on the clock. */
static void a_kilometre_of_tape(void **state)
{
    int status;
    struct rusage usage;
    (void)state;
    write_plan();
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        execl(program, program, "plan.json", "-o", "made", "--quiet", (char *)NULL);
        _exit(127);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_int_equal(getrusage(RUSAGE_CHILDREN, &usage), 0);
    printf("%.2f s, %ld MB\n", processor_seconds(&usage), usage.ru_maxrss / 1024);
    assert_true(processor_seconds(&usage) < SECONDS_MAX);
    assert_true(usage.ru_maxrss / 1024 < MEGABYTES_MAX);
    assert_int_equal(access("made/tape.pdf", R_OK), 0);
    assert_int_equal(access("made/map.json", R_OK), 0);
}

int main(int argc, char *argv[])
{
    if (argc != 2) {
        fprintf(stderr, "usage: test_kilometre TAPEMARK-MAKE\n");
        return EXIT_FAILURE;
    }
    program = argv[1];
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_kilometre_of_tape, enter_own_folder, leave_own_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
