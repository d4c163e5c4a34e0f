#define _GNU_SOURCE
#include "camera_thread.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <time.h>
#include <unistd.h>

#include "thread.h"

/* What a camera is busy with usually takes less. */
static const int64_t reach_patience_ns = 20000000;

/* So often a camera that gives no frames is asked how it is. */
enum { LOOK_EVERY_MS = 100 };

typedef enum exchange {
    EXCHANGE_EMPTY,   /* the thread may look for a frame */
    EXCHANGE_FULL,    /* there is something to be taken */
    EXCHANGE_TAKEN    /* a frame is out */
} exchange;

struct camera_thread {
    pthread_t thread;
    char *name;
    camera_wishes wishes;
    char format[16];          /* of the wishes */
    int events;               /* for whoever looks at us */
    int calls;                /* for the thread */

    pthread_mutex_t reach;    /* whoever holds it may call the device */
    camera *device;           /* NULL before it is open */

    pthread_mutex_t mutex;    /* of all below; taken after `reach` */
    pthread_cond_t changed;
    exchange state;
    camera_status status;
    camera_frame got;
    bool open;
    camera_settings settings;
    uint32_t taken_back;      /* frames that were there and were not taken, since the last one that was */
    error_text error;
    bool leaving;
    bool ended;
    bool abandoned;           /* nobody else knows of us any more */
};

static void notify(int descriptor)
{
    const uint64_t one = 1;
    ssize_t ignored = write(descriptor, &one, sizeof one);
    (void)ignored;
}

static void forget_notes(int descriptor)
{
    uint64_t count;
    ssize_t ignored = read(descriptor, &count, sizeof count);
    (void)ignored;
}

static void release_all(camera_thread *self)
{
    if (self->events >= 0)
        close(self->events);
    if (self->calls >= 0)
        close(self->calls);
    pthread_cond_destroy(&self->changed);
    pthread_mutex_destroy(&self->mutex);
    pthread_mutex_destroy(&self->reach);
    free(self->name);
    free(self);
}

/* ---- The thread ---------------------------------------------------------------------------------------------- */

static bool is_leaving(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    bool leaving = self->leaving;
    pthread_mutex_unlock(&self->mutex);
    return leaving;
}

/* Whoever else wants the device has to see that it is not to be had now: opening may take for ever. */
static camera *open_device(const camera_thread *self, error_text *error)
{
    camera *device = camera_open(self->name, error);
    if (device == NULL || camera_configure(device, &self->wishes, error))
        return device;
    camera_close(device);
    return NULL;
}

/* With `reach` held. */
static void note_settings(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    self->open = true;
    self->settings = *camera_settings_of(self->device);
    pthread_mutex_unlock(&self->mutex);
}

/* Puts what there is where it can be taken, and waits until it was. */
static void hand_over(camera_thread *self, camera_status status, const camera_frame *got, const error_text *error)
{
    pthread_mutex_lock(&self->mutex);
    self->state = EXCHANGE_FULL;
    self->status = status;
    self->got = *got;
    self->error = *error;
    notify(self->events);
    while (self->state != EXCHANGE_EMPTY && !self->leaving)
        pthread_cond_wait(&self->changed, &self->mutex);
    pthread_mutex_unlock(&self->mutex);
}

static void wait_for_camera(camera_thread *self)
{
    pthread_mutex_lock(&self->reach);
    int descriptor = camera_descriptor(self->device);
    pthread_mutex_unlock(&self->reach);
    struct pollfd waits[] = {{.fd = descriptor, .events = POLLIN}, {.fd = self->calls, .events = POLLIN}};
    poll(waits, 2, LOOK_EVERY_MS);
    if (waits[1].revents != 0)
        forget_notes(self->calls);
}

/* False when it gives no more. */
static bool take_frame(camera_thread *self)
{
    camera_frame got = {0};
    error_text error = {""};
    pthread_mutex_lock(&self->reach);
    camera_status status = camera_next(self->device, 0, &got, &error);
    note_settings(self); /* a recording shows its rate as it goes on */
    pthread_mutex_unlock(&self->reach);
    if (status == CAMERA_TIMEOUT)
        return true;
    hand_over(self, status, &got, &error);
    if (status != CAMERA_FRAME)
        return false;
    pthread_mutex_lock(&self->reach);
    camera_release(self->device);
    pthread_mutex_unlock(&self->reach);
    return true;
}

static void serve(camera_thread *self)
{
    const camera_frame none = {0};
    error_text error = {""};
    camera *device = open_device(self, &error);
    if (device == NULL) {
        hand_over(self, CAMERA_FAILED, &none, &error);
        return;
    }
    pthread_mutex_lock(&self->reach);
    self->device = device;
    note_settings(self);
    pthread_mutex_unlock(&self->reach);
    do
        wait_for_camera(self);
    while (!is_leaving(self) && take_frame(self));
    pthread_mutex_lock(&self->reach);
    self->device = NULL;
    pthread_mutex_unlock(&self->reach);
    camera_close(device);
}

static void *run(void *context)
{
    camera_thread *self = context;
    serve(self);
    pthread_mutex_lock(&self->mutex);
    self->ended = true;
    bool abandoned = self->abandoned;
    notify(self->events);
    pthread_cond_broadcast(&self->changed);
    pthread_mutex_unlock(&self->mutex);
    if (abandoned)
        release_all(self);
    return NULL;
}

/* ---- Opening ------------------------------------------------------------------------------------------------- */

