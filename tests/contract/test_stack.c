/* The stack that calls need, held against lib/README.md: each runs on a stack of its own that was painted before,
 * and what has lost its paint is counted. */
#define _GNU_SOURCE
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

#include "sanitized.h"
#include "whole_scene.h"

enum { STACK = 1 << 20, PAINT = 0xA5 };
#define DMB_STACK_STATED 65536 /* [byte] of every call here, lib/README.md */

typedef struct work {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *sim;
    int call;
} work;

enum { NOTHING, COMPILE, CREATE, STEP, ADVANCE, SET_DRIVE, SET_JOINT, SNAPSHOT, STATIC, EVENT, CALLS };
static const char *const names[CALLS] = {"nothing",   "compile",   "create",   "step",   "advance",
                                         "set_drive", "set_joint", "snapshot", "static", "to event"};

static void snapshot_and_back(dmb_sim *sim)
{
    size_t size = 0;
    if (dmb_sim_snapshot_size(sim, &size) < 0) return;
    void *block = malloc(size);
    if (block != NULL && dmb_sim_snapshot(sim, block, size) >= 0) (void)dmb_sim_restore(sim, block, size);
    free(block);
}

static void *run(void *context)
{
    work *w = context;
    switch (w->call) {
    case NOTHING: break;
    case COMPILE: (void)dmb_model_compile(w->model, NULL); break;
    case CREATE: (void)dmb_sim_create(w->model, NULL, &w->sim); break;
    case STEP:
        for (int i = 0; i < 20; i++) (void)dmb_sim_step(w->sim, 1e-3, NULL);
        break;
    case ADVANCE: (void)dmb_sim_advance(w->sim, dmb_sim_time(w->sim) + 2e-3, NULL); break;
    case SET_DRIVE: (void)dmb_sim_set_drive(w->sim, w->parts.pushing, 3.0); break;
    case SET_JOINT: (void)dmb_sim_set_joint(w->sim, w->parts.hinge, DMB_JOINT_LOCKED); break;
    case SNAPSHOT: snapshot_and_back(w->sim); break;
    case STATIC: (void)dmb_analysis_static(w->sim, NULL, NULL); break;
    default: (void)dmb_sim_advance_to_event(w->sim, dmb_sim_time(w->sim) + 2e-3, NULL, NULL); break;
    }
    return NULL;
}

/* A force on as many places as there can be, whose derivatives are given. */
static int32_t pull(void *context, double time, uint32_t count, const double (*poses)[12],
                    const double (*velocities)[6], double (*forces)[6], double *tangent, double *potential,
                    const dmb_law_memory *memory)
{
    (void)memory;
    (void)context, (void)time, (void)poses, (void)velocities, (void)tangent, (void)potential;
    for (uint32_t i = 0; i < count; i++) forces[i][1] = 0.1;
    return 0;
}

static void add_widest_force(work *w)
{
    dmb_force_def force = dmb_force_def_default();
    force.frame = DMB_FRAME_WORLD;
    force.place_count = 4;
    for (uint32_t i = 0; i < 4; i++) force.place[i] = dmb_station(w->parts.string, 3, 0.15 + 0.2 * i);
    force.provides = DMB_PROVIDES_TANGENT;
    force.callback = pull;
    whole_must(w->model, dmb_model_add_force(w->model, &force, NULL));
}

/* So that it is looked for. */
static void add_event(work *w)
{
    dmb_event_def event = dmb_event_def_default();
    memcpy(event.name, "moves", sizeof "moves");
    event.output.place = dmb_station(w->parts.string, 3, 0.5);
    event.output.quantity = DMB_OUTPUT_ROTARY_SPEED;
    event.direction = DMB_EVENT_EITHER;
    whole_must(w->model, dmb_model_add_event(w->model, &event, NULL));
}

/* [byte] that lost their paint, what a thread needs by itself included (thread-local memory of libraries stands
 * there) */
static size_t stack_of(work *w, unsigned char *stack)
{
    pthread_attr_t attributes;
    pthread_t thread;
    size_t untouched = 0;
    memset(stack, PAINT, STACK);
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstack(&attributes, stack, STACK), 0);
    assert_int_equal(pthread_create(&thread, &attributes, run, w), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(pthread_attr_destroy(&attributes), 0);
    while (untouched < STACK && stack[untouched] == PAINT) untouched++; /* it grows down */
    return STACK - untouched;
}

static void stack_is_as_stated(void **state)
{
    (void)state;
    static work w;
    size_t thread = 0;
    unsigned char *stack = aligned_alloc(4096, STACK);
    assert_non_null(stack);
    memset(&w, 0, sizeof w);
    w.model = whole_model_until(&w.parts, WHOLE_CALLS - 1); /* all but compile */
    add_widest_force(&w);
    add_event(&w);
    for (w.call = 0; w.call < CALLS; w.call++) {
        const size_t used = stack_of(&w, stack);
        if (w.call == NOTHING) thread = used;
        printf("stack of %-9s %6zu bytes\n", names[w.call], used - thread);
        assert_true(used - thread <= DMB_STACK_STATED);
    }
    if (w.sim == NULL) fail_msg("%s", dmb_model_message(w.model));
    dmb_sim_destroy(&w.sim);
    dmb_model_destroy(&w.model);
    free(stack);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(stack_is_as_stated)};
#if defined(SANITIZED)
    printf("sanitizers have larger frames: nothing to compare\n");
    return 0;
#endif
    return cmocka_run_group_tests(tests, NULL, NULL);
}
