#include "threads.h"

#include <pthread.h>
#include <stddef.h>

typedef struct worker {
    void (*job)(void *context, int number);
    void *context;
    int first, step, count;
} worker;

static void *work(void *context)
{
    const worker *w = context;
    for (int i = w->first; i < w->count; i += w->step) w->job(w->context, i);
    return NULL;
}

void share_out(void (*job)(void *context, int number), void *context, int count, int threads)
{
    pthread_t started[THREADS];
    worker workers[THREADS];
    int running = 0;
    for (int i = 0; i < threads; i++) {
        workers[i] = (worker){job, context, i, threads, count};
        if (pthread_create(started + running, NULL, work, workers + i) == 0)
            running++;
        else
            (void)work(workers + i);
    }
    for (int i = 0; i < running; i++) (void)pthread_join(started[i], NULL);
}
