/* One step by itself: an attempt leaves the accepted state alone, its error estimate is the local error, and Newton
 * converges as it should. */
#include <string.h>

#include "mechanism.h"
#include "ode.h"
#include "rig.h"

#include "integrator/trial_step.h"
#include "math/se3.h"
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

/* ---- The scheme -------------------------------------------------------------------------------------------------- */

/* Angle, speed and acceleration of the pendulum, and the a of the scheme. */
typedef struct instant {
    double x, v, f, a;
} instant;

static instant instant_of(const rig *s, dmb_id id)
{
    const dmb_configuration *now = &s->sim->now;
    const instant at = {angle_of(s, id), now->velocity[5], now->acceleration[5], now->pseudo_acceleration[5]};
    return at;
}

static dmb_id open_sharp_pendulum(rig *s, double r)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = r;
    options.newton_tolerance = 1e-13;
    return open_pendulum(s, &options);
}

/* Equal steps of a pendulum, whose angles add: eq:integration.operator, which are eq:integration.recursion and
 * eq:integration.newmark with the parameters eq:integration.parameters. D is the difference to the step before. */
static void equal_steps_obey_the_operator_form(void **state)
{
    (void)state;
    static const double radii[4] = {0.0, 0.5, 0.8, 1.0};
    const double h = 0.02;
    for (int k = 0; k < 4; k++) {
        rig s;
        const double r = radii[k], am = (2.0 * r - 1.0) / (r + 1.0), af = r / (r + 1.0);
        const double gamma = 0.5 + af - am, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
        double worst[4] = {0.0};
        const dmb_id id = open_sharp_pendulum(&s, r);
        take_steps(&s, h, 3);
        for (int n = 0; n < 20; n++) {
            const instant was = instant_of(&s, id);
            take_steps(&s, h, 1);
            const instant is = instant_of(&s, id);
            const double Dx = is.x - was.x, Dv = is.v - was.v, Df = is.f - was.f, Da = is.a - was.a;
            const double errors[4] = {is.f + 9.81 * sin(is.x), is.a - am * Da - (is.f - af * Df),
                                      Dv - h * (is.a - (1.0 - gamma) * Da),
                                      Dx - h * (is.v - Dv) - h * h * (0.5 * is.a - (0.5 - beta) * Da)};
            for (int i = 0; i < 4; i++) worst[i] = fmax(worst[i], fabs(errors[i]));
        }
        tell("spectral radius", r);
        check_below("    equation of motion [rad/s2]", worst[0], 1e-10);
        check_below("    recursion [rad/s2]", worst[1], 1e-10);
        check_below("    speed [rad/s]", worst[2], 1e-12);
        check_below("    angle [rad]", worst[3], 1e-14);
        rig_close(&s);
    }
}

/* A correction of the increment moves speed and acceleration by eq:integration.factors, by which the iteration matrix
 * is made of mass, damping and stiffness. */
static void corrections_move_the_motion_by_the_factors(void **state)
{
    (void)state;
    const double h = 0.02, r = 0.8, am = (2.0 * r - 1.0) / (r + 1.0), af = r / (r + 1.0), dz = 1e-3;
    const double gamma = 0.5 + af - am, beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
    const double to_acceleration = (1.0 - am) / (h * h * beta * (1.0 - af)), to_velocity = gamma / (h * beta);
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(r);
    dmb_trial_step trial_step;
    rig s;
    (void)open_sharp_pendulum(&s, r);
    take_steps(&s, h, 3);
    assert_int_equal(try_step(&s, h, &trial_step), DMB_OK);
    check_relative("factor of the mass", trial_step.evaluation.mass_factor, to_acceleration, 1e-12);
    check_relative("factor of the damping", trial_step.evaluation.velocity_factor, to_velocity, 1e-12);
    const double v = s.sim->trial.velocity[5], f = s.sim->trial.acceleration[5];
    memset(s.sim->correction, 0, s.sim->scene->row_count * sizeof(double));
    s.sim->correction[5] = dz;
    dmb_step_motion_correct(s.sim, &c, h);
    check_relative("change of the speed", s.sim->trial.velocity[5] - v, to_velocity * dz, 1e-12);
    check_relative("change of the acceleration", s.sim->trial.acceleration[5] - f, to_acceleration * dz, 1e-12);
    rig_close(&s);
}

