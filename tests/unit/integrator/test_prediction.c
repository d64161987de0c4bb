/* Where an iteration begins: the order of the linear prediction against the steps that were really taken, the inertia
 * forces of a change against kinetic energies, and when a step begins with which. Checks eq:integration.memory,
 * eq:integration.prediction and eq:integration.prediction-increment. */
#include <math.h>
#include <string.h>

#include "contact_scene.h"
#include "rig.h"

#include "integrator/prediction.h"
#include "sim/sim.h"
#include "system/assemble/assemble.h"

/* ---- Order ------------------------------------------------------------------------------------------------------- */

/* A body that swings about the z axis of its node. */
static void open_pendulum(rig *s, double radius)
{
    dmb_sim_options options = dmb_sim_options_default();
    dmb_body_def body = dmb_body_def_default();
    options.spectral_radius = radius;
    options.newton_tolerance = 1e-13;
    rig_open(s, 9.81, 0.0, 0.0);
    body.free_mask = DMB_FREE_RZ;
    body.centre[0] = 1.0;
    for (int i = 0; i < 3; i++) body.inertia[i] = 1e-15;
    body.rotation[2] = 1.0;
    body.velocity[5] = 0.5;
    (void)add_body(s, &body);
    (void)rig_start(s, &options);
}

/* Error of the accelerations that are predicted for the ends of steps, over their change in these steps. */
static double part_off(double radius, double h)
{
    const dmb_generalized_alpha c = dmb_generalized_alpha_of(radius);
    double off = 0.0, change = 0.0;
    rig s;
    open_pendulum(&s, radius);
    take_steps(&s, h, (uint32_t)(0.2 / h + 0.5));
    for (uint32_t i = 0; i < (uint32_t)(0.04 / h + 0.5); i++) {
        const double before = s.sim->now.acceleration[DMB_RZ];
        dmb_step_motion_predict(s.sim, &c, h, 1.0 / (c.am - c.af));
        const double predicted = s.sim->trial.acceleration[DMB_RZ];
        take_steps(&s, h, 1);
        off += fabs(predicted - s.sim->now.acceleration[DMB_RZ]);
        change += fabs(before - s.sim->now.acceleration[DMB_RZ]);
    }
    rig_close(&s);
    return off / change;
}

/* Of the constant prediction it is 1; of the linear one it goes with the step. */
static void linear_prediction_is_of_second_order(void **state)
{
    static const double radii[3] = {0.5, 0.8, 0.95};
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double coarse = part_off(radii[k], 1e-3), fine = part_off(radii[k], 5e-4);
        print_message("radius %g: off by %.2e of the change at 1 ms, %.2e at half of it\n", radii[k], coarse, fine);
        CHECK_BELOW(coarse, 0.02);
        CHECK_CLOSE(coarse / fine, 2.0, 0.1);
    }
}

/* ---- Inertia of a change ----------------------------------------------------------------------------------------- */

/* v . M v of the speeds at the start over twice the kinetic energy, less 1. */
static double energy_off(int32_t kind, double joint, const double velocity[6])
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_wall_def wall = dmb_wall_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, 0.0);
    if (kind == DMB_PIPE_AXIAL_TORSIONAL) (void)add_wall(&s, &wall);
    string.start_free = DMB_FREE_ALL;
    memcpy(string.velocity, velocity, sizeof string.velocity);
    pipe.kind = kind;
    pipe.elements = kind == DMB_PIPE_FLEXIBLE ? 2 : 1;
    pipe.joint_length = joint;
    pipe.joint_outer_diameter = joint > 0.0 ? 0.085 : 0.0;
    (void)add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 10);
    (void)rig_start(&s, NULL);
    dmb_inertia_of_change(s.sim->scene, s.sim->now.velocity, 1.0, s.sim->residual);
    double sum = 0.0;
    for (uint32_t i = 0; i < s.sim->scene->row_count; i++) sum += s.sim->residual[i] * s.sim->now.velocity[i];
    const double off = sum / (2.0 * energy_of(&s).kinetic) - 1.0;
    rig_close(&s);
    return off;
}

