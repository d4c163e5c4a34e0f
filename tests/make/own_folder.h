/* A folder of its own for a test, as cmocka's setup and teardown: it is entered, and removed at the end. */
#ifndef OWN_FOLDER_H
#define OWN_FOLDER_H

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char own_folder[200];

static inline int enter_own_folder(void **state)
{
    const char *parent = getenv("TMPDIR");
    (void)state;
    snprintf(own_folder, sizeof own_folder, "%s/tapemark-test-XXXXXX", parent != NULL ? parent : "/tmp");
    return mkdtemp(own_folder) != NULL && chdir(own_folder) == 0 ? 0 : -1;
}

static inline int leave_own_folder(void **state)
{
    char command[300];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", own_folder);
    return chdir("/") == 0 && system(command) == 0 ? 0 : -1;
}

#endif
