/* One compiled model, many threads: each sim comes out as it does alone, and the model lives as long as the last of
 * them. Built for the thread sanitizer as well. */
#define _POSIX_C_SOURCE 200809L /* barriers */
#include <pthread.h>
#include <stdlib.h>

#include "whole_scene.h"

#ifdef DMB_SOME_CASES
enum { THREADS = 6, STEPS = 10, MANY = 32, FEW_STEPS = 3, FURTHER = 2 };
#else
enum { THREADS = 6, STEPS = 40, MANY = 64, FEW_STEPS = 10, FURTHER = 9 };
#endif
static const double step = 1e-3;

typedef struct job {
    pthread_t thread;
    pthread_barrier_t *start;
    dmb_model *model;
    const whole_parts *parts;
    dmb_sim *sim; /* NULL: the thread makes and destroys its own */
    uint32_t steps;
    uint64_t hash;
    int32_t worst;
} job;

static void keep_worst(job *j, int32_t status)
{
    if (status < j->worst) j->worst = status;
}

/* Nothing of cmocka in here: it is not made for threads. */
static void *work(void *context)
{
    job *j = context;
    dmb_sim *sim = j->sim;
    whole_answers *answers = malloc(sizeof *answers);
    whole_answers_init(answers, j->parts);
    if (j->start != NULL) (void)pthread_barrier_wait(j->start);
    if (sim == NULL) keep_worst(j, dmb_sim_create(j->model, NULL, &sim));
    for (uint32_t i = 0; i < j->steps; i++) {
        keep_worst(j, dmb_sim_step(sim, step, NULL));
        keep_worst(j, whole_ask(sim, j->parts, answers));
    }
    keep_worst(j, dmb_sim_hash(sim, &j->hash));
    if (j->sim == NULL) dmb_sim_destroy(&sim);
    free(answers);
    return NULL;
}

static uint64_t alone(dmb_model *model, uint32_t steps)
{
    dmb_sim *sim = whole_sim(model, NULL);
    whole_run(sim, steps, step);
    const uint64_t hash = whole_hash(sim);
    dmb_sim_destroy(&sim);
    return hash;
}

static void set_up_jobs(job jobs[THREADS], dmb_model *model, const whole_parts *parts, pthread_barrier_t *start)
{
    memset(jobs, 0, THREADS * sizeof jobs[0]);
    for (uint32_t i = 0; i < THREADS; i++) {
        jobs[i].start = start;
        jobs[i].model = model;
        jobs[i].parts = parts;
        jobs[i].steps = STEPS;
    }
    if (start != NULL) assert_int_equal(pthread_barrier_init(start, NULL, THREADS), 0);
}

static void start_all(job jobs[THREADS])
{
    for (int i = 0; i < THREADS; i++) assert_int_equal(pthread_create(&jobs[i].thread, NULL, work, &jobs[i]), 0);
}

static void join_all(job jobs[THREADS])
{
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(jobs[i].thread, NULL), 0);
        if (jobs[i].worst < 0) fail_msg("thread %d: %s", i, dmb_status_name(jobs[i].worst));
    }
}

/* Sims are made, run, asked and destroyed at the same time. */
static void sims_of_one_model_are_as_alone(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    const uint64_t wanted = alone(model, STEPS);
    pthread_barrier_t start;
    job jobs[THREADS];
    (void)state;
    set_up_jobs(jobs, model, &parts, &start);
    start_all(jobs);
    join_all(jobs);
    for (int i = 0; i < THREADS; i++) assert_true(jobs[i].hash == wanted);
    pthread_barrier_destroy(&start);
    dmb_model_destroy(&model);
}

/* More than there are processors, all made, run and destroyed at the same time. */
static void many_sims(void **state)
{
    static job jobs[MANY];
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    const uint64_t wanted = alone(model, FEW_STEPS);
    pthread_barrier_t start;
    (void)state;
    memset(jobs, 0, sizeof jobs);
    assert_int_equal(pthread_barrier_init(&start, NULL, MANY), 0);
    for (int i = 0; i < MANY; i++) {
        jobs[i].start = &start;
        jobs[i].model = model;
        jobs[i].parts = &parts;
        jobs[i].steps = FEW_STEPS;
        assert_int_equal(pthread_create(&jobs[i].thread, NULL, work, &jobs[i]), 0);
    }
    for (int i = 0; i < MANY; i++) {
        assert_int_equal(pthread_join(jobs[i].thread, NULL), 0);
        if (jobs[i].worst < 0) fail_msg("thread %d: %s", i, dmb_status_name(jobs[i].worst));
        assert_true(jobs[i].hash == wanted);
    }
    pthread_barrier_destroy(&start);
    dmb_model_destroy(&model);
}

/* Runs of different length, so that the threads are at different places. */
static void different_runs_do_not_disturb_each_other(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    uint64_t wanted[THREADS];
    pthread_barrier_t start;
    job jobs[THREADS];
    (void)state;
    set_up_jobs(jobs, model, &parts, &start);
    for (uint32_t i = 0; i < THREADS; i++) {
        jobs[i].steps = 5 + FURTHER * i;
        wanted[i] = alone(model, jobs[i].steps);
    }
    start_all(jobs);
    join_all(jobs);
    for (int i = 0; i < THREADS; i++) assert_true(jobs[i].hash == wanted[i]);
    pthread_barrier_destroy(&start);
    dmb_model_destroy(&model);
}

