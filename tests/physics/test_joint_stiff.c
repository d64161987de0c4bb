/* Spring pendulum of stiffness 1e4 .. 1e14 against the rigid one: a point mass that slides along a light rod against a
 * spring. */
#include "mechanism.h"
#include "ode.h"

static const double g = 9.81;

typedef struct spring_pendulum {
    rig s;
    dmb_id rod, bob, hinge, spring;
} spring_pendulum;

/* From (-1, 0) at rest, where the rod carries nothing; mass 1. */
static spring_pendulum open_pendulum(double k, const dmb_sim_options *options)
{
    const bar straight = {{0.0, 0.0}, {-1.0, 0.0}, 1e-9};
    spring_pendulum p;
    rig_open(&p.s, 0.0, 0.0, -g);
    p.rod = add_bar(&p.s, &straight);
    dmb_body_def bob = bar_body(&straight);
    bob.mass = 1.0;
    for (int i = 0; i < 3; i++) bob.inertia[i] = 1e-12;
    bob.position[0] = -1.0;
    p.bob = add_body(&p.s, &bob);
    p.hinge = add_hinge(&p.s, "hinge", DMB_JOINT_REVOLUTE, pin_ground(0.0, 0.0), pin_on(p.rod, -0.5));
    dmb_joint_def spring = dmb_joint_def_default();
    spring.kind = DMB_JOINT_PRISMATIC;
    spring.place_a = dmb_station(p.rod, 0, 0.0);
    spring.place_b = dmb_station(p.bob, 0, 0.0);
    spring.origin_a[0] = 0.5;
    spring.stiffness[DMB_X] = k;
    p.spring = add_joint(&p.s, &spring);
    assert_int_equal(mechanism_start(&p.s, options), DMB_OK);
    return p;
}

static void rigid(void *context, double t, const double *y, double *rate)
{
    (void)context;
    (void)t;
    rate[0] = y[1];
    rate[1] = -g * sin(y[0]); /* angle from gravity */
}

/* x, z and their rates under gravity and a spring of length 1. */
static void elastic(void *context, double t, const double *y, double *rate)
{
    const double length = hypot(y[0], y[1]), pull = *(const double *)context * (length - 1.0) / length;
    (void)t;
    rate[0] = y[2];
    rate[1] = y[3];
    rate[2] = -pull * y[0];
    rate[3] = -pull * y[1] - g;
}

typedef struct outcome {
    double place, length;     /* [m] from the rigid pendulum, largest */
    double force;             /* [N] spring force from 3 m g cos a, largest */
    double ringing, reaction; /* [N] second difference of the spring's force and of the hinge's, largest */
    double iterations;
} outcome;

static double second_difference(double last[2], double now)
{
    const double d = fabs(now - 2.0 * last[1] + last[0]);
    last[0] = last[1];
    last[1] = now;
    return d;
}

static outcome swing(double k, double t, double h, double r)
{
    const dmb_sim_options options = sharp_options(r, 1e-8);
    spring_pendulum p = open_pendulum(k, &options);
    double y[2] = {-0.5 * PI, 0.0}, force[2] = {0.0, 0.0}, hinge[2] = {0.0, 0.0};
    outcome o = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < lround(t / h); i++) {
        take_steps(&p.s, h, 1);
        ode_solve(rigid, NULL, 0.0, h, 1, 2, y);
        const dmb_pose pose = pose_at(&p.s, dmb_station(p.bob, 0, 0.0));
        const dmb_joint_state spring = joint_at(&p.s, p.spring), foot = joint_at(&p.s, p.hinge);
        o.place = fmax(o.place, hypot(pose.position[0] - sin(y[0]), pose.position[2] + cos(y[0])));
        o.length = fmax(o.length, fabs(hypot(pose.position[0], pose.position[2]) - 1.0));
        o.force = fmax(o.force, fabs(-spring.action[DMB_X] - 3.0 * g * cos(y[0])));
        const double ring = second_difference(force, spring.action[DMB_X]);
        const double back = second_difference(hinge, hypot(foot.reaction[0], foot.reaction[2]));
        if (i < 2) continue;
        o.ringing = fmax(o.ringing, ring);
        o.reaction = fmax(o.reaction, back);
    }
    o.iterations = (double)statistics_of(&p.s).iterations / (t / h);
    rig_close(&p.s);
    return o;
}

/* The tension 3 m g cos a has a second derivative of at most 3 m g (g + 4 g) = 1444 N/s2 on this swing, h^2 of that is
 * 1.4e-3 N; the spring's own oscillation about it gets ten times as much. The softest spring moves the bob by more than
 * 3 m g/k, as its swing takes longer: there it is the length that is compared. Places are known to 2e-15 m, which the
 * stiffest springs make a force of, and a second difference four times that. */
static void spring_tends_to_the_rigid_rod(void **state)
{
    (void)state;
    for (int e = 4; e <= 14; e += 2) {
        const double k = pow(10.0, e), h = 1e-3, rounding = k * 8e-15, allowed = 1e-4 + 3.0 * g / k;
        const outcome o = swing(k, 1.0, h, 0.9);
        print_message("    k 1e%d: off by %.3g m, force by %.3g N, second difference %.3g N (hinge %.3g), "
                      "%.2f iterations a step\n",
                      e, o.place, o.force, o.ringing, o.reaction, o.iterations);
        check_below("    length against the rigid pendulum", o.length, allowed);
        if (e > 4) check_below("    place against the rigid pendulum", o.place, allowed);
        check_below("    second difference of the spring's force", o.ringing, 0.02 + rounding);
        check_below("    second difference of the hinge's force", o.reaction, 0.02 + rounding);
    }
}

/* Against the elastic pendulum itself, which swings at 100 and 1000 rad/s along the spring. */
static double off_the_elastic(double k, double t, double h)
{
    const dmb_sim_options options = sharp_options(0.9, 1e-10);
    spring_pendulum p = open_pendulum(k, &options);
    double y[4] = {-1.0, 0.0, 0.0, 0.0}, most = 0.0;
    for (int i = 0; i < lround(t / h); i++) {
        take_steps(&p.s, h, 1);
        ode_solve(elastic, &k, 0.0, h, (size_t)(1.0 + h * sqrt(k)), 4, y);
        const dmb_pose pose = pose_at(&p.s, dmb_station(p.bob, 0, 0.0));
        most = fmax(most, hypot(pose.position[0] - y[0], pose.position[2] - y[1]));
    }
    rig_close(&p.s);
    return most;
}

static void spring_pendulum_swings_as_it_should(void **state)
{
    (void)state;
    check_below("place against the elastic pendulum, k 1e4", off_the_elastic(1e4, 1.0, 1e-3), 1e-4);
    check_below("place against the elastic pendulum, k 1e6", off_the_elastic(1e6, 1.0, 1e-3), 1e-4);
    check_order("order, k 1e4", off_the_elastic(1e4, 1.0, 5e-4), off_the_elastic(1e4, 1.0, 2.5e-4), 2.0, 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spring_tends_to_the_rigid_rod),
        cmocka_unit_test(spring_pendulum_swings_as_it_should),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
