/* Nothing after create asks the kernel for anything. A child process gives up all system calls but read, write and exit
 * (seccomp, strict mode: the kernel kills at any other) and then runs, asks, saves, restores and fails. Its end state
 * has to be that of the same run without the fence. Memory comes out of a pool: an analysis allocates, and whether the
 * heap of the C library then asks the kernel depends on what else has used it (MALLOC_TOP_PAD_=0 makes it do so). Left
 * out under a sanitizer or a checker, whose own calls would be the ones that are caught: these are known at build time,
 * or by an empty child that does not come through. */
#define _GNU_SOURCE /* syscall */
#include "sanitized.h"
#include "whole_scene.h"

/* ---- A run in static memory -------------------------------------------------------------------------------------- */

static unsigned char pool[1 << 22];

static struct {
    whole_parts parts;
    whole_answers answers;
    dmb_model *model;
    dmb_sim *sim;
    unsigned char snapshot[1 << 18];
} scene;

/* The report of the child: the end state, and how many calls went another way than they should. */
typedef struct outcome {
    uint64_t hash;
    uint64_t surprises;
    double time;
} outcome;

static void expect(outcome *o, int holds)
{
    if (!holds) ++o->surprises;
}

static void steps(outcome *o, int count)
{
    for (int i = 0; i < count; i++) expect(o, dmb_sim_step(scene.sim, 1e-3, NULL) >= 0);
}

static void failures(outcome *o)
{
    expect(o, dmb_sim_step(scene.sim, (double)NAN, NULL) == DMB_ERR_NOT_FINITE);
    expect(o, dmb_sim_advance(scene.sim, -1.0, NULL) == DMB_ERR_VALUE);
    expect(o, dmb_sim_set_drive(scene.sim, scene.parts.wall, 1.0) == DMB_ERR_ID);
    expect(o, dmb_sim_restore(scene.sim, scene.snapshot, 8) == DMB_ERR_VALUE);
    expect(o, dmb_analysis_static(scene.sim, NULL, NULL) == DMB_ERR_SINGULAR);
    scene.parts.callback_status = 1;
    expect(o, dmb_sim_step(scene.sim, 1e-3, NULL) == DMB_ERR_CALLBACK);
    scene.parts.callback_status = 0;
}

static outcome all_deeds(void)
{
    outcome o = {0, 0, 0.0};
    size_t size = 0;
    steps(&o, 20);
    expect(&o, whole_ask(scene.sim, &scene.parts, &scene.answers) == DMB_OK);
    expect(&o, dmb_sim_snapshot_size(scene.sim, &size) == DMB_OK && size <= sizeof scene.snapshot);
    expect(&o, dmb_sim_snapshot(scene.sim, scene.snapshot, size) == DMB_OK);
    steps(&o, 20);
    failures(&o);
    expect(&o, dmb_sim_restore(scene.sim, scene.snapshot, size) == DMB_OK);
    expect(&o, dmb_sim_set_drive(scene.sim, scene.parts.turning, 2.0) == DMB_OK);
    expect(&o, dmb_sim_advance(scene.sim, 0.025, NULL) >= 0);
    steps(&o, 20);
    expect(&o, dmb_sim_message(scene.sim) != NULL && dmb_status_name(DMB_ERR_VALUE) != NULL);
    expect(&o, dmb_sim_hash(scene.sim, &o.hash) == DMB_OK);
    o.time = dmb_sim_time(scene.sim);
    return o;
}

static void open_scene(void)
{
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    memset(&scene, 0, sizeof scene);
    assert_int_equal(dmb_pool_allocator(pool, sizeof pool, &allocator), DMB_OK);
    options.allocator = &allocator;
    scene.model = whole_model_with(&options, &scene.parts, WHOLE_CALLS);
    scene.sim = whole_sim(scene.model, NULL);
    whole_answers_init(&scene.answers, &scene.parts);
}

static void close_scene(void)
{
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
}

/* ---- The fence --------------------------------------------------------------------------------------------------- */

#include "fence.h"

/* ---- Test -------------------------------------------------------------------------------------------------------- */

static void run_needs_no_system_call_skipped_under_sanitizers_and_checkers(void **state)
{
    outcome fenced, open;
    (void)state;
    if (!fence_works()) skip();
    open_scene();
    fenced = run_behind_the_fence();
    open = all_deeds();
    close_scene();
    assert_int_equal(fenced.surprises, 0);
    assert_int_equal(open.surprises, 0);
    assert_true(fenced.time == open.time && fenced.time > 0.04);
    assert_true(fenced.hash == open.hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(run_needs_no_system_call_skipped_under_sanitizers_and_checkers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
