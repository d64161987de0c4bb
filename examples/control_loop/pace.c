#define _POSIX_C_SOURCE 200809L
#include "pace.h"

#include <errno.h>
#include <stdio.h>
#include <time.h>

#define CYCLE_NS 1000000

static const int64_t bounds[PACE_BINS - 1] = {50000, 100000, 200000, 400000, 700000, 1000000};

static int64_t now(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

#if defined(__APPLE__) /* has no clock_nanosleep: a signal ends the wait early */
static void wait_until(int64_t time)
{
    const int64_t left = time - now();
    const struct timespec t = {(time_t)(left / 1000000000), (long)(left % 1000000000)};
    if (left > 0) (void)nanosleep(&t, NULL);
}
#else
static void wait_until(int64_t time)
{
    const struct timespec t = {(time_t)(time / 1000000000), (long)(time % 1000000000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR) continue;
}
#endif

void pace_begin(pace *p)
{
    if (p->next == 0) p->next = now();
    if (p->waits) {
        if (now() > p->next + CYCLE_NS / 10) p->late++;
        wait_until(p->next);
    }
    p->next += CYCLE_NS;
    p->start = now();
}

void pace_end(pace *p)
{
    const int64_t took = now() - p->start;
    int bin = 0;
    while (bin < PACE_BINS - 1 && took >= bounds[bin]) bin++;
    p->bins[bin]++;
    if (took > p->worst) p->worst = took;
}

void pace_print(const pace *p)
{
    printf("time of a cycle (measure, decide, command, step):\n");
    for (int i = 0; i < PACE_BINS; i++)
        printf("  %s %4d us: %7llu\n", i < PACE_BINS - 1 ? "below" : "above",
               (int)(bounds[i < PACE_BINS - 1 ? i : PACE_BINS - 2] / 1000), (unsigned long long)p->bins[i]);
    printf("  worst %.0f us, %llu cycles began late\n", 1e-3 * (double)p->worst, (unsigned long long)p->late);
}
