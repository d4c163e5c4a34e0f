/* Calls a target with the content of files, and of those in directories: seeds, and what was found once. */
#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <sys/stat.h>

#include "fuzz_target.h"

enum { PATH_BYTES = 4096 };

static unsigned long file_count;

static void fail(const char *path)
{
    fprintf(stderr, "%s: %s\n", path, strerror(errno));
    exit(1);
}

static void replay_file(const char *path, size_t size)
{
    FILE *file = fopen(path, "rb");
    uint8_t *bytes = exact_memory(size);
    if (file == NULL || fread(bytes, 1, size, file) != size)
        fail(path);
    fclose(file);
    fprintf(stderr, "%s\n", path);
    LLVMFuzzerTestOneInput(bytes, size);
    free(bytes);
    file_count++;
}

static void replay(const char *path);

static void replay_directory(const char *path)
{
    DIR *directory = opendir(path);
    if (directory == NULL)
        fail(path);
    for (const struct dirent *entry = readdir(directory); entry != NULL; entry = readdir(directory)) {
        char inside[PATH_BYTES];
        if (entry->d_name[0] == '.')
            continue;
        snprintf(inside, sizeof inside, "%s/%s", path, entry->d_name);
        replay(inside);
    }
    closedir(directory);
}

static void replay(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0)
        fail(path);
    if (S_ISDIR(about.st_mode))
        replay_directory(path);
    else
        replay_file(path, (size_t)about.st_size);
}

int main(int argc, char *argv[])
{
    for (int i = 1; i < argc; i++)
        replay(argv[i]);
    printf("%lu inputs\n", file_count);
    return file_count > 0 ? 0 : 1;
}
