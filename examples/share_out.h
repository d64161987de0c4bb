/* Jobs for some threads, for the examples: each thread takes the next one when it has done its own, so that long jobs
 * and a slow processor keep no other one waiting. */
#ifndef SHARE_OUT_H
#define SHARE_OUT_H

#include <pthread.h>
#include <stdatomic.h>

enum { THREADS = 64 };

typedef struct shared_jobs {
    void (*job)(void *context, int number);
    void *context;
    int count;
    atomic_int next;
} shared_jobs;

static inline void *do_jobs(void *context)
{
    shared_jobs *s = context;
    for (int i = atomic_fetch_add(&s->next, 1); i < s->count; i = atomic_fetch_add(&s->next, 1)) s->job(s->context, i);
    return NULL;
}

/* Does jobs 0 .. count - 1, `threads` at a time, 1 .. THREADS; this thread is one of them. */
static inline void share_out(void (*job)(void *context, int number), void *context, int count, int threads)
{
    pthread_t started[THREADS];
    shared_jobs s = {.job = job, .context = context, .count = count};
    int running = 0;
    for (int i = 1; i < threads; i++)
        if (pthread_create(started + running, NULL, do_jobs, &s) == 0) running++;
    (void)do_jobs(&s);
    for (int i = 0; i < running; i++) (void)pthread_join(started[i], NULL);
}

#endif
