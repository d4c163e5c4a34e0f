/* To be loaded before a program: the time of day jumps ahead and back by hours and days, each time that it is asked
 * for, as if somebody set it again and again. The clock that nobody can set goes on as it does. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stddef.h>
#include <sys/time.h>
#include <time.h>

typedef int ask_clock(clockid_t clock, struct timespec *now);

static time_t next_jump_s(void)
{
    static const time_t jumps_s[] = {3600, -3600, 86400, 0, -86400 * 365, 90 * 86400, -1, 1000000000};
    static atomic_uint asked;
    return jumps_s[atomic_fetch_add(&asked, 1) % (sizeof jumps_s / sizeof *jumps_s)];
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static _Atomic(ask_clock *) real;
    ask_clock *ask = atomic_load(&real);
    if (ask == NULL) {
        *(void **)&ask = dlsym(RTLD_NEXT, "clock_gettime");
        atomic_store(&real, ask);
    }
    const int answer = ask(clock, now);
    if (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)
        now->tv_sec += next_jump_s();
    return answer;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    struct timespec precise;
    (void)zone;
    const int answer = clock_gettime(CLOCK_REALTIME, &precise);
    *now = (struct timeval){precise.tv_sec, precise.tv_nsec / 1000};
    return answer;
}

time_t time(time_t *output)
{
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    if (output != NULL)
        *output = precise.tv_sec;
    return precise.tv_sec;
}
