/* One step by itself: an attempt leaves the accepted state alone, its error estimate is the local error, and Newton
 * converges as it should. */
#include <string.h>

#include "ode.h"
#include "rig.h"

#include "integrator/trial_step.h"
#include "sim/sim.h"

static dmb_id open_pendulum(rig *s, const dmb_sim_options *options)
{
    dmb_body_def body = dmb_body_def_default();
    rig_open(s, 9.81, 0.0, 0.0);
    body.free_mask = DMB_FREE_RZ;
    body.centre[0] = 1.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-15;
    body.rotation[2] = 1.0;
    body.velocity[5] = 0.5;
    const dmb_id id = add_body(s, &body);
    (void)rig_start(s, options);
    return id;
}

static void pendulum_rate(void *context, double t, const double *y, double *rate)
{
    (void)context, (void)t;
    rate[0] = y[1];
    rate[1] = -9.81 * sin(y[0]);
}

static double angle_of(const rig *s, dmb_id id)
{
    const dmb_pose pose = pose_at(s, dmb_station(id, 0, 0.0));
    return atan2(pose.rotation[3], pose.rotation[0]);
}

static int32_t try_step(const rig *s, double h, dmb_trial_step *trial_step)
{
    const dmb_step_end end = dmb_step_end_after(s->sim, h);
    return dmb_trial_step_run(s->sim, &end, 1, trial_step);
}

/* Estimate over the error of one step started on the exact solution, after many steps (the a of the scheme lags then as
 * it does for ever). */
static double estimate_over_error(double r, double h)
{
    rig s;
    dmb_trial_step trial_step;
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = r;
    options.newton_tolerance = 1e-13;
    options.tolerance_rotation = 1.0;
    const dmb_id id = open_pendulum(&s, &options);
    take_steps(&s, h, 100);
    double y[2] = {angle_of(&s, id), motion_at(&s, dmb_station(id, 0, 0.0), DMB_FRAME_BODY).velocity[5]};
    ode_solve(pendulum_rate, NULL, 0.0, h, 2, 2, y);
    assert_int_equal(try_step(&s, h, &trial_step), DMB_OK);
    const double estimate = dmb_trial_step_error(s.sim, h).here;
    dmb_trial_step_commit(s.sim, &trial_step);
    const double error = fabs(angle_of(&s, id) - y[0]);
    rig_close(&s);
    return estimate / error;
}

/* Third order: C h^2 (a1 - a0), C = beta + (am - af)/2 - 1/6 (eq:integration.local-error). */
static void error_estimate_is_the_local_error(void **state)
{
    (void)state;
    const double radius[3] = {0.5, 0.8, 1.0};
    for (int k = 0; k < 3; k++) {
        tell("spectral radius", radius[k]);
        check_close("    estimate over local error, h 1e-3", estimate_over_error(radius[k], 1e-3), 1.0, 0.05);
    }
}

/* Trying a step changes nothing that counts, and trying it twice gives the same. */
static void attempt_leaves_the_accepted_state_alone(void **state)
{
    (void)state;
    rig s;
    dmb_trial_step trial_step;
    uint64_t before = 0, after = 0;
    const dmb_id id = open_pendulum(&s, NULL);
    take_steps(&s, 1e-3, 10);
    must(&s, dmb_sim_hash(s.sim, &before));
    assert_int_equal(try_step(&s, 5e-3, &trial_step), DMB_OK);
    const double first = s.sim->trial.velocity[5];
    assert_int_equal(try_step(&s, 5e-3, &trial_step), DMB_OK);
    assert_true(s.sim->trial.velocity[5] == first);
    must(&s, dmb_sim_hash(s.sim, &after));
    assert_true(before == after);
    dmb_trial_step_commit(s.sim, &trial_step);
    must(&s, dmb_sim_hash(s.sim, &after));
    assert_true(before != after);
    assert_true(fabs(dmb_sim_time(s.sim) - 0.015) < 1e-15);
    assert_true(isfinite(angle_of(&s, id)));
    rig_close(&s);
}

/* A free body in flight has no other forces than the two parts of its inertia: they are what the residual is measured
 * by. */
static void free_body_converges(void **state)
{
    (void)state;
    rig s;
    dmb_trial_step trial_step;
    dmb_body_def body = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) body.inertia[i] = 1.0 + i;
    body.velocity[0] = 0.5;
    body.velocity[4] = 6.0;
    body.velocity[5] = 0.02;
    (void)add_body(&s, &body);
    options.newton_tolerance = 1e-13;
    (void)rig_start(&s, &options);
    for (int i = 0; i < 10; i++) {
        assert_int_equal(try_step(&s, 2e-3, &trial_step), DMB_OK);
        assert_true(trial_step.iterations <= 3);
        dmb_trial_step_commit(s.sim, &trial_step);
    }
    rig_close(&s);
}

/* A load below what the rounding of a stiff beam's pose makes of its force still moves it. */
static void small_loads_act_on_stiff_beams(void **state)
{
    (void)state;
    rig s;
    dmb_pipe_def beam = beam_pipe(1.0, 1, 1e14, 1e14, 1.0, 1.0);
    dmb_load_def load = dmb_load_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    const dmb_id string = add_beam(&s, &beam, DMB_FREE_NONE);
    load.place = dmb_station(string, 0, 1.0);
    load.force[2] = 1e-3;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    double most = 0.0;
    for (int i = 0; i < 2000; i++) {
        take_steps(&s, 1e-3, 1);
        most = fmax(most, pose_at(&s, dmb_station(string, 0, 1.0)).displacement[2]);
    }
    check_relative("largest deflection over twice the static one", most, 2.0 * 1e-3 / 3.0, 0.05);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_estimate_is_the_local_error),
        cmocka_unit_test(attempt_leaves_the_accepted_state_alone),
        cmocka_unit_test(free_body_converges),
        cmocka_unit_test(small_loads_act_on_stiff_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
