#include "strobe.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "thread.h"

/* Flashes of one plan; when no frames come any more, it is dark soon. */
enum { FLASHES_MAX = 4 };

struct strobe {
    gpio_output *line;
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    strobe_times next;
    unsigned planned;  /* flashes */
    bool ending;
    bool failed;
    error_text failure;
};

/* Until then or until something has changed; with the mutex held. */
static void wait_until(strobe *self, int64_t time_ns)
{
    struct timespec when = {(time_t)(time_ns / 1000000000), (long)(time_ns % 1000000000)};
    pthread_cond_timedwait(&self->changed, &self->mutex, &when);
}

static int64_t clock_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* Lines behind USB or I2C may take their time, and nobody shall wait for them with the mutex. */
static void set_line(strobe *self, bool on)
{
    error_text reason;
    pthread_mutex_unlock(&self->mutex);
    bool done = gpio_output_set(self->line, on, &reason);
    pthread_mutex_lock(&self->mutex);
    if (!done) {
        self->failed = true;
        self->failure = reason;
    }
}

/* What is to be done, when the next flash is over or it is too late for it. */
static void plan_next(strobe *self)
{
    self->planned--;
    self->next.on_ns += self->next.period_ns;
    self->next.off_ns += self->next.period_ns;
}

static void flash(strobe *self)
{
    int64_t off_ns = self->next.off_ns;
    plan_next(self);
    set_line(self, true);
    while (!self->ending && clock_ns() < off_ns)
        wait_until(self, off_ns);
    set_line(self, false);
}

static void *run(void *context)
{
    strobe *self = context;
    pthread_mutex_lock(&self->mutex);
    while (!self->ending) {
        if (self->planned == 0)
            pthread_cond_wait(&self->changed, &self->mutex);
        else if (clock_ns() >= self->next.off_ns)
            plan_next(self);
        else if (clock_ns() < self->next.on_ns)
            wait_until(self, self->next.on_ns);
        else
            flash(self);
    }
    pthread_mutex_unlock(&self->mutex);
    return NULL;
}

strobe *strobe_open(gpio_output *line, error_text *error)
{
    strobe *self = calloc(1, sizeof *self);
    if (self == NULL) {
        error_text_set(error, "not enough memory");
        gpio_output_close(line);
        return NULL;
    }
    self->line = line;
    pthread_mutex_init(&self->mutex, NULL);
    thread_condition_init(&self->changed);
    int failure = thread_start(&self->thread, run, self);
    if (failure == 0)
        return self;
    error_text_set(error, "cannot start a thread for the strobe: %s", strerror(failure));
    gpio_output_close(line);
    free(self);
    return NULL;
}

void strobe_plan(strobe *self, const strobe_times *times)
{
    pthread_mutex_lock(&self->mutex);
    strobe_times next = *times;
    if (self->planned > 0 && next.on_ns - self->next.on_ns > next.period_ns / 2) {
        next.on_ns -= next.period_ns;
        next.off_ns -= next.period_ns;
    }
    self->next = next;
    self->planned = FLASHES_MAX;
    pthread_cond_signal(&self->changed);
    pthread_mutex_unlock(&self->mutex);
}

bool strobe_news(strobe *self, error_text *message)
{
    pthread_mutex_lock(&self->mutex);
    bool news = self->failed;
    if (news)
        *message = self->failure;
    self->failed = false;
    pthread_mutex_unlock(&self->mutex);
    return news;
}

void strobe_close(strobe *self)
{
    if (self == NULL)
        return;
    pthread_mutex_lock(&self->mutex);
    self->ending = true;
    pthread_cond_signal(&self->changed);
    pthread_mutex_unlock(&self->mutex);
    pthread_join(self->thread, NULL);
    pthread_cond_destroy(&self->changed);
    pthread_mutex_destroy(&self->mutex);
    gpio_output_close(self->line);
    free(self);
}
