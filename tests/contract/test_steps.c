/* dmb_sim_steps: the same bits as so many calls of dmb_sim_step, the largest note with its message, and where a step
 * fails or the caller ends the call, the state after the steps before it. */
#include "whole_scene.h"

static const double step = 1e-3; /* [s] */

typedef struct pair {
    whole_parts parts;
    dmb_model *model;
    dmb_sim *one_by_one, *at_once;
} pair;

static void open_pair(pair *p, const dmb_sim_options *options)
{
    p->model = whole_model(&p->parts);
    p->one_by_one = whole_sim(p->model, options);
    p->at_once = whole_sim(p->model, options);
}

static void close_pair(pair *p)
{
    dmb_sim_destroy(&p->one_by_one);
    dmb_sim_destroy(&p->at_once);
    dmb_model_destroy(&p->model);
}

/* `count` calls: the sums and maxima of their reports, and the largest status. */
static int32_t step_by_step(dmb_sim *sim, uint32_t count, dmb_step_report *sum)
{
    int32_t worst = DMB_OK;
    for (uint32_t k = 0; k < count; k++) {
        dmb_step_report one = dmb_step_report_default();
        const int32_t status = dmb_sim_step(sim, step, &one);
        assert_true(status >= 0);
        if (status > worst) worst = status;
        sum->steps += one.steps;
        sum->iterations += one.iterations;
        sum->rejected += one.rejected;
        if (one.most_iterations > sum->most_iterations) sum->most_iterations = one.most_iterations;
        if (one.residual > sum->residual) sum->residual = one.residual;
        sum->time = one.time;
        sum->last_step = one.last_step;
    }
    return worst;
}

/* Without a note, with divided steps, with steps above the tolerance. */
static void same_as_one_by_one(void **state)
{
    static const int32_t wanted_status[3] = {DMB_OK, DMB_NOTE_STEP_CUT, DMB_NOTE_WORK_LIMITED};
    static const char *const message[3] = {"", "divided into", "accepted as asked"};
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        dmb_step_report wanted = dmb_step_report_default(), report = dmb_step_report_default();
        dmb_sim_options options = dmb_sim_options_default();
        uint32_t done = 0;
        pair p;
        options.bounded_work = kind == 2;
        if (kind > 0) options.max_iterations = kind == 1 ? 2 : 1;
        open_pair(&p, &options);
        assert_int_equal(step_by_step(p.one_by_one, 60, &wanted), wanted_status[kind]);
        assert_int_equal(dmb_sim_steps(p.at_once, step, 60, &done, &report), wanted_status[kind]);
        assert_int_equal(done, 60);
        assert_memory_equal(&report, &wanted, sizeof report);
        assert_true(whole_hash(p.one_by_one) == whole_hash(p.at_once));
        assert_non_null(strstr(dmb_sim_message(p.at_once), message[kind]));
        close_pair(&p);
    }
}

static void nothing_asked_is_nothing_done(void **state)
{
    uint32_t done = 7;
    pair p;
    (void)state;
    open_pair(&p, NULL);
    assert_int_equal(dmb_sim_steps(p.at_once, step, 0, &done, NULL), DMB_OK);
    assert_int_equal(done, 0);
    assert_true(whole_hash(p.one_by_one) == whole_hash(p.at_once));
    close_pair(&p);
}

static int32_t fail_from(void *context, double fraction)
{
    if (fraction >= 0.5) ((whole_parts *)context)->callback_status = 1;
    return 0;
}

static int32_t end_from(void *context, double fraction)
{
    (void)context;
    return fraction >= 0.5;
}

/* Half of the steps are done, and the sim goes on as the other one does. */
static void ends_in_the_middle(dmb_progress_fn function, int32_t wanted)
{
    dmb_step_report sum = dmb_step_report_default(), report = dmb_step_report_default();
    uint32_t done = 0;
    pair p;
    open_pair(&p, NULL);
    step_by_step(p.one_by_one, 10, &sum);
    assert_int_equal(dmb_sim_set_progress(p.at_once, function, &p.parts), DMB_OK);
    assert_int_equal(dmb_sim_steps(p.at_once, step, 20, &done, &report), wanted);
    assert_int_equal(done, 10);
    assert_int_equal(report.steps, sum.steps);
    assert_true(report.time == sum.time && report.rejected >= sum.rejected);
    assert_true(dmb_sim_message(p.at_once)[0] != '\0');
    assert_true(whole_hash(p.one_by_one) == whole_hash(p.at_once));
    p.parts.callback_status = 0;
    assert_int_equal(dmb_sim_set_progress(p.at_once, NULL, NULL), DMB_OK);
    assert_true(dmb_sim_steps(p.at_once, step, 10, NULL, NULL) >= 0);
    step_by_step(p.one_by_one, 10, &sum);
    assert_true(whole_hash(p.one_by_one) == whole_hash(p.at_once));
    close_pair(&p);
}

static void ends_at_the_first_failure(void **state)
{
    (void)state;
    ends_in_the_middle(fail_from, DMB_ERR_CALLBACK);
}

static void ends_when_the_caller_ends_it(void **state)
{
    (void)state;
    ends_in_the_middle(end_from, DMB_ERR_CANCELLED);
}

static void refusals_change_nothing(void **state)
{
    const double durations[] = {0.0, -1.0, (double)NAN, (double)INFINITY, 2e18};
    dmb_step_report report = dmb_step_report_default();
    uint32_t done = 7;
    pair p;
    (void)state;
    open_pair(&p, NULL);
    for (size_t i = 0; i < sizeof durations / sizeof durations[0]; i++) {
        const int32_t status = dmb_sim_steps(p.at_once, durations[i], 3, &done, &report);
        assert_int_equal(status, isfinite(durations[i]) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
        assert_non_null(strstr(dmb_sim_message(p.at_once), "duration"));
    }
    report.struct_size = 4;
    assert_int_equal(dmb_sim_steps(p.at_once, step, 3, &done, &report), DMB_ERR_STRUCT_SIZE);
    assert_int_equal(dmb_sim_steps(NULL, step, 3, &done, NULL), DMB_ERR_NULL);
    assert_int_equal(done, 7);
    assert_true(whole_hash(p.one_by_one) == whole_hash(p.at_once));
    close_pair(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_one_by_one),        cmocka_unit_test(nothing_asked_is_nothing_done),
        cmocka_unit_test(ends_at_the_first_failure), cmocka_unit_test(ends_when_the_caller_ends_it),
        cmocka_unit_test(refusals_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
