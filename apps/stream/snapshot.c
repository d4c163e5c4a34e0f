#include "snapshot.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "messages.h"
#include "output_file.h"
#include "settings.h"
#include "thread.h"

struct snapshots {
    pthread_mutex_t mutex;  /* of all below */
    pthread_cond_t changed;
    bool busy;
    bool abandoned;         /* nobody else knows of us any more */
    unsigned failures;
    gray_view picture;      /* the thread's, while it is busy; likewise below */
    uint8_t *pixels;
    size_t pixels_size;
    char path[SETTING_TEXT_BYTES + 64];
};

snapshots *snapshots_open(void)
{
    snapshots *self = calloc(1, sizeof *self);
    if (self == NULL)
        return NULL;
    thread_condition_init(&self->changed);
    pthread_mutex_init(&self->mutex, NULL);
    return self;
}

static void release(snapshots *self)
{
    pthread_cond_destroy(&self->changed);
    pthread_mutex_destroy(&self->mutex);
    free(self->pixels);
    free(self);
}

/* ---- The thread ---------------------------------------------------------------------------------------------- */

static bool write_picture(const char *path, const gray_view *picture, error_text *error)
{
    output_file *file = output_file_open(path, error);
    if (file == NULL)
        return false;
    FILE *stream = output_file_stream(file);
    fprintf(stream, "P5\n%d %d\n255\n", picture->width_px, picture->height_px);
    fwrite(picture->pixels, 1, (size_t)picture->width_px * (size_t)picture->height_px, stream);
    return output_file_publish(file, error);
}

static void *run(void *context)
{
    snapshots *self = context;
    error_text reason;
    bool written = write_picture(self->path, &self->picture, &reason);
    if (!written)
        message_tell(self->path, reason.text);
    pthread_mutex_lock(&self->mutex);
    self->failures += !written;
    self->busy = false;
    bool abandoned = self->abandoned;
    pthread_cond_signal(&self->changed);
    pthread_mutex_unlock(&self->mutex);
    if (abandoned)
        release(self);
    return NULL;
}

static int start(snapshots *self)
{
    pthread_t thread;
    int failure = thread_start(&thread, run, self);
    if (failure == 0)
        pthread_detach(thread);
    return failure;
}

/* ---- From outside -------------------------------------------------------------------------------------------- */

static bool keep_copy(snapshots *self, const gray_view *view)
{
    size_t width = (size_t)view->width_px, size = width * (size_t)view->height_px;
    if (size > self->pixels_size) {
        free(self->pixels);
        self->pixels = malloc(size);
        self->pixels_size = self->pixels != NULL ? size : 0;
    }
    if (self->pixels == NULL)
        return false;
    for (int32_t y = 0; y < view->height_px; y++)
        memcpy(self->pixels + (size_t)y * width, view->pixels + y * view->stride_bytes, width);
    self->picture = (gray_view){self->pixels, view->width_px, view->height_px, view->width_px};
    return true;
}

static bool begin(snapshots *self, const char *directory, const gray_view *view, error_text *error)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    snprintf(self->path, sizeof self->path, "%s/frame-%lld.%03ld.pgm", directory, (long long)now.tv_sec,
             now.tv_nsec / 1000000);
    int failure = keep_copy(self, view) ? start(self) : ENOMEM;
    self->busy = failure == 0;
    if (failure != 0)
        error_text_set(error, "the frame cannot be saved: %s", strerror(failure));
    return failure == 0;
}

void snapshots_save(snapshots *self, const char *directory, const gray_view *view)
{
    error_text reason;
    pthread_mutex_lock(&self->mutex);
    bool begun = !self->busy && begin(self, directory, view, &reason);
    if (self->busy && !begun)
        error_text_set(&reason, "the frame is not saved: the one before is still being written");
    self->failures += !begun;
    pthread_mutex_unlock(&self->mutex);
    if (!begun)
        message_tell(directory, reason.text);
}

unsigned snapshots_failures(snapshots *self)
{
    pthread_mutex_lock(&self->mutex);
    unsigned failures = self->failures;
    pthread_mutex_unlock(&self->mutex);
    return failures;
}

void snapshots_close(snapshots *self)
{
    if (self == NULL)
        return;
    struct timespec deadline;
    clock_gettime(CLOCK_MONOTONIC, &deadline);
    deadline.tv_sec++;
    pthread_mutex_lock(&self->mutex);
    while (self->busy && pthread_cond_timedwait(&self->changed, &self->mutex, &deadline) == 0)
        continue;
    bool abandoned = self->busy;
    self->abandoned = abandoned;
    pthread_mutex_unlock(&self->mutex);
    if (!abandoned)
        release(self);
}
