#include "output_directory.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Within the hidden directory: where files in place go that have to give way, until all are moved. */
#define EARLIER "earlier"

/* Behind the hidden directory's name once a signal ended the work on it. */
#define ENDED "-ended"

enum { REMOVAL_ATTEMPTS = 10 };

struct output_directory {
    char *path;       /* without slashes at its end */
    char *temporary;  /* in `path` where that existed, so that both are on one file system; else beside it */
    bool existed;
    sigset_t watched, mask_before;
    pthread_t watcher;
    bool watching;
    pthread_mutex_t moving;  /* held while directories and files come, go or move: a signal has to wait */
};

/* ---- Paths --------------------------------------------------------------------------------------------------- */

static char *join_path(const char *folder, const char *name)
{
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s/%s", folder, name);
    return path;
}

static char *without_last_slashes(const char *path)
{
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/')
        length--;
    return strndup(path, length);
}

static char *parent_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL)
        return strdup(".");
    return slash == path ? strdup("/") : strndup(path, (size_t)(slash - path));
}

/* Moves an entry of one directory into another, under the same name. */
static bool move_entry(const char *from, const char *to, const char *name)
{
    char *source = join_path(from, name), *target = join_path(to, name);
    bool moved = source != NULL && target != NULL && rename(source, target) == 0;
    int reason = errno;
    free(source);
    free(target);
    errno = reason;
    return moved;
}

/* ---- Lists of entries ---------------------------------------------------------------------------------------- */

typedef struct entry_list {
    struct dirent **entries;
    int count;  /* negative when the directory cannot be read */
} entry_list;

static int is_wanted(const struct dirent *entry)
{
    return strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 && strcmp(entry->d_name, EARLIER) != 0;
}

static entry_list list_entries(const char *folder)
{
    entry_list list = {0};
    list.count = scandir(folder, &list.entries, is_wanted, alphasort);
    return list;
}

static void release_entries(entry_list *list)
{
    for (int i = 0; i < list->count; i++)
        free(list->entries[i]);
    if (list->count >= 0)
        free(list->entries);
}

/* Another thread may be adding a last file still. */
static void remove_files(const char *folder)
{
    int attempts = 0;
    do {
        entry_list list = list_entries(folder);
        for (int i = 0; i < list.count; i++) {
            char *path = join_path(folder, list.entries[i]->d_name);
            if (path != NULL)
                unlink(path);
            free(path);
        }
        release_entries(&list);
    } while (rmdir(folder) != 0 && (errno == ENOTEMPTY || errno == EEXIST) && ++attempts < REMOVAL_ATTEMPTS);
}

static void remove_temporary(const char *temporary)
{
    if (temporary == NULL)
        return;
    char *earlier = join_path(temporary, EARLIER);
    if (earlier != NULL)
        remove_files(earlier);
    free(earlier);
    remove_files(temporary);
}

/* The program's other threads go on writing meanwhile: under another name they do not find the directory any more,
 * and cannot add files faster than they are removed. */
static void remove_under_way(const char *temporary)
{
    size_t size = temporary != NULL ? strlen(temporary) + sizeof ENDED : 0;
    char *ended = size > 0 ? malloc(size) : NULL;
    if (ended != NULL)
        snprintf(ended, size, "%s%s", temporary, ENDED);
    remove_temporary(ended != NULL && rename(temporary, ended) == 0 ? ended : temporary);
    free(ended);
}

/* ---- Interruption -------------------------------------------------------------------------------------------- */

/* Waits in a thread of its own, where anything may be called, unlike in a signal handler. */
static void *watch(void *argument)
{
    output_directory *directory = argument;
    int number;
    if (sigwait(&directory->watched, &number) != 0)
        return NULL;
    pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, NULL);
    pthread_mutex_lock(&directory->moving);
    remove_under_way(directory->temporary);
    signal(number, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &directory->watched, NULL);
    raise(number);
    return NULL;
}

/* Signals that the process was started to ignore stay ignored. */
static bool start_watching(output_directory *directory, error_text *error)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    sigemptyset(&directory->watched);
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction action;
        if (sigaction(signals[i], NULL, &action) == 0 && action.sa_handler != SIG_IGN)
            sigaddset(&directory->watched, signals[i]);
    }
    pthread_mutex_init(&directory->moving, NULL);
    pthread_sigmask(SIG_BLOCK, &directory->watched, &directory->mask_before);
    int reason = pthread_create(&directory->watcher, NULL, watch, directory);
    directory->watching = reason == 0;
    if (!directory->watching) {
        pthread_sigmask(SIG_SETMASK, &directory->mask_before, NULL);
        error_text_set(error, "signals cannot be watched: %s", strerror(reason));
    }
    return directory->watching;
}

static void stop_watching(output_directory *directory)
{
    if (!directory->watching)
        return;
    pthread_cancel(directory->watcher);
    pthread_join(directory->watcher, NULL);
    pthread_sigmask(SIG_SETMASK, &directory->mask_before, NULL);
    pthread_mutex_destroy(&directory->moving);
}

/* ---- Opening ------------------------------------------------------------------------------------------------- */

static void release(output_directory *directory)
{
    stop_watching(directory);
    free(directory->path);
    free(directory->temporary);
    free(directory);
}