/* Largest deviation of the motion before its projection, of that which Newmark's formulas make of the increments; and
 * of the poses from those moved by the increments. */
static void deviations(const dmb_sim *sim, double h, double r, double worst[3])
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(r);
    for (uint32_t i = 0; i < sim->scene->row_count; i++) {
        const double v0 = sim->now.velocity[i], f0 = sim->now.acceleration[i], a0 = sim->now.pseudo_acceleration[i];
        const double a = (sim->increment[i] - h * v0 - h * h * (0.5 - c.beta) * a0) / (h * h * c.beta);
        const double v = v0 + h * ((1.0 - c.gamma) * a0 + c.gamma * a);
        const double f = ((1.0 - c.am) * a + c.am * a0 - c.af * f0) / (1.0 - c.af);
        worst[0] = fmax(worst[0], fabs(sim->raw_velocity[i] - v));
        worst[1] = fmax(worst[1], fabs(sim->raw_acceleration[i] - f));
    }
    for (uint32_t i = 0; i < sim->scene->node_count; i++) {
        double q[4], u[3];
        dmb_quat_copy(sim->now.quaternion + 4 * i, q);
        dmb_vec3_copy(sim->now.displacement + 3 * i, u);
        dmb_se3_advance(q, u, sim->increment + sim->scene->layout.row[i]);
        worst[2] = fmax(worst[2], largest_difference(4, q, sim->trial.quaternion + 4 * i));
        worst[2] = fmax(worst[2], largest_difference(3, u, sim->trial.displacement + 3 * i));
    }
}

/* A four-bar in long steps: the projection of its poses moves increments, speeds and accelerations together
 * (eq:integration.projection). */
static void projections_move_the_motion_too(void **state)
{
    (void)state;
    const double h = 0.02, r = 0.8;
    const dmb_sim_options options = sharp_options(r, 1e-12);
    const bar bars[3] = {{{0.0, 0.0}, {0.6, 0.8}, 1.0}, {{0.6, 0.8}, {2.0, 1.5}, 2.0}, {{2.0, 0.0}, {2.0, 1.5}, 3.0}};
    double worst[3] = {0.0};
    dmb_trial_step trial_step;
    dmb_id id[3];
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 3; i++) id[i] = add_bar(&s, bars + i);
    const double coupler = 0.5 * hypot(1.4, 0.7);
    (void)add_hinge(&s, "a", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(id[0], -0.5));
    (void)add_hinge(&s, "b", DMB_JOINT_REVOLUTE, pin_on(id[0], 0.5), pin_on(id[1], -coupler));
    (void)add_hinge(&s, "c", DMB_JOINT_REVOLUTE, pin_on(id[1], coupler), pin_on(id[2], 0.75));
    (void)add_hinge(&s, "d", DMB_JOINT_REVOLUTE, pin_ground(2.0, 0.0), pin_on(id[2], -0.75));
    assert_true(mechanism_start(&s, &options) >= 0);
    take_steps(&s, h, 3);
    for (int n = 0; n < 20; n++) {
        assert_int_equal(try_step(&s, h, &trial_step), DMB_OK);
        deviations(s.sim, h, r, worst);
        dmb_trial_step_commit(s.sim, &trial_step);
    }
    check_below("speeds, of those of the increments [m/s, rad/s]", worst[0], 1e-11);
    check_below("accelerations [m/s2, rad/s2]", worst[1], 1e-8);
    check_below("poses [m, -]", worst[2], 1e-14);
    rig_close(&s);
}

/* ---- Attempts ---------------------------------------------------------------------------------------------------- */

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
        cmocka_unit_test(equal_steps_obey_the_operator_form),
        cmocka_unit_test(corrections_move_the_motion_by_the_factors),
        cmocka_unit_test(projections_move_the_motion_too),
        cmocka_unit_test(attempt_leaves_the_accepted_state_alone),
        cmocka_unit_test(free_body_converges),
        cmocka_unit_test(small_loads_act_on_stiff_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
