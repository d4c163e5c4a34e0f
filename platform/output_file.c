/* realpath() is one of the X/Open extensions. */
#define _XOPEN_SOURCE 700

#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct output_file {
    FILE *stream;         /* NULL once completed */
    char *path;
    char *temporary_path;  /* NULL when written at once */
    bool failed;
    output_file *next;    /* of those that are not finished */
};

/* ---- Removing on signals ------------------------------------------------------------------------------- */

static output_file *volatile unfinished;

static void remove_unfinished(int signal_number)
{
    for (output_file *file = unfinished; file != NULL; file = file->next) {
        if (file->temporary_path != NULL)
            unlink(file->temporary_path);
    }
    signal(signal_number, SIG_DFL);
    raise(signal_number);
}

static void watch_signals(void)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction action;
        if (sigaction(signals[i], NULL, &action) != 0 || action.sa_handler != SIG_DFL)
            continue;
        action.sa_handler = remove_unfinished;
        sigaction(signals[i], &action, NULL);
    }
}

/* Changes the list while no signal can look at it. */
static void set_unfinished(output_file *file, bool listed)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    if (listed) {
        file->next = unfinished;
        unfinished = file;
    } else {
        output_file *previous = unfinished;
        while (previous != file && previous->next != file)
            previous = previous->next;
        if (previous == file)
            unfinished = file->next;
        else
            previous->next = file->next;
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

/* ---- Opening ------------------------------------------------------------------------------------------- */

static char *copy_with_ending(const char *text, const char *ending)
{
    size_t length = strlen(text), ending_size = strlen(ending) + 1;
    char *copy = malloc(length + ending_size);
    if (copy != NULL) {
        memcpy(copy, text, length);
        memcpy(copy + length, ending, ending_size);
    }
    return copy;
}

static bool open_at_once(output_file *file, const char *path)
{
    bool standard = strcmp(path, "-") == 0;
    int descriptor = standard ? dup(STDOUT_FILENO) : open(path, O_WRONLY | O_CLOEXEC);
    file->stream = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (file->stream == NULL && descriptor >= 0)
        close(descriptor);
    return file->stream != NULL;
}

static bool open_temporary(output_file *file, const char *path)
{
    char ending[32];
    snprintf(ending, sizeof ending, ".part-%ld", (long)getpid());
    /* Renaming over a link would replace the link. */
    char *target = realpath(path, NULL);
    file->path = target != NULL ? target : copy_with_ending(path, "");
    file->temporary_path = file->path != NULL ? copy_with_ending(file->path, ending) : NULL;
    int descriptor =
        file->temporary_path != NULL ? open(file->temporary_path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1;
    if (descriptor < 0) {
        free(file->temporary_path);
        file->temporary_path = NULL;
        return false;
    }
    file->stream = fdopen(descriptor, "wb");
    if (file->stream == NULL)
        close(descriptor);
    return file->stream != NULL;
}

output_file *output_file_open(const char *path, error_text *error)
{
    struct stat status;
    bool standard = strcmp(path, "-") == 0, exists = !standard && stat(path, &status) == 0;
    if (*path == '\0' || (exists && S_ISDIR(status.st_mode))) {
        error_text_set(error, *path == '\0' ? "has an empty name" : "is a directory, not a file");
        return NULL;
    }
    output_file *file = calloc(1, sizeof *file);
    if (file == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    watch_signals();
    set_unfinished(file, true);
    bool at_once = standard || (exists && !S_ISREG(status.st_mode));
    if (at_once ? open_at_once(file, path) : open_temporary(file, path))
        return file;
    error_text_set(error, "cannot be written: %s", strerror(errno));
    output_file_discard(file);
    return NULL;
}

FILE *output_file_stream(output_file *file)
{
    return file->stream;
}

/* ---- Finishing ----------------------------------------------------------------------------------------- */

bool output_file_complete(output_file *file, error_text *error)
{
    if (file->stream == NULL)
        return !file->failed;
    /* What an earlier write failed of, nobody remembers. */
    bool failed_before = ferror(file->stream) != 0, flushed = fflush(file->stream) == 0;
    int reason = errno;
    bool closed = fclose(file->stream) == 0;
    file->stream = NULL;
    file->failed = failed_before || !flushed || !closed;
    if (!flushed || !closed)
        error_text_set(error, "cannot be written: %s", strerror(flushed ? errno : reason));
    else if (failed_before)
        error_text_set(error, "cannot be written wholly: is the disk full?");
    return !file->failed;
}

bool output_file_publish(output_file *file, error_text *error)
{
    bool done = output_file_complete(file, error);
    if (done && file->temporary_path != NULL && rename(file->temporary_path, file->path) != 0) {
        error_text_set(error, "cannot be written: %s", strerror(errno));
        done = false;
    } else if (done) {
        free(file->temporary_path);
        file->temporary_path = NULL;
    }
    output_file_discard(file);
    return done;
}

void output_file_discard(output_file *file)
{
    if (file == NULL)
        return;
    if (file->stream != NULL)
        fclose(file->stream);
    if (file->temporary_path != NULL)
        unlink(file->temporary_path);
    set_unfinished(file, false);
    free(file->temporary_path);
    free(file->path);
    free(file);
}