static bool make_temporary(output_directory *directory)
{
    char *folder = directory->existed ? strdup(directory->path) : parent_of(directory->path);
    char *name = folder != NULL ? join_path(folder, ".unfinished-XXXXXX") : NULL;
    free(folder);
    if (name == NULL)
        return false;
    /* A signal finds it made and known, or neither. */
    pthread_mutex_lock(&directory->moving);
    bool made = mkdtemp(name) != NULL;
    if (made)
        directory->temporary = name;
    pthread_mutex_unlock(&directory->moving);
    if (!made)
        free(name);
    return made;
}

/* What rules out a directory of this name; NULL when nothing does. */
static const char *obstacle(const char *path, bool *existed)
{
    struct stat status;
    *existed = stat(path, &status) == 0;
    if (path[0] == '\0')
        return "has no name";
    if (*existed)
        return S_ISDIR(status.st_mode) ? NULL : "is not a directory";
    return lstat(path, &status) == 0 && S_ISLNK(status.st_mode) ? "is a link to nothing" : NULL;
}

static bool prepare(output_directory *directory, const char *path, error_text *error)
{
    directory->path = without_last_slashes(path);
    const char *problem = directory->path != NULL ? obstacle(directory->path, &directory->existed) : NULL;
    if (problem != NULL) {
        error_text_set(error, "%s", problem);
        return false;
    }
    if (directory->path != NULL && make_temporary(directory))
        return true;
    error_text_set(error, "cannot be %s: %s", directory->existed ? "written to" : "made", strerror(errno));
    return false;
}

output_directory *output_directory_open(const char *path, error_text *error)
{
    output_directory *directory = calloc(1, sizeof *directory);
    if (directory == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    if (start_watching(directory, error) && prepare(directory, path, error))
        return directory;
    output_directory_discard(directory);
    return NULL;
}

const char *output_directory_path(const output_directory *directory)
{
    return directory->temporary;
}

/* ---- Moving -------------------------------------------------------------------------------------------------- */

/* Makes room for a file: what is there under its name goes aside. */
static bool put_aside(const output_directory *directory, const char *earlier, const char *name, error_text *error)
{
    struct stat status;
    char *target = join_path(directory->path, name);
    int answer = target != NULL ? lstat(target, &status) : -1;
    int reason = errno;
    free(target);
    if (answer != 0 && reason == ENOENT)
        return true;
    if (answer == 0 && S_ISDIR(status.st_mode)) {
        error_text_set(error, "%s is a directory, and not to be replaced by a file", name);
        return false;
    }
    if (answer == 0 && move_entry(directory->path, earlier, name))
        return true;
    error_text_set(error, "%s cannot be replaced: %s", name, strerror(answer == 0 ? errno : reason));
    return false;
}

/* Undoes the moves of the first `count` entries, and brings back what gave way. False when that fails, too. */
static bool move_back(const output_directory *directory, const char *earlier, const entry_list *list, int count)
{
    bool done = true;
    for (int i = 0; i < count; i++)
        done = move_entry(directory->path, directory->temporary, list->entries[i]->d_name) && done;
    entry_list aside = list_entries(earlier);
    for (int i = 0; i < aside.count; i++)
        done = move_entry(earlier, directory->path, aside.entries[i]->d_name) && done;
    release_entries(&aside);
    return done && aside.count >= 0;
}

static bool move_all(const output_directory *directory, const char *earlier, const entry_list *list, bool *undone,
                     error_text *error)
{
    for (int i = 0; i < list->count; i++) {
        const char *name = list->entries[i]->d_name;
        bool room = put_aside(directory, earlier, name, error);
        if (room && move_entry(directory->temporary, directory->path, name))
            continue;
        if (room)
            error_text_set(error, "%s cannot be written: %s", name, strerror(errno));
        *undone = move_back(directory, earlier, list, i);
        if (!*undone)
            error_text_set(error, "%s cannot be written, nor earlier files be put back: they are in %.150s", name,
                           earlier);
        return false;
    }
    return true;
}

static bool publish_into(const output_directory *directory, bool *removable, error_text *error)
{
    char *earlier = join_path(directory->temporary, EARLIER);
    entry_list list = list_entries(directory->temporary);
    bool done = false;
    if (earlier == NULL || list.count < 0 || mkdir(earlier, 0700) != 0)
        error_text_set(error, "cannot be written to: %s", strerror(errno));
    else
        done = move_all(directory, earlier, &list, removable, error);
    release_entries(&list);
    free(earlier);
    return done;
}

/* The hidden directory becomes the one that was asked for. */
static bool publish_whole(const output_directory *directory, error_text *error)
{
    mode_t mask = umask(0);
    umask(mask);
    if (chmod(directory->temporary, 0777 & ~mask) == 0 && rename(directory->temporary, directory->path) == 0)
        return true;
    error_text_set(error, "cannot be made: %s", strerror(errno));
    return false;
}

bool output_directory_publish(output_directory *directory, error_text *error)
{
    bool removable = true;
    pthread_mutex_lock(&directory->moving);
    bool done = directory->existed ? publish_into(directory, &removable, error) : publish_whole(directory, error);
    if (removable)
        remove_temporary(directory->temporary);
    pthread_mutex_unlock(&directory->moving);
    release(directory);
    return done;
}

void output_directory_discard(output_directory *directory)
{
    if (directory == NULL)
        return;
    remove_temporary(directory->temporary);
    release(directory);
}

void output_directory_rename_in_error(const output_directory *directory, error_text *error)
{
    error_text before = *error;
    const char *found = strstr(before.text, directory->temporary);
    if (found != NULL)
        error_text_set(error, "%.*s%s%s", (int)(found - before.text), before.text, directory->path,
                       found + strlen(directory->temporary));
}
