/* Joints over a million steps, and initial speeds that they do not allow. */
#include <stdio.h>
#include <string.h>

#include "../contract/sanitized.h"
#include "mechanism.h"

#ifdef SANITIZED
enum { PENDULUM_STEPS = 20000, FOURBAR_STEPS = 2000 };
#else
enum { PENDULUM_STEPS = 1000000, FOURBAR_STEPS = 100000 };
#endif

/* ---- Drift ------------------------------------------------------------------------------------------------------- */

/* A bar on a hinge at one end, released from an angle. */
static void open_bar(rig *s, dmb_id *hinge, const dmb_sim_options *options)
{
    const bar straight = {{0.0, 0.0}, {cos(-0.3), sin(-0.3)}, 1.0};
    rig_open(s, 0.0, 0.0, -9.81);
    const dmb_id body = add_bar(s, &straight);
    *hinge = add_hinge(s, "hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(body, -0.5));
    (void)mechanism_start(s, options);
}

/* The violation is of the last state each time: it cannot build up, whatever the number of steps. */
static double largest_violation(const rig *s, double h, uint32_t steps)
{
    double most = 0.0;
    for (uint32_t k = 0; k < steps; k += 100) {
        take_steps(s, h, 100);
        most = fmax(most, statistics_of(s).violation);
    }
    return most;
}

static void hinge_does_not_drift(void **state)
{
    (void)state;
    rig s;
    dmb_id hinge;
    dmb_sim_options options = sharp_options(1.0, 1e-8);
    open_bar(&s, &hinge, &options);
    const double low = 0.5 * 9.81 * sin(-0.3);
    print_message("    %d steps of 1e-3 s\n", PENDULUM_STEPS);
    check_below("violation of the hinge [m]", largest_violation(&s, 1e-3, PENDULUM_STEPS), 1e-12);
    const dmb_joint_state joint = joint_at(&s, hinge);
    const double energy =
        0.5 / 3.0 * joint.speed[DMB_RX] * joint.speed[DMB_RX] + 0.5 * 9.81 * sin(joint.position[DMB_RX]);
    check_relative("energy at the end", energy, low, 1e-5);
    check_below("other coordinates", fmax(largest(3, joint.position), largest(2, joint.position + 4)), 1e-12);
    rig_close(&s);
}

/* Parallelogram of bars, which have three redundant rows and pass their change points. */
static void open_parallelogram(rig *s, const dmb_sim_options *options)
{
    const bar bars[3] = {{{0.0, 0.0}, {0.6, 0.8}, 1.0}, {{0.6, 0.8}, {2.6, 0.8}, 1.0}, {{2.0, 0.0}, {2.6, 0.8}, 1.0}};
    dmb_id id[3];
    rig_open(s, 0.0, 0.0, -9.81);
    for (int i = 0; i < 3; i++) id[i] = add_bar(s, bars + i);
    (void)add_hinge(s, "A", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(id[0], -0.5));
    (void)add_hinge(s, "B", DMB_JOINT_REVOLUTE, pin_on(id[0], 0.5), pin_on(id[1], -1.0));
    (void)add_hinge(s, "C", DMB_JOINT_REVOLUTE, pin_on(id[1], 1.0), pin_on(id[2], 0.5));
    (void)add_hinge(s, "D", DMB_JOINT_REVOLUTE, pin_ground(2.0, 0.0), pin_on(id[2], -0.5));
    (void)mechanism_start(s, options);
}

static void four_bar_does_not_drift(void **state)
{
    (void)state;
    rig s;
    dmb_sim_options options = sharp_options(0.9, 1e-8);
    double most = 0.0;
    open_parallelogram(&s, &options);
    print_message("    %d steps of 1e-3 s\n", FOURBAR_STEPS);
    for (int k = 0; k < FOURBAR_STEPS; k++) {
        must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
        if (k % 100 == 0) most = fmax(most, statistics_of(&s).violation);
    }
    check_below("violation of the four hinges [m]", most, 1e-12);
    assert_int_equal(statistics_of(&s).redundant, 3);
    rig_close(&s);
}

/* ---- Initial speeds ---------------------------------------------------------------------------------------------- */

/* A body on a hinge about z through the origin, its middle at (1, 0, 0), thrown with a speed that the hinge does not
 * allow. Least change in metres and in radians at the length scale: what is left is the hinge's own turning. */
static void speeds_are_projected_and_told(void **state)
{
    (void)state;
    rig s;
    const double given[6] = {0.3, 1.0, -0.2, 0.5, 0.0, 0.0};
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def hinge = dmb_joint_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    body.position[0] = 1.0;
    memcpy(body.velocity, given, sizeof given);
    const dmb_id id = add_body(&s, &body);
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.place_b = dmb_station(id, 0, 0.0);
    hinge.axis_a[0] = hinge.axis_b[0] = 0.0;
    hinge.axis_a[2] = hinge.axis_b[2] = 1.0;
    hinge.origin_b[0] = -1.0;
    const dmb_id joint = add_joint(&s, &hinge);
    assert_int_equal(mechanism_start(&s, NULL), DMB_NOTE_PROJECTED);
    print_message("    %s\n", dmb_sim_message(s.sim));
    const dmb_motion motion = motion_at(&s, dmb_station(id, 0, 0.0), DMB_FRAME_WORLD);
    const double w = joint_at(&s, joint).speed[DMB_RX];
    const dmb_statistics statistics = statistics_of(&s);
    const double *change = statistics.projection;
    const double fits[6] = {0.0, w, 0.0, 0.0, 0.0, w};
    tell("turning that is left [rad/s]", w);
    assert_true(w > 0.0 && w < 1.0);
    check_below("speed is what the hinge allows", largest_difference(6, motion.velocity, fits), 1e-14);
    double moved[2] = {0.0, 0.0}, told[2];
    for (int i = 0; i < 6; i++) moved[i / 3] = fmax(moved[i / 3], fabs(motion.velocity[i] - given[i]));
    check_close("largest change of a speed, as told [m/s]", change[0], moved[0], 1e-14);
    check_close("largest change of a turning, as told [rad/s]", change[1], moved[1], 1e-14);
    const char *by = strstr(dmb_sim_message(s.sim), "by ");
    assert_non_null(by);
    assert_int_equal(sscanf(by, "by %lf m/s and %lf", told, told + 1), 2);
    check_close("the same in the message [m/s]", told[0], moved[0], 1e-5);
    check_close("the same in the message [rad/s]", told[1], moved[1], 1e-5);
    rig_close(&s);
}

/* Fitting speeds are left alone, and nothing is noted. */
static void fitting_speeds_stay(void **state)
{
    (void)state;
    rig s;
    dmb_body_def body = dmb_body_def_default();
    rig_open(&s, 0.0, 0.0, 0.0);
    body.position[0] = 1.0;
    body.velocity[2] = 2.0;
    body.velocity[4] = -2.0;
    const dmb_id id = add_body(&s, &body);
    const dmb_id joint = add_hinge(&s, "hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(id, -1.0));
    assert_int_equal(mechanism_start(&s, NULL), DMB_OK);
    check_close("speed of the hinge", joint_at(&s, joint).speed[DMB_RX], 2.0, 1e-15);
    const dmb_statistics statistics = statistics_of(&s);
    check_below("projection", largest(2, statistics.projection), 1e-12);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hinge_does_not_drift),
        cmocka_unit_test(four_bar_does_not_drift),
        cmocka_unit_test(speeds_are_projected_and_told),
        cmocka_unit_test(fitting_speeds_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
