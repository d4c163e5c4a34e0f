/* The public header serves C++ too, and needs nothing included before it. */
#include "tapemark.h"

#include <cstring>

int main()
{
    static uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(640, 480)];
    tapemark_image image = {};
    tapemark_result result = {};
    const tapemark_status status = tapemark_decode(&image, nullptr, workspace, sizeof workspace, &result);
    return status != TAPEMARK_BAD_CALL || std::strlen(tapemark_status_text(status)) == 0;
}
