/* Nothing is allocated once a sim is made: not in a step, a question, a snapshot, a static start or a call that fails.
 * Counted twice: in the allocator that model and sim were given, and in malloc and its kin of the C library, which this
 * program puts its own functions in the place of. A sanitizer does the same with its own, so there the second count is
 * left out; a checker that replaces malloc at run time is noticed. */
#include <stdlib.h>

#include "counted_malloc.h"
#include "whole_scene.h"

/* ---- A scene, and a snapshot in static memory -------------------------------------------------------------------- */

static struct {
    whole_parts parts;
    whole_answers answers;
    dmb_model *model;
    dmb_sim *sim;
    unsigned char snapshot[1 << 18];
    size_t snapshot_size;
} scene;

static void log_nothing(void *context, int32_t level, const char *text)
{
    (void)context, (void)level, (void)text;
}

static int set_up(void **state)
{
    dmb_allocator allocator = dmb_allocator_default();
    dmb_model_options options = dmb_model_options_default();
    (void)state;
    allocator.allocate = take;
    allocator.release = give;
    options.allocator = &allocator;
    options.log = log_nothing;
    memset(&scene, 0, sizeof scene);
    if (dmb_model_create(&options, &scene.model) < 0) return -1;
    for (size_t i = 0; i < WHOLE_CALLS; i++) {
        if (whole_calls[i](scene.model, &scene.parts) < 0) return -1;
    }
    if (dmb_sim_create(scene.model, NULL, &scene.sim) < 0) return -1;
    whole_answers_init(&scene.answers, &scene.parts);
    return dmb_sim_snapshot_size(scene.sim, &scene.snapshot_size) < 0 || scene.snapshot_size > sizeof scene.snapshot;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
    return 0;
}

/* ---- What is done without memory --------------------------------------------------------------------------------- */

/* Each returns the worst status that came back. */
static int32_t step(void)
{
    dmb_step_report report = dmb_step_report_default();
    int32_t worst = 0;
    for (int i = 0; i < 30; i++) {
        const int32_t status = dmb_sim_step(scene.sim, 1e-3, &report);
        if (status < worst) worst = status;
    }
    return worst;
}

static int32_t advance(void)
{
    return dmb_sim_advance(scene.sim, dmb_sim_time(scene.sim) + 0.01, NULL);
}

static int32_t ask(void)
{
    uint64_t hash;
    (void)dmb_sim_message(scene.sim);
    (void)dmb_sim_hash(scene.sim, &hash);
    return whole_ask(scene.sim, &scene.parts, &scene.answers);
}

static int32_t save_and_restore(void)
{
    const int32_t saved = dmb_sim_snapshot(scene.sim, scene.snapshot, scene.snapshot_size);
    return saved < 0 ? saved : dmb_sim_restore(scene.sim, scene.snapshot, scene.snapshot_size);
}

static int32_t set_drive(void)
{
    const int32_t set = dmb_sim_set_drive(scene.sim, scene.parts.turning, 3.0);
    return set < 0 ? set : dmb_sim_set_drive(scene.sim, scene.parts.turning, (double)NAN);
}

/* Nothing holds the free body, so this one fails late. Steady states of drives that move take memory. */
static int32_t static_start(void)
{
    dmb_static_options options = dmb_static_options_default();
    options.steady = DMB_STEADY_AT_REST;
    return dmb_analysis_static(scene.sim, &options, NULL);
}

static int32_t step_with_failing_callback(void)
{
    int32_t status;
    scene.parts.callback_status = 1;
    status = dmb_sim_step(scene.sim, 0.02, NULL);
    if (status < 0) status = dmb_sim_advance(scene.sim, dmb_sim_time(scene.sim) + 0.01, NULL);
    scene.parts.callback_status = 0;
    return status;
}

static int32_t step_by_nonsense(void)
{
    const int32_t a = dmb_sim_step(scene.sim, (double)NAN, NULL), b = dmb_sim_step(scene.sim, -1.0, NULL);
    const int32_t c = dmb_sim_advance(scene.sim, -1.0, NULL);
    return a < 0 && b < 0 && c < 0 ? DMB_ERR_VALUE : DMB_OK;
}

static int32_t restore_nonsense(void)
{
    memset(scene.snapshot, 7, 100);
    return dmb_sim_restore(scene.sim, scene.snapshot, scene.snapshot_size);
}

typedef struct deed {
    const char *name;
    int32_t (*act)(void);
    int fails;
} deed;

static const deed deeds[] = {
    {"step", step, 0},
    {"advance", advance, 0},
    {"questions", ask, 0},
    {"snapshot", save_and_restore, 0},
    {"set_drive", set_drive, 0},
    {"static start that fails", static_start, 1},
    {"step with a failing callback", step_with_failing_callback, 1},
    {"step by nonsense", step_by_nonsense, 1},
    {"restore of nonsense", restore_nonsense, 1},
};

static void do_all(const volatile size_t *calls)
{
    for (size_t i = 0; i < sizeof deeds / sizeof deeds[0]; i++) {
        const size_t before = *calls;
        const int32_t status = deeds[i].act();
        const size_t after = *calls;
        if ((status < 0) != deeds[i].fails) fail_msg("%s: %s", deeds[i].name, dmb_status_name(status));
        if (after != before) fail_msg("%s: %zu allocations", deeds[i].name, after - before);
    }
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

static void given_allocator_is_not_called(void **state)
{
    (void)state;
    do_all(&given_calls);
}

static void malloc_is_not_called_skipped_where_another_tool_replaces_it(void **state)
{
    (void)state;
    if (!malloc_is_counted()) skip();
    do_all(&malloc_calls);
}

/* A static start that succeeds: the signs of its stiffness take two blocks for the time of the call. */
static void static_start_takes_two_blocks_skipped_where_another_tool_replaces_malloc(void **state)
{
    whole_parts parts;
    dmb_model *model;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_sim *sim;
    (void)state;
    if (!malloc_is_counted()) skip();
    model = whole_model_until(&parts, 0);
    string.start_free = DMB_FREE_NONE;
    whole_must(model, dmb_model_add_string(model, &string, NULL));
    whole_must(model, dmb_model_add_pipes(model, &pipe, 4, NULL));
    whole_must(model, dmb_model_compile(model, NULL));
    sim = whole_sim(model, NULL);
    const size_t before = malloc_calls;
    const int32_t status = dmb_analysis_static(sim, NULL, NULL);
    const size_t after = malloc_calls;
    dmb_sim_destroy(&sim);
    dmb_model_destroy(&model);
    assert_int_equal(status, DMB_OK);
    assert_int_equal(after, before + 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(given_allocator_is_not_called, set_up, tear_down),
        cmocka_unit_test_setup_teardown(malloc_is_not_called_skipped_where_another_tool_replaces_it, set_up, tear_down),
        cmocka_unit_test(static_start_takes_two_blocks_skipped_where_another_tool_replaces_malloc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
