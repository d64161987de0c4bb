/* One compiled model with joints, many threads: each sim comes out as it does alone, by either method, with joints
 * switched on the way. Built for the thread sanitizer as well. */
#define _POSIX_C_SOURCE 200809L /* barriers */
#include <pthread.h>

#include "joint_scene.h"

enum { THREADS = 6 };
static const double step = 1e-3;
static joint_scene scene;

typedef struct job {
    pthread_t thread;
    pthread_barrier_t *start;
    int32_t method;
    uint32_t steps;
    uint64_t hash;
    int32_t worst;
} job;

static void keep_worst(job *j, int32_t status)
{
    if (status < j->worst) j->worst = status;
}

static void ask(job *j, const dmb_sim *sim)
{
    dmb_joint_state joint = dmb_joint_state_default();
    double multipliers[6];
    uint32_t count;
    for (uint32_t i = 0; i < scene.joints; i++) {
        keep_worst(j, dmb_query_joint(sim, scene.joint[i], &joint));
        keep_worst(j, dmb_query_multipliers(sim, scene.joint[i], multipliers, &count));
    }
}

/* Nothing of cmocka in here: it is not made for threads. */
static void run(job *j)
{
    static const int32_t states[3] = {DMB_JOINT_LOCKED, DMB_JOINT_ACTIVE, DMB_JOINT_OPEN};
    const dmb_sim_options options = scene_options(j->method);
    dmb_sim *sim = NULL;
    keep_worst(j, dmb_sim_create(scene.s.model, &options, &sim));
    for (uint32_t i = 0; i < j->steps; i++) {
        keep_worst(j, dmb_sim_step(sim, step, NULL));
        if (i % 8 == 5 && i / 8 < 3) keep_worst(j, dmb_sim_set_joint(sim, scene.elbow, states[i / 8]));
        ask(j, sim);
    }
    keep_worst(j, dmb_sim_hash(sim, &j->hash));
    dmb_sim_destroy(&sim);
}

static void *work(void *context)
{
    job *j = context;
    (void)pthread_barrier_wait(j->start);
    run(j);
    return NULL;
}

static job args_of(int i, pthread_barrier_t *start)
{
    job j;
    memset(&j, 0, sizeof j);
    j.start = start;
    j.method = i % 2;
    j.steps = 20 + 5 * (uint32_t)(i / 2);
    return j;
}

static void sims_of_one_model_are_as_alone(void **state)
{
    pthread_barrier_t start;
    job jobs[THREADS], alone[THREADS];
    (void)state;
    joint_scene_open(&scene, NULL);
    assert_int_equal(pthread_barrier_init(&start, NULL, THREADS), 0);
    for (int i = 0; i < THREADS; i++) {
        alone[i] = jobs[i] = args_of(i, &start);
        run(&alone[i]);
    }
    for (int i = 0; i < THREADS; i++) assert_int_equal(pthread_create(&jobs[i].thread, NULL, work, &jobs[i]), 0);
    for (int i = 0; i < THREADS; i++) {
        assert_int_equal(pthread_join(jobs[i].thread, NULL), 0);
        if (jobs[i].worst < 0) fail_msg("thread %d: %s", i, dmb_status_name(jobs[i].worst));
        assert_true(jobs[i].hash == alone[i].hash);
    }
    pthread_barrier_destroy(&start);
    rig_close(&scene.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sims_of_one_model_are_as_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
