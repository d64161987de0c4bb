/* dmb_sim_advance where its tolerances, its bounds or the clock end. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "drillmbd/drillmbd.h"
#include "hash.h"

typedef struct scene {
    dmb_model *model;
    dmb_sim *sim;
} scene;

/* A pendulum of 1 m released from the side. */
static scene pendulum(const dmb_sim_options *options)
{
    scene s = {NULL, NULL};
    dmb_body_def body = dmb_body_def_default();
    body.free_mask = DMB_FREE_RY;
    body.centre[0] = 1.0;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_add_body(s.model, &body, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(s.model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(s.model, options, &s.sim), DMB_OK);
    return s;
}

/* A body that nothing moves. */
static scene at_rest(void)
{
    scene s = {NULL, NULL};
    dmb_body_def body = dmb_body_def_default();
    dmb_environment_def nowhere = dmb_environment_def_default();
    nowhere.gravity[2] = 0.0;
    assert_int_equal(dmb_model_create(NULL, &s.model), DMB_OK);
    assert_int_equal(dmb_model_set_environment(s.model, &nowhere), DMB_OK);
    assert_int_equal(dmb_model_add_body(s.model, &body, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(s.model, NULL), DMB_OK);
    assert_int_equal(dmb_sim_create(s.model, NULL, &s.sim), DMB_OK);
    return s;
}

static void end(scene *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static void steps_are_bounded(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    options.max_steps = 5;
    scene s = pendulum(&options);
    assert_int_equal(dmb_sim_advance(s.sim, 1e300, &report), DMB_NOTE_STOPPED);
    assert_int_equal(report.steps, 5);
    assert_non_null(strstr(dmb_sim_message(s.sim), "max_steps"));
    end(&s);
}

static void clock_that_stands_still_is_refused(void **state)
{
    (void)state;
    scene s = at_rest();
    assert_int_equal(dmb_sim_step(s.sim, 1e17, NULL), DMB_OK); /* to a time whose rounding is above step_max */
    const double late = dmb_sim_time(s.sim);
    assert_int_equal(dmb_sim_advance(s.sim, 2.0 * late, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "rounding"));
    assert_true(dmb_sim_time(s.sim) == late);
    end(&s);
}

/* The refusal names the duration that was asked for, and the least there is at this time. */
static void duration_below_the_rounding_of_time_is_refused(void **state)
{
    (void)state;
    scene s = at_rest();
    assert_int_equal(dmb_sim_step(s.sim, 1e-300, NULL), DMB_OK); /* at time 0 there is none */
    assert_int_equal(dmb_sim_step(s.sim, 0.5, NULL), DMB_OK);
    const uint64_t before = hash_of(s.sim);
    assert_int_equal(dmb_sim_step(s.sim, 1e-300, NULL), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "duration = 1e-300 s is lost in the rounding of time at 0.5 s"));
    assert_non_null(strstr(dmb_sim_message(s.sim), ">= 4.44089e-16 s"));
    assert_true(hash_of(s.sim) == before);
    assert_int_equal(dmb_sim_step(s.sim, 4.45e-16, NULL), DMB_OK);
    assert_int_equal(dmb_sim_step(s.sim, 0.0, NULL), DMB_ERR_VALUE);
    end(&s);
}

static void smallest_step_above_the_tolerance_is_told(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    options.step_min = 0.09;
    options.step_max = 0.1;
    scene s = pendulum(&options);
    assert_int_equal(dmb_sim_advance(s.sim, 2.0, NULL), DMB_NOTE_TOLERANCE);
    assert_non_null(strstr(dmb_sim_message(s.sim), "step_min"));
    end(&s);
}

/* It tells that the time was not reached, before anything else. */
static void end_before_the_time_comes_first(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    options.step_min = 0.09;
    options.step_max = 0.1;
    options.max_steps = 5;
    scene s = pendulum(&options);
    assert_int_equal(dmb_sim_advance(s.sim, 2.0, NULL), DMB_NOTE_STOPPED);
    assert_true(dmb_sim_time(s.sim) < 2.0);
    assert_non_null(strstr(dmb_sim_message(s.sim), "max_steps"));
    end(&s);
}

static void bounded_work_does_not_loosen_advance(void **state)
{
    (void)state;
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    options.bounded_work = 1;
    options.max_iterations = 2;
    options.newton_tolerance = 1e-8;
    scene s = pendulum(&options);
    assert_int_equal(dmb_sim_advance(s.sim, 0.5, &report), DMB_OK);
    assert_true(report.residual <= options.newton_tolerance);
    assert_string_equal(dmb_sim_message(s.sim), "");
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_are_bounded),
        cmocka_unit_test(clock_that_stands_still_is_refused),
        cmocka_unit_test(duration_below_the_rounding_of_time_is_refused),
        cmocka_unit_test(smallest_step_above_the_tolerance_is_told),
        cmocka_unit_test(end_before_the_time_comes_first),
        cmocka_unit_test(bounded_work_does_not_loosen_advance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