/* The caller lets the model go while its sims run; the last one takes it along. */
static void model_destroyed_while_sims_live(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    const uint64_t wanted = alone(model, STEPS);
    pthread_barrier_t start;
    job jobs[THREADS];
    (void)state;
    set_up_jobs(jobs, model, &parts, &start);
    for (int i = 0; i < THREADS; i++) jobs[i].sim = whole_sim(model, NULL);
    start_all(jobs);
    dmb_model_destroy(&model);
    assert_null(model);
    join_all(jobs);
    for (int i = 0; i < THREADS; i++) {
        assert_true(jobs[i].hash == wanted);
        dmb_sim_destroy(&jobs[i].sim);
    }
    pthread_barrier_destroy(&start);
}

typedef struct ending {
    pthread_t thread;
    dmb_sim *sim;
    pthread_barrier_t *start;
} ending;

static void *end(void *context)
{
    ending *e = context;
    (void)pthread_barrier_wait(e->start);
    dmb_sim_destroy(&e->sim);
    return NULL;
}

/* All let go at once: one of them gives the model back, and only one. */
static void last_of_many_takes_the_model_along(void **state)
{
    (void)state;
    for (int round = 0; round < 20; round++) {
        whole_parts parts;
        dmb_model *model = whole_model(&parts);
        pthread_barrier_t start;
        ending endings[THREADS];
        assert_int_equal(pthread_barrier_init(&start, NULL, THREADS + 1), 0);
        for (int i = 0; i < THREADS; i++) {
            endings[i].start = &start;
            endings[i].sim = whole_sim(model, NULL);
            assert_int_equal(pthread_create(&endings[i].thread, NULL, end, &endings[i]), 0);
        }
        (void)pthread_barrier_wait(&start);
        dmb_model_destroy(&model);
        for (int i = 0; i < THREADS; i++) {
            assert_int_equal(pthread_join(endings[i].thread, NULL), 0);
            assert_null(endings[i].sim);
        }
        pthread_barrier_destroy(&start);
    }
}

/* A sim belongs to one thread at a time, and may change hands. */
static void sim_changes_threads(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model(&parts);
    dmb_sim *sim = whole_sim(model, NULL);
    job jobs[THREADS];
    (void)state;
    set_up_jobs(jobs, model, &parts, NULL);
    for (int i = 0; i < THREADS; i++) {
        jobs[i].sim = sim;
        jobs[i].steps = 7;
        assert_int_equal(pthread_create(&jobs[i].thread, NULL, work, &jobs[i]), 0);
        assert_int_equal(pthread_join(jobs[i].thread, NULL), 0);
        assert_true(jobs[i].worst >= 0);
    }
    assert_true(whole_hash(sim) == alone(model, 7 * THREADS));
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
}

typedef struct builder {
    pthread_t thread;
    pthread_barrier_t *start;
    whole_parts parts;
    uint32_t generation;
    int32_t worst;
    uint64_t hash;
} builder;

static void *build(void *context)
{
    builder *b = context;
    dmb_model *model = NULL;
    dmb_sim *sim = NULL;
    (void)pthread_barrier_wait(b->start);
    b->worst = dmb_model_create(NULL, &model);
    for (size_t i = 0; i < WHOLE_CALLS && b->worst >= 0; i++) b->worst = whole_calls[i](model, &b->parts);
    if (b->worst >= 0) b->worst = dmb_sim_create(model, NULL, &sim);
    for (int i = 0; i < STEPS && b->worst >= 0; i++) b->worst = dmb_sim_step(sim, step, NULL);
    if (b->worst >= 0) b->worst = dmb_sim_hash(sim, &b->hash);
    b->generation = b->parts.string.generation;
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    return NULL;
}

/* Models described at the same time do not know of each other, and their ids differ. */
static void models_are_built_in_parallel(void **state)
{
    static builder builders[THREADS];
    pthread_barrier_t start;
    (void)state;
    assert_int_equal(pthread_barrier_init(&start, NULL, THREADS), 0);
    memset(builders, 0, sizeof builders);
    for (int i = 0; i < THREADS; i++) {
        builders[i].start = &start;
        assert_int_equal(pthread_create(&builders[i].thread, NULL, build, &builders[i]), 0);
    }
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(builders[i].thread, NULL), 0);
        assert_true(builders[i].worst >= 0);
        assert_true(builders[i].hash == builders[0].hash);
        for (int k = 0; k < i; k++) assert_true(builders[k].generation != builders[i].generation);
    }
    pthread_barrier_destroy(&start);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sims_of_one_model_are_as_alone),
        cmocka_unit_test(many_sims),
        cmocka_unit_test(different_runs_do_not_disturb_each_other),
        cmocka_unit_test(model_destroyed_while_sims_live),
        cmocka_unit_test(last_of_many_takes_the_model_along),
        cmocka_unit_test(sim_changes_threads),
        cmocka_unit_test(models_are_built_in_parallel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
