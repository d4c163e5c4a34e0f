#include "process.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

bool process_prepare(void)
{
    bool output_open = fcntl(STDOUT_FILENO, F_GETFD) >= 0;
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; descriptor++)
        if (fcntl(descriptor, F_GETFD) < 0 && open("/dev/null", O_RDWR) != descriptor)
            return false;
    return output_open;
}
