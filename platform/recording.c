/* The frames wait in memory for a thread that writes them, so that no frame ever waits for the disk. */
#include "recording.h"

#include "recording_files.h"
#include "thread.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Memory cards pause for a second now and then: what comes meanwhile has room, up to this. */
enum { WAITING_MIN = 2, WAITING_MAX = 64, WAITING_BYTES = 32 << 20 };

/* At the end: for all that waits, then for the frame that is being written. */
static const int64_t patience_ns = 3 * INT64_C(1000000000), last_patience_ns = 1000000000;

struct recording {
    frame_layout layout;      /* of all frames; a width of 0 before the first */
    size_t frame_bytes;
    bool ended;               /* takes no more frames */
    bool failure_told;
    pthread_t thread;
    recording_files *files;   /* the thread's own */
    atomic_bool given_up;     /* what waits is not written any more */

    pthread_mutex_t mutex;    /* of all below */
    pthread_cond_t changed;
    camera_frame waiting[WAITING_MAX];  /* a ring, each with memory of its own */
    unsigned first;
    unsigned count;           /* the one that is being written included */
    unsigned capacity;
    uint8_t *spare[WAITING_MAX];  /* memory for further ones */
    unsigned spare_count;
    uint64_t left_out;
    bool closing;
    bool failed;
    error_text failure;
    bool finished;            /* the thread needs nothing any more */
    bool abandoned;           /* nobody else does: the thread has to release it */
};

static uint8_t *memory_of(const camera_frame *waiting)
{
    return (uint8_t *)(uintptr_t)waiting->image.data;
}

/* With the mutex held. */
static void forget_first(recording *file)
{
    file->spare[file->spare_count++] = memory_of(&file->waiting[file->first]);
    file->first = (file->first + 1) % file->capacity;
    file->count--;
}

static void release(recording *file)
{
    while (file->count > 0)
        forget_first(file);
    for (unsigned i = 0; i < file->spare_count; i++)
        free(file->spare[i]);
    pthread_cond_destroy(&file->changed);
    pthread_mutex_destroy(&file->mutex);
    free(file);
}

/* ---- The thread ----------------------------------------------------------------------------------------- */

/* With the mutex held. NULL when there is nothing to be written any more. */
static const camera_frame *wait_for_frame(recording *file)
{
    while (file->count == 0 && !file->closing)
        pthread_cond_wait(&file->changed, &file->mutex);
    bool go_on = file->count > 0 && !file->failed && !atomic_load(&file->given_up);
    return go_on ? &file->waiting[file->first] : NULL;
}

static void note_failure(recording *file, const error_text *reason)
{
    if (!file->failed)
        file->failure = *reason;
    file->failed = true;
}

/* Lets go of the mutex while the disk is at work. */
static void write_frames(recording *file)
{
    error_text reason;
    for (const camera_frame *next = wait_for_frame(file); next != NULL; next = wait_for_frame(file)) {
        pthread_mutex_unlock(&file->mutex);
        bool written = recording_files_add(file->files, next, &reason);
        pthread_mutex_lock(&file->mutex);
        if (written)
            forget_first(file);
        else
            note_failure(file, &reason);
    }
    file->left_out += file->count;
}

static void *write_in_background(void *argument)
{
    recording *file = argument;
    error_text reason;
    pthread_mutex_lock(&file->mutex);
    write_frames(file);
    pthread_mutex_unlock(&file->mutex);

    bool closed = recording_files_close(file->files, &reason);

    pthread_mutex_lock(&file->mutex);
    if (!closed)
        note_failure(file, &reason);
    file->finished = true;
    bool abandoned = file->abandoned;
    pthread_cond_signal(&file->changed);
    pthread_mutex_unlock(&file->mutex);
    if (abandoned)
        release(file);
    return NULL;
}

/* ---- From outside --------------------------------------------------------------------------------------- */

