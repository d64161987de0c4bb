/* Steps of a scene with joints keep the contract of every step: they allocate nothing and call nothing of the kernel,
 * failing ones and switching joints included; the same scene gives the same bits, restored, in memory of any alignment,
 * by both methods and under error control. Malloc is counted (counted_malloc.h), system calls are caught (fence.h);
 * both are left out where another tool stands in the way. */
#define _GNU_SOURCE /* syscall */
#include "counted_malloc.h"
#include "hash.h"
#include "joint_scene.h"
#include "sanitized.h"

static const double step = 1e-3;

/* ---- The scene --------------------------------------------------------------------------------------------------- */

static joint_scene scene;
static unsigned char saved[1 << 18];

static void open_scene(const dmb_model_options *options, int32_t method)
{
    const dmb_sim_options with = scene_options(method);
    joint_scene_open(&scene, options);
    const int32_t status = dmb_sim_create(scene.s.model, &with, &scene.s.sim);
    must_model(&scene.s, status);
}

static void close_scene(void)
{
    rig_close(&scene.s);
}

static void run_sim(dmb_sim *sim, uint32_t n)
{
    for (uint32_t i = 0; i < n; i++) {
        const int32_t status = dmb_sim_step(sim, step, NULL);
        if (status < 0) fail_msg("step %u: %s: %s", i, dmb_status_name(status), dmb_sim_message(sim));
    }
}

static void must_switch(dmb_sim *sim, dmb_id elbow, int32_t to)
{
    const int32_t status = dmb_sim_set_joint(sim, elbow, to);
    if (status < 0) fail_msg("set_joint: %s: %s", dmb_status_name(status), dmb_sim_message(sim));
}

/* A run with all that can happen to joints in it. */
static void eventful_run_of(const joint_scene *c, dmb_sim *sim)
{
    run_sim(sim, 15);
    must_switch(sim, c->elbow, DMB_JOINT_LOCKED);
    run_sim(sim, 10);
    must_switch(sim, c->elbow, DMB_JOINT_OPEN);
    run_sim(sim, 1);
    assert_int_equal(dmb_sim_set_joint(sim, c->elbow, DMB_JOINT_ACTIVE), DMB_ERR_GEOMETRY);
    assert_true(dmb_sim_set_drive(sim, c->push, 5.0) >= 0);
    run_sim(sim, 15);
}

static void eventful_run(dmb_sim *sim)
{
    eventful_run_of(&scene, sim);
}

/* ---- Deeds ------------------------------------------------------------------------------------------------------- */

/* Each returns the worst status that came back. */
static int32_t worse(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static int32_t some_steps(void)
{
    int32_t worst = 0;
    for (int i = 0; i < 20; i++) worst = worse(worst, dmb_sim_step(scene.s.sim, step, NULL));
    return worst;
}

static int32_t advance(void)
{
    return dmb_sim_advance(scene.s.sim, dmb_sim_time(scene.s.sim) + 0.004, NULL);
}

static int32_t ask(void)
{
    dmb_joint_state joint = dmb_joint_state_default();
    dmb_statistics statistics = dmb_statistics_default();
    dmb_energy energy = dmb_energy_default();
    dmb_drive_state drive = dmb_drive_state_default();
    double multipliers[6];
    uint32_t count;
    int32_t worst = dmb_query_statistics(scene.s.sim, &statistics);
    for (uint32_t j = 0; j < scene.joints; j++) {
        worst = worse(worst, dmb_query_joint(scene.s.sim, scene.joint[j], &joint));
        worst = worse(worst, dmb_query_multipliers(scene.s.sim, scene.joint[j], multipliers, &count));
    }
    worst = worse(worst, dmb_query_multipliers(scene.s.sim, scene.gear, multipliers, &count));
    worst = worse(worst, dmb_query_multipliers(scene.s.sim, scene.shell, multipliers, &count));
    worst = worse(worst, dmb_query_multipliers(scene.s.sim, scene.feed, multipliers, &count));
    worst = worse(worst, dmb_query_drive(scene.s.sim, scene.turning, &drive));
    return worse(worst, dmb_query_energy(scene.s.sim, &energy));
}

static int32_t save_and_restore(void)
{
    size_t size = 0;
    int32_t worst = dmb_sim_snapshot_size(scene.s.sim, &size);
    if (size > sizeof saved) return DMB_ERR_TOO_LARGE;
    worst = worse(worst, dmb_sim_snapshot(scene.s.sim, saved, size));
    return worse(worst, dmb_sim_restore(scene.s.sim, saved, size));
}

static int32_t switch_joints(void)
{
    int32_t worst = dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_LOCKED);
    worst = worse(worst, dmb_sim_step(scene.s.sim, step, NULL));
    worst = worse(worst, dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_OPEN));
    worst = worse(worst, dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_ACTIVE));
    return worse(worst, dmb_sim_step(scene.s.sim, step, NULL));
}

