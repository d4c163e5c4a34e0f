#include "input_list.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

static const char *last_component(const char *path)
{
    if (strcmp(path, "-") == 0)
        return "stdin";
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

/* Takes over the path. */
static bool add_owned(input_list *list, char *path, bool raw, error_text *error)
{
    if (path != NULL && list->count == list->capacity) {
        size_t capacity = list->capacity == 0 ? 16 : 2 * list->capacity;
        input_file *files = realloc(list->files, capacity * sizeof *files);
        if (files != NULL) {
            list->files = files;
            list->capacity = capacity;
        }
    }
    if (path == NULL || list->count == list->capacity) {
        free(path);
        error_text_set(error, "not enough memory for the list of inputs");
        return false;
    }
    list->files[list->count++] = (input_file){path, path, false, raw};
    return true;
}

bool input_list_add(input_list *list, const char *path, bool raw, error_text *error)
{
    return add_owned(list, strdup(path), raw, error);
}

static bool ends_in(const char *name, const char *const *endings, size_t count)
{
    const char *dot = strrchr(name, '.');
    for (size_t i = 0; dot != NULL && i < count; i++)
        if (strcasecmp(dot + 1, endings[i]) == 0)
            return true;
    return false;
}

static bool is_picture_or_video(const char *name)
{
    static const char *const endings[] = {
        "pgm", "y4m", "png", "jpg", "jpeg", "jpe", "bmp", "dib", "tif", "tiff", "webp", "jp2", "pbm", "ppm", "pnm",
        "pam", "mp4", "m4v", "mov", "mkv", "webm", "avi", "mpg", "mpeg", "ts", "mts", "m2ts", "wmv", "flv", "ogv",
        "gif", "mjpg", "mjpeg", "h264", "264", "h265", "265",
    };
    return ends_in(name, endings, sizeof endings / sizeof *endings);
}

static bool is_headerless(const char *name, const char *raw_format)
{
    const char *const endings[] = {"raw", "bin", "yuv", raw_format};
    return raw_format != NULL && ends_in(name, endings, sizeof endings / sizeof *endings);
}

static char *join_path(const char *directory, const char *name)
{
    size_t length = strlen(directory);
    const char *slash = length > 0 && directory[length - 1] == '/' ? "" : "/";
    size_t size = length + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s%s%s", directory, slash, name);
    return path;
}

static int compare_paths(const void *left, const void *right)
{
    return strcmp(((const input_file *)left)->path, ((const input_file *)right)->path);
}

static bool add_entries(input_list *list, DIR *directory, const char *path, const char *raw_format,
                        size_t *skipped_count, error_text *error)
{
    const struct dirent *entry;
    for (errno = 0; (entry = readdir(directory)) != NULL; errno = 0) {
        if (entry->d_name[0] == '.')
            continue;
        char *file = join_path(path, entry->d_name);
        bool raw = is_headerless(entry->d_name, raw_format);
        if (file != NULL && input_is_directory(file)) {
            free(file);
        } else if (file != NULL && !raw && !is_picture_or_video(entry->d_name)) {
            ++*skipped_count;
            free(file);
        } else if (!add_owned(list, file, raw, error)) {
            return false;
        }
    }
    if (errno != 0)
        error_text_set(error, "cannot be listed: %s", strerror(errno));
    return errno == 0;
}

bool input_list_add_directory(input_list *list, const char *path, const char *raw_format, size_t *skipped_count,
                              error_text *error)
{
    size_t first = list->count;
    *skipped_count = 0;
    DIR *directory = opendir(path);
    if (directory == NULL) {
        error_text_set(error, "cannot be listed: %s", strerror(errno));
        return false;
    }
    bool done = add_entries(list, directory, path, raw_format, skipped_count, error);
    closedir(directory);
    if (!done)
        return false;
    if (list->count == first) {
        error_text_set(error, "this directory holds no pictures or videos");
        return false;
    }
    qsort(list->files + first, list->count - first, sizeof *list->files, compare_paths);
    return true;
}

bool input_is_directory(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static int compare_last_components(const void *left, const void *right)
{
    const input_file *const *a = left;
    const input_file *const *b = right;
    return strcmp(last_component((*a)->path), last_component((*b)->path));
}

void input_list_set_names(input_list *list)
{
    input_file **sorted = malloc(list->count * sizeof *sorted);
    for (size_t i = 0; i < list->count; i++) {
        list->files[i].name = last_component(list->files[i].path);
        list->files[i].name_shared = false;
        if (sorted != NULL)
            sorted[i] = &list->files[i];
    }
    if (sorted == NULL)
        return;
    qsort(sorted, list->count, sizeof *sorted, compare_last_components);
    for (size_t i = 1; i < list->count; i++)
        if (compare_last_components(&sorted[i - 1], &sorted[i]) == 0)
            sorted[i - 1]->name_shared = sorted[i]->name_shared = true;
    for (size_t i = 0; i < list->count; i++)
        if (list->files[i].name_shared && strcmp(list->files[i].path, "-") != 0)
            list->files[i].name = list->files[i].path;
    free(sorted);
}

void input_list_release(input_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        free(list->files[i].path);
    free(list->files);
    *list = (input_list){0};
}
