#include <stdio.h>
#include <string.h>
#include <tapemark.h>

/* Usage: consumer EXPECTED_VERSION */
int main(int argc, char **argv)
{
    uint16_t rows[TAPEMARK_CELL_ROWS];
    printf("linked with tapemark %s\n", tapemark_version());
    return argc != 2 || strcmp(tapemark_version(), argv[1]) != 0 || tapemark_cm_grid(1, rows) != TAPEMARK_OK;
}