static int32_t set_drive(void)
{
    const int32_t set = dmb_sim_set_drive(scene.s.sim, scene.push, 3.0);
    return worse(set, dmb_sim_set_drive(scene.s.sim, scene.push, (double)NAN));
}

/* Opened, moved on and closed: its parts are apart then. The state of before comes back. */
static int32_t close_apart(void)
{
    int32_t status = save_and_restore();
    size_t size = 0;
    (void)dmb_sim_snapshot_size(scene.s.sim, &size);
    if (status >= 0) status = dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_OPEN);
    if (status >= 0) status = dmb_sim_step(scene.s.sim, 5.0 * step, NULL);
    if (status < 0) return DMB_OK;
    status = dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_ACTIVE);
    (void)dmb_sim_restore(scene.s.sim, saved, size);
    return status == DMB_ERR_GEOMETRY ? status : DMB_OK;
}

static int32_t lock_what_is_driven(void)
{
    return dmb_sim_set_joint(scene.s.sim, scene.joint[0], DMB_JOINT_LOCKED);
}

static int32_t failing_callback(void)
{
    scene.callback_status = 1;
    int32_t status = dmb_sim_step(scene.s.sim, step, NULL);
    if (status < 0) status = dmb_sim_set_joint(scene.s.sim, scene.elbow, DMB_JOINT_LOCKED);
    scene.callback_status = 0;
    return status;
}

/* Its attempts count in the statistics. */
static int32_t advance_with_failing_callback(void)
{
    scene.callback_status = 1;
    const int32_t status = dmb_sim_advance(scene.s.sim, dmb_sim_time(scene.s.sim) + 0.01, NULL);
    scene.callback_status = 0;
    return status;
}

/* Much too long: halved again and again in vain. */
static int32_t step_that_fails(void)
{
    return dmb_sim_step(scene.s.sim, 1e6, NULL);
}

typedef struct deed {
    const char *name;
    int32_t (*act)(void);
    int fails;  /* 1: it must, and leave the state as it was */
    int counts; /* 1: but for the statistics */
} deed;

static const deed deeds[] = {
    {"steps", some_steps, 0, 0},
    {"advance", advance, 0, 0},
    {"questions", ask, 0, 0},
    {"snapshot", save_and_restore, 0, 0},
    {"set_drive", set_drive, 0, 0},
    {"set_joint", switch_joints, 0, 0},
    {"set_joint of parts apart", close_apart, 1, 0},
    {"set_joint of a driven joint", lock_what_is_driven, 1, 0},
    {"failing callback", failing_callback, 1, 0},
    {"advance with a failing callback", advance_with_failing_callback, 1, 1},
    {"step that does not converge", step_that_fails, 1, 0},
    {"steps afterwards", some_steps, 0, 0},
};
enum { DEEDS = sizeof deeds / sizeof deeds[0] };

static void do_all(const volatile size_t *calls)
{
    for (size_t i = 0; i < DEEDS; i++) {
        const uint64_t hash = hash_of(scene.s.sim);
        const size_t before = *calls;
        const int32_t status = deeds[i].act();
        const size_t after = *calls;
        if ((status < 0) != deeds[i].fails)
            fail_msg("%s: %s: %s", deeds[i].name, dmb_status_name(status), dmb_sim_message(scene.s.sim));
        if (after != before) fail_msg("%s: %zu allocations", deeds[i].name, after - before);
        if (status < 0 && !deeds[i].counts && hash_of(scene.s.sim) != hash)
            fail_msg("%s: failed and changed the state", deeds[i].name);
    }
}

static void given_allocator_is_not_called(void **state)
{
    (void)state;
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    for (int32_t method = 0; method < 2; method++) {
        open_scene(&options, method);
        do_all(&given_calls);
        close_scene();
    }
}

static void malloc_is_not_called_skipped_where_another_tool_replaces_it(void **state)
{
    (void)state;
    if (!malloc_is_counted()) skip();
    for (int32_t method = 0; method < 2; method++) {
        open_scene(NULL, method);
        do_all(&malloc_calls);
        close_scene();
    }
}

/* ---- System calls ------------------------------------------------------------------------------------------------ */

typedef struct outcome {
    uint64_t hash, surprises;
} outcome;

static outcome all_deeds(void)
{
    outcome o = {0, 0};
    for (size_t i = 0; i < DEEDS; i++) o.surprises += (deeds[i].act() < 0) != deeds[i].fails;
    if (dmb_sim_hash(scene.s.sim, &o.hash) < 0) o.surprises++;
    return o;
}

