#include <pthread.h>

#include "study.h"

enum { MOST_THREADS = 64 }; /* as options.c allows */

typedef struct queue {
    const study_job *jobs;
    int count, next;
    pthread_mutex_t lock;
} queue;

/* -1: none is left. */
static int take(queue *q)
{
    (void)pthread_mutex_lock(&q->lock);
    const int number = q->next < q->count ? q->next++ : -1;
    (void)pthread_mutex_unlock(&q->lock);
    return number;
}

static void *work(void *context)
{
    queue *q = context;
    for (int number = take(q); number >= 0; number = take(q)) q->jobs[number].work(q->jobs[number].context);
    return NULL;
}

void study_share_out(const study_job *jobs, int count, int threads)
{
    pthread_t started[MOST_THREADS];
    queue q = {jobs, count, 0, PTHREAD_MUTEX_INITIALIZER};
    int running = 0;
    for (int i = 1; i < threads && i <= MOST_THREADS; ++i)
        if (pthread_create(started + running, NULL, work, &q) == 0) running++;
    (void)work(&q);
    for (int i = 0; i < running; ++i) (void)pthread_join(started[i], NULL);
}
