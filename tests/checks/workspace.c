/* The workspace is as small as the public header says, and the macro and the function agree about it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tapemark.h"

enum { KIB = 1024 };

_Static_assert(TAPEMARK_WORKSPACE_BYTES(640, 480) <= 24 * KIB, "640 x 480 px");
_Static_assert(TAPEMARK_WORKSPACE_BYTES(1920, 1080) <= 64 * KIB, "1920 x 1080 px");
_Static_assert(TAPEMARK_WORKSPACE_BYTES(1080, 1920) <= 64 * KIB, "1080 x 1920 px");

static void sizes_stay_below_their_limits(void **state)
{
    (void)state;
    printf("workspace %zu bytes for 640 x 480 px, %zu for 1920 x 1080\n", tapemark_workspace_bytes(640, 480),
           tapemark_workspace_bytes(1920, 1080));
    assert_in_range(tapemark_workspace_bytes(640, 480), 1, 24 * KIB);
    assert_in_range(tapemark_workspace_bytes(480, 640), 1, 24 * KIB);
    assert_in_range(tapemark_workspace_bytes(1920, 1080), 1, 64 * KIB);
    assert_in_range(tapemark_workspace_bytes(1080, 1920), 1, 64 * KIB);
}

static void macro_and_function_agree(void **state)
{
    (void)state;
    static const int32_t sizes_px[] = {1, 2, 15, 16, 17, 31, 33, 480, 481, 640, 1080, 1920, 4000, 65534, 65535};
    enum { COUNT = sizeof sizes_px / sizeof sizes_px[0] };
    for (int i = 0; i < COUNT; i++)
        for (int j = 0; j < COUNT; j++)
            assert_int_equal(tapemark_workspace_bytes(sizes_px[i], sizes_px[j]),
                             TAPEMARK_WORKSPACE_BYTES(sizes_px[i], sizes_px[j]));
}

static void sizes_out_of_range_have_no_workspace(void **state)
{
    (void)state;
    static const int32_t wrong_px[] = {INT32_MIN, -640, -1, 0, 65536, INT32_MAX};
    for (size_t i = 0; i < sizeof wrong_px / sizeof wrong_px[0]; i++) {
        assert_int_equal(tapemark_workspace_bytes(wrong_px[i], 480), 0);
        assert_int_equal(tapemark_workspace_bytes(640, wrong_px[i]), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sizes_stay_below_their_limits),
        cmocka_unit_test(macro_and_function_agree),
        cmocka_unit_test(sizes_out_of_range_have_no_workspace),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
