/* Error-controlled steps of dmb_sim_advance against tight references. The control holds the local error of third order,
 * so the global one goes with tolerance^(2/3) and the number of steps with tolerance^(-1/3)
 * (eq:integration.local-error). */
#include "ode.h"
#include "rig.h"

static void pendulum_rate(void *context, double t, const double *y, double *rate)
{
    (void)context, (void)t;
    rate[0] = y[1];
    rate[1] = -9.81 * sin(y[0]);
}

typedef struct outcome {
    double error;
    uint32_t steps, rejected;
} outcome;

/* Pendulum, L 1, from 2.5 rad: slow near the top, fast below. */
static outcome swing(double tolerance, double t)
{
    rig s;
    outcome out;
    double y[2] = {2.5, 0.0};
    dmb_body_def body = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report report = dmb_step_report_default();
    rig_open(&s, 9.81, 0.0, 0.0);
    body.free_mask = DMB_FREE_RZ;
    body.centre[0] = 1.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-15;
    body.rotation[2] = 2.5;
    const dmb_id id = add_body(&s, &body);
    options.tolerance_rotation = tolerance;
    options.newton_tolerance = 1e-13;
    (void)rig_start(&s, &options);
    must(&s, dmb_sim_advance(s.sim, t, &report));
    assert_true(dmb_sim_time(s.sim) == t);
    const dmb_pose pose = pose_at(&s, dmb_station(id, 0, 0.0));
    ode_solve(pendulum_rate, NULL, 0.0, t, 1000, 2, y);
    out.error = fabs(sin(atan2(pose.rotation[3], pose.rotation[0]) - y[0]));
    out.steps = report.steps;
    out.rejected = report.rejected;
    rig_close(&s);
    return out;
}

static void error_follows_the_tolerance(void **state)
{
    (void)state;
    outcome o[5];
    for (int k = 0; k < 5; k++) {
        const double tolerance = 1e-4 * pow(10.0, -k);
        o[k] = swing(tolerance, 10.0);
        print_message("    tolerance %.0e: error %.3g rad, %u steps, %u rejected\n", tolerance, o[k].error, o[k].steps,
                      o[k].rejected);
        assert_true(o[k].rejected <= o[k].steps / 2);
    }
    const double exponent = log10(o[1].error / o[4].error) / 3.0;
    const double growth = log10((double)o[4].steps / o[1].steps) / 3.0;
    check_close("exponent of the error over the tolerance", exponent, 2.0 / 3.0, 0.05);
    check_close("exponent of the steps over 1/tolerance", growth, 1.0 / 3.0, 0.02);
}

/* A body pushed by 1 N with a STEP between 2 and 2.01 s: long steps before, short ones in the flank, long ones again.
 */
static void steps_grow_and_shrink(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_step_report before = dmb_step_report_default(), flank = before, after = before;
    dmb_segment term = dmb_segment_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    body.free_mask = DMB_FREE_X;
    const dmb_id id = add_body(&s, &body);
    term.kind = DMB_SEGMENT_STEP;
    term.x0 = 2.0, term.x1 = 2.01, term.h1 = 1.0;
    (void)add_simple_drive(&s, DMB_DRIVE_LOAD, id, DMB_X, add_time_function(&s, &term, 1));
    options.tolerance_translation = 1e-10;
    options.step_max = 1.0;
    (void)rig_start(&s, &options);
    must(&s, dmb_sim_advance(s.sim, 2.0, &before));
    must(&s, dmb_sim_advance(s.sim, 2.01, &flank));
    must(&s, dmb_sim_advance(s.sim, 4.01, &after));
    print_message("    steps: %u before, %u in the flank, %u after\n", before.steps, flank.steps, after.steps);
    assert_true(before.steps <= 20 && flank.steps >= 10 && after.steps <= 40);
    /* The scheme holds the local error of the place, 1e-10 m a step; half of the flank and 2 s count. */
    check_close("speed", motion_at(&s, dmb_station(id, 0, 0.0), DMB_FRAME_WORLD).velocity[0], 2.005, 1e-6);
    const double path = 0.15 * 1e-4 + 0.005 * 2.0 + 0.5 * 4.0;
    check_close("path", pose_at(&s, dmb_station(id, 0, 0.0)).displacement[0], path, 1e-6);
    rig_close(&s);
}

/* The last step ends exactly at the time asked for, and a finished advance goes on where it stopped. */
static void advance_in_pieces(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, -9.81);
    body.free_mask = DMB_FREE_RX;
    body.centre[1] = 1.0;
    const dmb_id id = add_body(&s, &body);
    (void)rig_start(&s, NULL);
    for (int i = 1; i <= 100; i++) {
        const double t = 0.0123 * i;
        must(&s, dmb_sim_advance(s.sim, t, NULL));
        assert_true(dmb_sim_time(s.sim) == t);
    }
    assert_true(isfinite(rotation_at(&s, dmb_station(id, 0, 0.0))));
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_follows_the_tolerance),
        cmocka_unit_test(steps_grow_and_shrink),
        cmocka_unit_test(advance_in_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