/* Exact where nodes move alike along and about the axis; across it lumps are off by 1/(2 n^2) of n elements, and by the
 * arms of tool joints, whose far ends are counted at the nodes. */
static void inertia_is_that_of_the_kinetic_energy(void **state)
{
    static const double alike[6] = {1.0, 0.0, 0.0, 20.0, 0.0, 0.0}, swung[6] = {0.0, 0.3, 0.1, 0.0, 0.7, 0.5};
    (void)state;
    CHECK_CLOSE(energy_off(DMB_PIPE_AXIAL_TORSIONAL, 0.2, alike), 0.0, 1e-13);
    CHECK_CLOSE(energy_off(DMB_PIPE_FLEXIBLE, 0.0, alike), 0.0, 1e-13);
    CHECK_CLOSE(energy_off(DMB_PIPE_FLEXIBLE, 0.2, alike), 0.0, 1e-13);
    CHECK_CLOSE(energy_off(DMB_PIPE_FLEXIBLE, 0.0, swung), 0.0, 5e-3);
    CHECK_CLOSE(energy_off(DMB_PIPE_FLEXIBLE, 0.2, swung), 0.0, 5e-2);
}

/* ---- Choice ------------------------------------------------------------------------------------------------------ */

/* A step; constant: with accelerations that stay, each of them. */
static double iterations_of(const rig *s, double h, uint32_t steps, int constant)
{
    const dmb_statistics before = statistics_of(s);
    for (uint32_t i = 0; i < steps; i++) {
        if (constant) s->sim->prediction->constant = 0;
        take_steps(s, h, 1);
    }
    return (double)(statistics_of(s).iterations - before.iterations) / steps;
}

/* A string with unbalance is brought to turn on the floor of its hole. */
static void open_rubbing(rig *s)
{
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.3;
    term.h1 = 6.0;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_static = wall.mu_dynamic = 0.3;
    rig_open(s, 0.0, 0.0, -9.81);
    (void)add_wall(s, &wall);
    string.start_free = DMB_FREE_RX;
    pipe.eccentricity = 1e-3;
    pipe.damping_time = 1e-4;
    const dmb_id id = add_string(s, &string);
    (void)add_pipes(s, &pipe, 8);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, id, DMB_RX, add_time_function(s, &term, 1));
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

/* Smooth motion: the linear prediction saves iterations. */
static void smooth_motion_is_predicted_linearly(void **state)
{
    double iterations[2];
    (void)state;
    for (int constant = 0; constant < 2; constant++) {
        rig s;
        open_rubbing(&s);
        iterations[constant] = iterations_of(&s, 1e-3, 400, constant);
        rig_close(&s);
    }
    print_message("%.2f iterations a step, %.2f from accelerations that stay\n", iterations[0], iterations[1]);
    CHECK_BELOW(iterations[0], iterations[1] - 0.1);
}

/* Torsion waves that go to and fro take one correction from either; tries become rare. */
static void waves_are_not(void **state)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_segment term = dmb_segment_default();
    rig s;
    (void)state;
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = 0.05;
    term.h1 = 6.0;
    rig_open(&s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_RX;
    const dmb_id id = add_string(&s, &string);
    (void)add_pipes(&s, &pipe, 40);
    (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_RX, add_time_function(&s, &term, 1));
    (void)rig_start(&s, NULL);
    CHECK_CLOSE(iterations_of(&s, 1e-3, 200, 0), 1.0, 0.05);
    assert_int_equal(s.sim->prediction->back_off, DMB_PAUSE_MAX);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_prediction_is_of_second_order),
        cmocka_unit_test(inertia_is_that_of_the_kinetic_energy),
        cmocka_unit_test(smooth_motion_is_predicted_linearly),
        cmocka_unit_test(waves_are_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