#include "fence.h"

static void run_needs_no_system_call_skipped_under_sanitizers_and_checkers(void **state)
{
    (void)state;
    if (!fence_works()) skip();
    for (int32_t method = 0; method < 2; method++) {
        open_scene(NULL, method);
        const outcome fenced = run_behind_the_fence(), open = all_deeds();
        assert_int_equal(fenced.surprises, 0);
        assert_int_equal(open.surprises, 0);
        assert_true(fenced.hash == open.hash);
        close_scene();
    }
}

/* ---- Bits -------------------------------------------------------------------------------------------------------- */

static uint64_t reference(int32_t method)
{
    open_scene(NULL, method);
    eventful_run(scene.s.sim);
    const uint64_t hash = hash_of(scene.s.sim);
    close_scene();
    return hash;
}

static void same_scene_twice_is_the_same(void **state)
{
    (void)state;
    for (int32_t method = 0; method < 2; method++) assert_true(reference(method) == reference(method));
    assert_true(reference(0) != reference(1)); /* they do round differently */
}

static void block_does_not_matter(void **state)
{
    (void)state;
    for (int32_t method = 0; method < 2; method++) {
        const uint64_t wanted = reference(method);
        const dmb_sim_options options = scene_options(method);
        size_t size = 0;
        open_scene(NULL, method);
        assert_int_equal(dmb_sim_memory_size(scene.s.model, &options, &size), DMB_OK);
        unsigned char *memory = malloc(size + 64);
        for (size_t offset = 0; offset < 64; offset += offset < 9 ? 1 : 11) {
            dmb_sim *sim = NULL;
            memset(memory, (int)(0xFF - offset), size + 64);
            assert_true(dmb_sim_create_in(scene.s.model, &options, memory + offset, size, &sim) >= 0);
            eventful_run(sim);
            assert_true(hash_of(sim) == wanted);
            dmb_sim_destroy(&sim);
            for (size_t i = 0; i < offset; i++) assert_int_equal(memory[i], (unsigned char)(0xFF - offset));
            for (size_t i = offset + size; i < size + 64; i++)
                assert_int_equal(memory[i], (unsigned char)(0xFF - offset));
        }
        free(memory);
        close_scene();
    }
}

/* Restored into a sim that has been elsewhere meanwhile, at three places of the run. */
static void restored_sims_go_on(void **state)
{
    (void)state;
    static const int32_t states[3] = {DMB_JOINT_ACTIVE, DMB_JOINT_LOCKED, DMB_JOINT_OPEN};
    for (int32_t method = 0; method < 2; method++)
        for (int k = 0; k < 3; k++) {
            const dmb_sim_options options = scene_options(method);
            dmb_sim *fresh = NULL;
            size_t size = 0;
            open_scene(NULL, method);
            run_sim(scene.s.sim, 12);
            assert_true(dmb_sim_set_joint(scene.s.sim, scene.elbow, states[k]) >= 0);
            run_sim(scene.s.sim, 3);
            assert_int_equal(dmb_sim_snapshot_size(scene.s.sim, &size), DMB_OK);
            assert_true(size <= sizeof saved);
            assert_int_equal(dmb_sim_snapshot(scene.s.sim, saved, size), DMB_OK);
            run_sim(scene.s.sim, 25);
            assert_true(dmb_sim_advance(scene.s.sim, 0.05, NULL) >= 0);
            const uint64_t end = hash_of(scene.s.sim);
            assert_true(dmb_sim_create(scene.s.model, &options, &fresh) >= 0);
            eventful_run(fresh);
            assert_int_equal(dmb_sim_restore(fresh, saved, size), DMB_OK);
            run_sim(fresh, 25);
            assert_true(dmb_sim_advance(fresh, 0.05, NULL) >= 0);
            if (hash_of(fresh) != end) fail_msg("method %d, elbow %d: restored sim goes another way", method, k);
            dmb_sim_destroy(&fresh);
            close_scene();
        }
}

/* Failing calls on the way leave no trace. */
static void failures_do_not_matter(void **state)
{
    (void)state;
    for (int32_t method = 0; method < 2; method++) {
        open_scene(NULL, method);
        run_sim(scene.s.sim, 40);
        const uint64_t wanted = hash_of(scene.s.sim);
        close_scene();
        open_scene(NULL, method);
        for (int i = 0; i < 40; i++) {
            if (i == 25) assert_true(step_that_fails() < 0);
            if (i % 5 == 1) assert_true(failing_callback() < 0);
            if (i % 5 == 2) assert_true(close_apart() < 0);
            if (i % 5 == 3) assert_true(lock_what_is_driven() < 0);
            run_sim(scene.s.sim, 1);
        }
        assert_true(hash_of(scene.s.sim) == wanted);
        close_scene();
    }
}