recording *recording_open(const char *path, double rate_hz, error_text *error)
{
    error_text ignored;
    recording *file = calloc(1, sizeof *file);
    if (file == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    atomic_init(&file->given_up, false);
    pthread_mutex_init(&file->mutex, NULL);
    thread_condition_init(&file->changed);
    file->files = recording_files_open(path, rate_hz, &file->given_up, error);
    int failure = file->files != NULL ? thread_start(&file->thread, write_in_background, file) : 0;
    if (file->files != NULL && failure == 0)
        return file;
    if (file->files != NULL) {
        error_text_set(error, "cannot be recorded to: %s", strerror(failure));
        recording_files_close(file->files, &ignored);
    }
    release(file);
    return NULL;
}

static bool same_layout(const frame_layout *a, const frame_layout *b)
{
    return a->width_px == b->width_px && a->height_px == b->height_px && a->format == b->format &&
           a->stride_bytes == b->stride_bytes;
}

static unsigned capacity_for(size_t frame_bytes)
{
    size_t frames = WAITING_BYTES / frame_bytes;
    return frames < WAITING_MIN ? WAITING_MIN : frames < WAITING_MAX ? (unsigned)frames : WAITING_MAX;
}

static void set_layout(recording *file, const frame_layout *layout)
{
    file->layout = *layout;
    file->frame_bytes = frame_layout_size_bytes(layout);
    pthread_mutex_lock(&file->mutex);
    file->capacity = capacity_for(file->frame_bytes);
    pthread_mutex_unlock(&file->mutex);
}

/* NULL when there is no room for another frame. */
static uint8_t *find_memory(recording *file)
{
    uint8_t *memory = NULL;
    pthread_mutex_lock(&file->mutex);
    bool room = file->count < file->capacity;
    if (room && file->spare_count > 0)
        memory = file->spare[--file->spare_count];
    pthread_mutex_unlock(&file->mutex);
    return memory != NULL || !room ? memory : malloc(file->frame_bytes);
}

static void keep_waiting(recording *file, const camera_frame *input)
{
    uint8_t *memory = find_memory(file);
    camera_frame kept = *input;
    kept.image.data = memory;
    if (memory != NULL)
        memcpy(memory, input->image.data, file->frame_bytes);
    pthread_mutex_lock(&file->mutex);
    if (memory != NULL)
        file->waiting[(file->first + file->count++) % file->capacity] = kept;
    else
        file->left_out++;
    pthread_cond_signal(&file->changed);
    pthread_mutex_unlock(&file->mutex);
}

static bool has_failed(recording *file, error_text *error)
{
    pthread_mutex_lock(&file->mutex);
    bool failed = file->failed;
    if (failed)
        *error = file->failure;
    pthread_mutex_unlock(&file->mutex);
    return failed;
}

bool recording_add(recording *file, const camera_frame *input, error_text *error)
{
    if (file->ended) {
        error_text_set(error, "the recording has ended");
        return false;
    }
    if (file->layout.width_px == 0)
        set_layout(file, &input->image.layout);
    if (has_failed(file, error)) {
        file->failure_told = true;
        file->ended = true;
    } else if (!same_layout(&file->layout, &input->image.layout)) {
        error_text_set(error, "the recording ends here: the camera's pictures have another size or format now");
        file->ended = true;
    } else {
        keep_waiting(file, input);
    }
    return !file->ended;
}

uint64_t recording_left_out(recording *file)
{
    pthread_mutex_lock(&file->mutex);
    uint64_t left_out = file->left_out;
    pthread_mutex_unlock(&file->mutex);
    return left_out;
}

/* With the mutex held. */
static bool wait_until_finished(recording *file, int64_t time_ns)
{
    int64_t deadline_ns = camera_clock_ns() + time_ns;
    struct timespec deadline = {(time_t)(deadline_ns / 1000000000), (long)(deadline_ns % 1000000000)};
    while (!file->finished && pthread_cond_timedwait(&file->changed, &file->mutex, &deadline) == 0)
        continue;
    return file->finished;
}

/* With the mutex held. */
static bool let_finish(recording *file)
{
    file->closing = true;
    pthread_cond_signal(&file->changed);
    if (wait_until_finished(file, patience_ns))
        return true;
    atomic_store(&file->given_up, true);
    return wait_until_finished(file, last_patience_ns);
}

bool recording_close(recording *file, error_text *error)
{
    if (file == NULL)
        return true;
    pthread_mutex_lock(&file->mutex);
    bool finished = let_finish(file);
    bool whole = false;
    if (!finished)
        error_text_set(error, "the recording is not whole: the disk does not answer");
    else if (file->failed && !file->failure_told)
        *error = file->failure;
    else if (!file->failed && file->left_out > 0)
        error_text_set(error, "the recording lacks %llu frames: the disk was too slow",
                       (unsigned long long)file->left_out);
    else
        whole = true;
    file->abandoned = !finished;
    pthread_mutex_unlock(&file->mutex);
    if (!finished) {
        pthread_detach(file->thread);
        return false;
    }
    pthread_join(file->thread, NULL);
    release(file);
    return whole;
}
