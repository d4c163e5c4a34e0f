#include "content_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static void write_all(int descriptor, const uint8_t *bytes, size_t size)
{
    while (size > 0) {
        const ssize_t written = write(descriptor, bytes, size);
        if (written <= 0)
            abort();
        bytes += written;
        size -= (size_t)written;
    }
}

static content_file name_descriptor(int descriptor)
{
    content_file file = {.descriptor = descriptor};
    if (descriptor < 0)
        abort();
    snprintf(file.path, sizeof file.path, "/proc/self/fd/%d", descriptor);
    return file;
}

content_file content_file_open(const uint8_t *bytes, size_t size)
{
    const content_file file = name_descriptor(memfd_create("content", MFD_CLOEXEC));
    write_all(file.descriptor, bytes, size);
    return file;
}

content_file content_pipe_open(const uint8_t *bytes, size_t size)
{
    enum { PIPE_BYTES = 1 << 16 };
    int ends[2];
    if (pipe(ends) != 0)
        abort();
    write_all(ends[1], bytes, size < PIPE_BYTES ? size : PIPE_BYTES);
    close(ends[1]);
    return name_descriptor(ends[0]);
}

void content_file_close(const content_file *file)
{
    close(file->descriptor);
}

/* ---- Named files ---------------------------------------------------------------------------------------------- */

static char own_directory[128];

static void remove_own_directory(void)
{
    static const char *const names[] = {"content", "content.times", "map.json"};
    char path[CONTENT_PATH_BYTES];
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        named_file_path(names[i], path);
        unlink(path);
    }
    rmdir(own_directory);
}

static void make_own_directory(void)
{
    const char *parent = getenv("TMPDIR");
    snprintf(own_directory, sizeof own_directory, "%.100s/tapemark-XXXXXX", parent != NULL ? parent : "/tmp");
    if (mkdtemp(own_directory) == NULL)
        abort();
    atexit(remove_own_directory);
}

void named_file_path(const char *name, char *path)
{
    if (own_directory[0] == '\0')
        make_own_directory();
    snprintf(path, CONTENT_PATH_BYTES, "%s/%s", own_directory, name);
}

void named_file_write(const char *name, const uint8_t *bytes, size_t size)
{
    char path[CONTENT_PATH_BYTES];
    named_file_path(name, path);
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    if (descriptor < 0)
        abort();
    write_all(descriptor, bytes, size);
    close(descriptor);
}