static void make_locks(camera_thread *self)
{
    thread_condition_init(&self->changed);
    pthread_mutex_init(&self->mutex, NULL);
    pthread_mutex_init(&self->reach, NULL);
}

static void keep_wishes(camera_thread *self, const camera_wishes *wishes)
{
    self->wishes = *wishes;
    self->wishes.format = NULL;
    if (wishes->format != NULL && strlen(wishes->format) < sizeof self->format)
        self->wishes.format = strcpy(self->format, wishes->format);
}

camera_thread *camera_thread_open(const char *name, const camera_wishes *wishes, error_text *error)
{
    camera_thread *self = calloc(1, sizeof *self);
    if (self == NULL) {
        error_text_set(error, "not enough memory");
        return NULL;
    }
    make_locks(self);
    keep_wishes(self, wishes);
    self->name = strdup(name);
    self->events = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    self->calls = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    int failure = self->name == NULL                       ? ENOMEM
                  : self->events < 0 || self->calls < 0 ? errno
                                                        : thread_start(&self->thread, run, self);
    if (failure == 0)
        return self;
    error_text_set(error, "cannot be watched: %s", strerror(failure));
    release_all(self);
    return NULL;
}

/* ---- Frames -------------------------------------------------------------------------------------------------- */

int camera_thread_descriptor(const camera_thread *self)
{
    return self->events;
}

camera_status camera_thread_next(camera_thread *self, camera_frame *output, error_text *error)
{
    camera_status status = CAMERA_TIMEOUT;
    pthread_mutex_lock(&self->mutex);
    forget_notes(self->events);
    if (self->state == EXCHANGE_FULL) {
        self->state = EXCHANGE_TAKEN;
        status = self->status;
        *output = self->got;
        *error = self->error;
        output->dropped += self->taken_back;
        self->taken_back = 0;
    }
    pthread_mutex_unlock(&self->mutex);
    return status;
}

/* With the mutex held. */
static void empty(camera_thread *self)
{
    self->state = EXCHANGE_EMPTY;
    pthread_cond_broadcast(&self->changed);
}

void camera_thread_release(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    if (self->state == EXCHANGE_TAKEN)
        empty(self);
    pthread_mutex_unlock(&self->mutex);
}

/* ---- Reaching the device from outside ------------------------------------------------------------------------ */

/* Of the clock that nobody sets. */
static struct timespec time_from_now(int64_t patience_ns)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    int64_t then_ns = (int64_t)now.tv_sec * 1000000000 + now.tv_nsec + patience_ns;
    return (struct timespec){(time_t)(then_ns / 1000000000), (long)(then_ns % 1000000000)};
}

/* On success, let_go() has to follow. */
static bool reach(camera_thread *self, error_text *error)
{
    struct timespec deadline = time_from_now(reach_patience_ns);
    if (pthread_mutex_clocklock(&self->reach, CLOCK_MONOTONIC, &deadline) != 0) {
        error_text_set(error, "does not answer");
        return false;
    }
    if (self->device != NULL)
        return true;
    pthread_mutex_unlock(&self->reach);
    error_text_set(error, "is not open");
    return false;
}

static void let_go(camera_thread *self)
{
    note_settings(self);
    pthread_mutex_unlock(&self->reach);
    notify(self->calls);
}

bool camera_thread_settings(camera_thread *self, camera_settings *settings)
{
    pthread_mutex_lock(&self->mutex);
    bool open = self->open;
    *settings = self->settings;
    pthread_mutex_unlock(&self->mutex);
    return open;
}

bool camera_thread_set_light(camera_thread *self, int32_t exposure_us, double gain, error_text *error)
{
    if (!reach(self, error))
        return false;
    bool done = camera_set_light(self->device, exposure_us, gain, error);
    let_go(self);
    return done;
}

/* It takes back the frame that is out, or about to be. */
static void take_back(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    if (self->state == EXCHANGE_FULL && self->status == CAMERA_FRAME) {
        self->taken_back += self->got.dropped + 1;
        empty(self);
    }
    pthread_mutex_unlock(&self->mutex);
}

bool camera_thread_configure(camera_thread *self, const camera_wishes *wishes, error_text *error)
{
    if (!reach(self, error))
        return false;
    take_back(self);
    bool done = camera_configure(self->device, wishes, error);
    let_go(self);
    return done;
}

/* ---- Ending -------------------------------------------------------------------------------------------------- */

void camera_thread_leave(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    self->leaving = true;
    pthread_cond_broadcast(&self->changed);
    pthread_mutex_unlock(&self->mutex);
    notify(self->calls);
}

bool camera_thread_has_ended(camera_thread *self)
{
    pthread_mutex_lock(&self->mutex);
    bool ended = self->ended;
    forget_notes(self->events);
    pthread_mutex_unlock(&self->mutex);
    return ended;
}

/* With the mutex held. */
static bool wait_until_ended(camera_thread *self, int64_t patience_ns)
{
    struct timespec deadline = time_from_now(patience_ns);
    while (!self->ended && pthread_cond_timedwait(&self->changed, &self->mutex, &deadline) == 0)
        continue;
    return self->ended;
}

bool camera_thread_close(camera_thread *self, int64_t patience_ns)
{
    if (self == NULL)
        return true;
    camera_thread_leave(self);
    pthread_mutex_lock(&self->mutex);
    bool ended = wait_until_ended(self, patience_ns);
    self->abandoned = !ended;
    pthread_t thread = self->thread;
    pthread_mutex_unlock(&self->mutex);
    if (!ended) {
        pthread_detach(thread);
        return false;
    }
    pthread_join(thread, NULL);
    release_all(self);
    return true;
}
