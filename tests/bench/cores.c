/* One long string on two cores: scenes C and B in steps of 1 ms, by the caller's threads against one thread.
 * usage: cores [PARTS [STEPS]]
 *
 * path_us: thread time of what is made in the calling thread alone and of the longest part of each run, the parts being
 * made one after the other by that thread. It is the time of a step on cores that do nothing else, but for the starts
 * of the runs (start_us each, of a pool of threads that do nothing), and can be measured on a machine that others use.
 * times: thread time alone over path_us and starts. wall: time that passes with the pool, which tells something where
 * nobody else computes. Bits are compared for both. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../../examples/two_cores/pool.h"
#include "scenes.h"

enum { ROUNDS = 5 };

static double seconds_of(clockid_t clock)
{
    struct timespec t;
    (void)clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Makes the parts itself, with a watch. */
typedef struct watch {
    double made, longest; /* [s] in parts, in the longest of each run */
    uint64_t runs;
} watch;

static int32_t run_watched(void *context, uint32_t count, dmb_part_fn part, void *work)
{
    watch *w = context;
    double longest = 0.0, begin = seconds_of(CLOCK_THREAD_CPUTIME_ID), end;
    for (uint32_t i = 0; i < count; i++, begin = end) {
        part(work, i);
        end = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        longest = fmax(longest, end - begin);
        w->made += end - begin;
    }
    w->longest += longest;
    w->runs++;
    return 0;
}

typedef struct result {
    double wall, path; /* [s] a step, least of all rounds */
    double runs;       /* [-] a step */
    uint64_t hash;
} result;

static int32_t walk(dmb_model *model, const dmb_sim_options *options, int steps, result *out)
{
    watch none = {0.0, 0.0, 0}, *w = options->parallel == run_watched ? options->parallel_context : &none;
    dmb_sim *sim = NULL;
    int32_t status = dmb_sim_create(model, options, &sim);
    memset(w, 0, sizeof *w);
    const double wall = seconds_of(CLOCK_MONOTONIC), own = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    for (int i = 0; i < steps && status >= 0; i++) status = dmb_sim_step(sim, 1e-3, NULL);
    const double spent = seconds_of(CLOCK_THREAD_CPUTIME_ID) - own;
    out->wall = fmin(out->wall, (seconds_of(CLOCK_MONOTONIC) - wall) / steps);
    out->path = fmin(out->path, (spent - w->made + w->longest) / steps);
    out->runs = (double)w->runs / steps;
    if (status >= 0) status = dmb_sim_hash(sim, &out->hash);
    dmb_sim_destroy(&sim);
    return status;
}

static void empty(void *work, uint32_t index)
{
    (void)work;
    (void)index;
}

typedef struct plan {
    pool threads;
    double start; /* [s] of a run */
    double clock; /* [s] of a look at it */
    uint32_t parts;
    int steps;
} plan;

static int compare(int kind, uint32_t elements, plan *p)
{
    scene s;
    watch w;
    result alone = {1e9, 1e9, 0.0, 0}, path = alone, threads = alone;
    dmb_sim_options options = dmb_sim_options_default(), watched, pooled;
    memset(&s, 0, sizeof s);
    s.kind = kind;
    s.pipes = elements;
    s.per_pipe = 1;
    s.length = 1.5;
    s.pipe_kind = DMB_PIPE_FLEXIBLE;
    watched = options;
    watched.parallel_parts = p->parts;
    watched.parallel_least = 0;
    pooled = watched;
    watched.parallel = run_watched;
    watched.parallel_context = &w;
    pooled.parallel = pool_run;
    pooled.parallel_context = &p->threads;
    int32_t status = scene_open(&s);
    for (int i = 0; i < ROUNDS && status >= 0; i++) {
        status = walk(s.model, &options, p->steps, &alone);
        if (status >= 0) status = walk(s.model, &watched, p->steps, &path);
        if (status >= 0) status = walk(s.model, &pooled, p->steps, &threads);
    }
    dmb_model_destroy(&s.model);
    if (status < 0) return printf("%s %u: %s\n", scene_names[kind], elements, dmb_status_name(status)), 1;
    const int same = alone.hash == path.hash && alone.hash == threads.hash;
    const double made = path.path - 2.0 * path.runs * p->clock; /* two looks at the clock in each run */
    printf("scene=%s elements=%u alone_us=%.1f path_us=%.1f runs=%.1f times=%.2f with_starts=%.2f wall_us=%.1f "
           "wall_times=%.2f %s\n",
           scene_names[kind], elements, 1e6 * alone.path, 1e6 * made, path.runs, alone.path / made,
           alone.path / (made + path.runs * p->start), 1e6 * threads.wall, alone.wall / threads.wall,
           same ? "same bits" : "OTHER BITS");
    fflush(stdout);
    return !same;
}

/* [s] of an empty run, least of many. */
static double start_of(plan *p)
{
    double least = 1e9;
    for (int i = 0; i < 20000; i++) {
        const double begin = seconds_of(CLOCK_MONOTONIC);
        (void)pool_run(&p->threads, p->parts, empty, NULL);
        least = fmin(least, seconds_of(CLOCK_MONOTONIC) - begin);
    }
    return least;
}

static double clock_of(void)
{
    double least = 1e9, begin = seconds_of(CLOCK_THREAD_CPUTIME_ID), end;
    for (int i = 0; i < 20000; i++, begin = end) {
        end = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        least = fmin(least, end - begin);
    }
    return least;
}

int main(int argc, char **argv)
{
    static const uint32_t elements[] = {500, 1000, 2000, 5000, 10000};
    static plan p;
    int failed = 0;
    p.parts = pool_start(&p.threads, argc > 1 ? (uint32_t)atoi(argv[1]) : 2);
    p.steps = argc > 2 ? atoi(argv[2]) : 40;
    p.start = start_of(&p);
    p.clock = clock_of();
    printf("parts=%u start_us=%.2f\n", p.parts, 1e6 * p.start);
    for (int kind = SCENE_C; kind <= SCENE_B; kind++)
        for (size_t i = 0; i < sizeof elements / sizeof elements[0]; i++) failed |= compare(kind, elements[i], &p);
    pool_stop(&p.threads);
    return failed;
}
