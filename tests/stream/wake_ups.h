/* How late the machine wakes a thread that does nothing but sleep: what no program on it can be quicker than. */
#ifndef WAKE_UPS_H
#define WAKE_UPS_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WAKE_UPS_MAX = 100000 };

typedef struct wake_ups {
    pthread_t thread;
    atomic_bool stop;
    int64_t period_ns;
    int64_t late_ns[WAKE_UPS_MAX];
    size_t count;
} wake_ups;

/* Sleeps again and again, each time for a period. False when there is no thread to be had. */
bool wake_ups_begin(wake_ups *all, int64_t period_ns);

/* Returns within a period. */
void wake_ups_end(wake_ups *all);

#endif
