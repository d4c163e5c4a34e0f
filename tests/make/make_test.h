/* What the tests of this folder share: cmocka, plans put together in memory, and files of their own. */
#ifndef MAKE_TEST_H
#define MAKE_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "layout.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* A plan with lines of these lengths in modules, one below the other. The caller releases it. */
static inline plan plan_of_modules(const double *modules, size_t count)
{
    plan wanted = {.width_m = 2500, .height_m = 2500, .module_mm = 60.0 / 7, .tm_cms = PLAN_TM_CMS,
                   .tm_cms_max = TAPEMARK_TM_MAX_CMS, .line_count = count};
    wanted.lines = calloc(count, sizeof *wanted.lines);
    assert_non_null(wanted.lines);
    for (size_t i = 0; i < count; i++) {
        double y_m = 0.1 * (double)i;
        wanted.lines[i].from = (plan_point){0, y_m};
        wanted.lines[i].to = (plan_point){modules[i] * wanted.module_mm / 1000, y_m};
    }
    return wanted;
}

/* As above, laid out; both are to be released. */
static inline plan lay_modules(const double *modules, size_t count, tape_layout *layout)
{
    plan wanted = plan_of_modules(modules, count);
    error_text error = {""};
    if (!layout_make(&wanted, layout, &error))
        fail_msg("%s", error.text);
    return wanted;
}

/* A file of this process; the next call replaces it. */
static inline const char *temporary_plan(const char *text)
{
    static char path[256];
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/tapemark-test-%ld.json", folder != NULL ? folder : "/tmp", (long)getpid());
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    assert_int_equal(fclose(file), 0);
    return path;
}

#endif
