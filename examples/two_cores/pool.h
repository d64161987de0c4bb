/* Threads that wait for work in a loop, so that a start costs a microsecond or two and not the twenty of a thread that
 * sleeps: for programs that have their cores to themselves. pool_run is a dmb_parallel_fn. */
#ifndef POOL_H
#define POOL_H

#include <drillmbd/drillmbd.h>

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <string.h>

enum { POOL_MOST = 64, POOL_SPINS = 4000 };

struct pool;
typedef struct pool_helper {
    _Alignas(64) atomic_uint done; /* number of the last run that it has done its share of */
    uint32_t number;
    struct pool *pool;
    pthread_t thread;
} pool_helper;

typedef struct pool {
    atomic_uint run; /* number of the run under way */
    atomic_int over; /* 1: the helpers end */
    uint32_t helpers, count;
    dmb_part_fn part;
    void *work;
    pool_helper helper[POOL_MOST];
} pool;

/* Waits until *number is another one than `last`; gives way to others on a processor that it does not have alone. */
static inline unsigned pool_wait(atomic_uint *number, unsigned last)
{
    unsigned now;
    for (unsigned spins = 0; (now = atomic_load_explicit(number, memory_order_acquire)) == last; spins++)
        if (spins >= POOL_SPINS) (void)sched_yield();
    return now;
}

/* Parts go round: the caller of pool_run takes the first. */
static inline void pool_share(const pool *p, uint32_t number)
{
    for (uint32_t i = number; i < p->count; i += p->helpers + 1) p->part(p->work, i);
}

static inline void *pool_help(void *context)
{
    pool_helper *helper = context;
    pool *p = helper->pool;
    for (unsigned run = 0;;) {
        run = pool_wait(&p->run, run);
        if (atomic_load(&p->over)) return NULL;
        pool_share(p, helper->number);
        atomic_store_explicit(&helper->done, run, memory_order_release);
    }
}

static inline int32_t pool_run(void *context, uint32_t count, dmb_part_fn part, void *work)
{
    pool *p = context;
    const unsigned run = atomic_load_explicit(&p->run, memory_order_relaxed) + 1;
    p->count = count;
    p->part = part;
    p->work = work;
    atomic_store_explicit(&p->run, run, memory_order_release);
    pool_share(p, 0);
    for (uint32_t i = 0; i < p->helpers; i++) (void)pool_wait(&p->helper[i].done, run - 1);
    return 0;
}

/* The calling thread and `threads` - 1 more. Returns how many there are. */
static inline uint32_t pool_start(pool *p, uint32_t threads)
{
    memset(p, 0, sizeof *p);
    for (uint32_t i = 0; i + 1 < threads && i < POOL_MOST; i++) {
        pool_helper *helper = &p->helper[i];
        helper->number = i + 1;
        helper->pool = p;
        if (pthread_create(&helper->thread, NULL, pool_help, helper) != 0) break;
        p->helpers++;
    }
    return p->helpers + 1;
}

static inline void pool_stop(pool *p)
{
    atomic_store(&p->over, 1);
    atomic_fetch_add(&p->run, 1);
    for (uint32_t i = 0; i < p->helpers; i++) pthread_join(p->helper[i].thread, NULL);
    p->helpers = 0;
}

#endif
