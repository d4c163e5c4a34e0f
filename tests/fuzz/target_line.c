/* Records and noise on a line that is damaged as the bytes say: what came undamaged is received. (That something is
 * received which nobody sent happens by chance, and libFuzzer is no chance: tests/link counts it.) */
#include "damaged_line.h"
#include "fuzz_target.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    line_tally tally = {.lost = 0};
    run_damaged_line(bytes, size, &tally);
    CLAIM(tally.lost == 0);
    CLAIM(tally.damaged[0] + tally.damaged[1] <= tally.sent[0] + tally.sent[1]);
    return 0;
}
