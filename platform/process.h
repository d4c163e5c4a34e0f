/* What each program does before anything else. */
#ifndef PLATFORM_PROCESS_H
#define PLATFORM_PROCESS_H

#include <stdbool.h>

/* Lets writes fail where they would end the process: to a reader that has gone away, or beyond the largest size that
 * files may have. Standard streams that are closed lead to /dev/null from now on, lest a file opened later end up in
 * their place. False when standard output is closed, or there is no /dev/null. */
bool process_prepare(void);

#endif
