#include "wake_ups.h"

#include <time.h>

static const int64_t ns_per_s = 1000000000;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * ns_per_s + now.tv_nsec;
}

static void *sleep_and_wake(void *context)
{
    wake_ups *all = context;
    int64_t due_ns = now_ns();
    while (!atomic_load(&all->stop) && all->count < WAKE_UPS_MAX) {
        due_ns += all->period_ns;
        const struct timespec due = {.tv_sec = due_ns / ns_per_s, .tv_nsec = due_ns % ns_per_s};
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        all->late_ns[all->count++] = now_ns() - due_ns;
    }
    return NULL;
}

bool wake_ups_begin(wake_ups *all, int64_t period_ns)
{
    atomic_store(&all->stop, false);
    all->period_ns = period_ns;
    all->count = 0;
    return pthread_create(&all->thread, NULL, sleep_and_wake, all) == 0;
}

void wake_ups_end(wake_ups *all)
{
    atomic_store(&all->stop, true);
    pthread_join(all->thread, NULL);
}
