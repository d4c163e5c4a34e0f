/* Writes a map of 100 000 CMs in both formats, reads it and makes the table of it, and fails when one of them takes
 * more than a few seconds of the processor or all of it more than 300 MB. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "map_ids.h"
#include "map_table.h"
#include "planned_map.h"

enum { CM_COUNT = 100000, LIMIT_S = 5, LIMIT_MB = 300 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static bool measure(const char *name, const char *path, bool paper)
{
    tape_map map;
    map_table table;
    error_text error = {""};
    struct stat status;
    if (!make_planned_map(CM_COUNT, &map))
        return false;
    double start_s = seconds();
    bool done = paper ? map_file_write_paper(path, &map, map_ids_bits, &error) : map_file_write(path, &map, &error);
    double written_s = seconds();
    tape_map_release(&map);
    if (!done || stat(path, &status) != 0 || !map_table_load(path, &table, &error)) {
        fprintf(stderr, "map_size: %s\n", error.text);
        return false;
    }
    double read_s = seconds();
    bool whole = table.map.cm_count == CM_COUNT && tapemark_map_check(&table.map, NULL) == TAPEMARK_OK;
    map_table_release(&table);
    unlink(path);
    printf("%s, %d CMs: %.1f MB, written in %.2f s, read in %.2f s\n", name, CM_COUNT, (double)status.st_size / 1e6,
           written_s - start_s, read_s - written_s);
    return whole && written_s - start_s < LIMIT_S && read_s - written_s < LIMIT_S;
}

int main(void)
{
    char path[256];
    const char *folder = getenv("TMPDIR");
    struct rusage usage;
    snprintf(path, sizeof path, "%s/tapemark-map-size-%ld.json", folder != NULL ? folder : "/tmp", (long)getpid());
    bool good = measure("our format", path, false) && measure("the inventors' format", path, true);
    getrusage(RUSAGE_SELF, &usage);
    printf("memory at most: %ld MB\n", usage.ru_maxrss / 1024);
    return good && usage.ru_maxrss / 1024 < LIMIT_MB ? EXIT_SUCCESS : EXIT_FAILURE;
}