/* ---- Physics of it ----------------------------------------------------------------------------------------------- */

/* Both methods solve the same equations. */
static void methods_agree(void **state)
{
    (void)state;
    static joint_scene other;
    dmb_joint_state a = dmb_joint_state_default(), b = dmb_joint_state_default();
    double worst = 0.0, violation[2];
    dmb_sim_options options = scene_options(DMB_METHOD_MULTIPLIERS);
    options.newton_tolerance = 1e-12;
    joint_scene_open(&other, NULL);
    assert_true(dmb_sim_create(other.s.model, &options, &other.s.sim) >= 0);
    joint_scene_open(&scene, NULL);
    options.constraint_method = DMB_METHOD_INDEPENDENT;
    assert_true(dmb_sim_create(scene.s.model, &options, &scene.s.sim) >= 0);
    eventful_run(scene.s.sim);
    eventful_run_of(&other, other.s.sim);
    for (uint32_t j = 0; j < scene.joints; j++) {
        assert_int_equal(dmb_query_joint(scene.s.sim, scene.joint[j], &a), DMB_OK);
        assert_int_equal(dmb_query_joint(other.s.sim, other.joint[j], &b), DMB_OK);
        worst = fmax(worst, largest_difference(6, a.position, b.position));
        worst = fmax(worst, largest_difference(6, a.speed, b.speed));
    }
    violation[0] = statistics_of(&scene.s).violation;
    violation[1] = statistics_of(&other.s).violation;
    check_below("methods apart after 41 steps: coordinates and speeds", worst, 1e-7);
    check_below("violation, independent coordinates", violation[0], 1e-12);
    check_below("violation, multipliers", violation[1], 1e-12);
    rig_close(&other.s);
    close_scene();
}

/* [m, rad] Largest difference of coordinates of joints after an error-controlled run of 0.05 s from those of small
 * steps. */
static double error_of_advance(const joint_scene *exact, double tolerance)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_joint_state a = dmb_joint_state_default(), b = dmb_joint_state_default();
    dmb_sim *sim = NULL;
    double worst = 0.0;
    options.tolerance_translation *= tolerance;
    options.tolerance_rotation *= tolerance;
    assert_true(dmb_sim_create(exact->s.model, &options, &sim) >= 0);
    assert_true(dmb_sim_advance(sim, 0.05, NULL) >= 0);
    for (uint32_t j = 0; j < exact->joints; j++) {
        assert_int_equal(dmb_query_joint(sim, exact->joint[j], &a), DMB_OK);
        assert_int_equal(dmb_query_joint(exact->s.sim, exact->joint[j], &b), DMB_OK);
        worst = fmax(worst, largest_difference(6, a.position, b.position));
    }
    dmb_statistics statistics = dmb_statistics_default();
    assert_int_equal(dmb_query_statistics(sim, &statistics), DMB_OK);
    tell("steps of error control in 0.05 s", (double)statistics.steps);
    check_below("violation", statistics.violation, 1e-12);
    dmb_sim_destroy(&sim);
    return worst;
}

/* The error-controlled run against small fixed steps, of which half as long ones differ by 1e-6: its error is
 * proportional to the tolerance. */
static void advance_holds_its_tolerance(void **state)
{
    (void)state;
    static joint_scene exact;
    joint_scene_open(&exact, NULL);
    assert_true(dmb_sim_create(exact.s.model, NULL, &exact.s.sim) >= 0);
    for (int i = 0; i < 1000; i++) assert_true(dmb_sim_step(exact.s.sim, 5e-5, NULL) >= 0);
    const double usual = error_of_advance(&exact, 1.0), quarter = error_of_advance(&exact, 0.25);
    check_below("error control against steps of 5e-5 s: coordinates", usual, 2e-4);
    check_below("    with a quarter of the tolerance", quarter, 5e-5);
    check_below("    quarter over whole", quarter / usual, 0.35);
    rig_close(&exact.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(given_allocator_is_not_called),
        cmocka_unit_test(malloc_is_not_called_skipped_where_another_tool_replaces_it),
        cmocka_unit_test(run_needs_no_system_call_skipped_under_sanitizers_and_checkers),
        cmocka_unit_test(same_scene_twice_is_the_same),
        cmocka_unit_test(block_does_not_matter),
        cmocka_unit_test(restored_sims_go_on),
        cmocka_unit_test(failures_do_not_matter),
        cmocka_unit_test(methods_agree),
        cmocka_unit_test(advance_holds_its_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
