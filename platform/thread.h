/* Threads that work beside the one with the program's loop. */
#ifndef PLATFORM_THREAD_H
#define PLATFORM_THREAD_H

#include <pthread.h>

/* As pthread_create(), which gives the answer. Signals are for others: the new thread takes none. */
int thread_start(pthread_t *thread, void *(*run)(void *context), void *context);

/* For waits until a time of CLOCK_MONOTONIC, which nobody sets. */
void thread_condition_init(pthread_cond_t *condition);

#endif
